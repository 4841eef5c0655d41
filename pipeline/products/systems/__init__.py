"""Products of systems that are given otherwise than by bodies."""
