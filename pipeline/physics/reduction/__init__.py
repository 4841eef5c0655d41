"""Model reduction: Craig-Bampton and its application to beams and bodies."""
