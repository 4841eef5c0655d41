"""Bodies of a brake: their settings, and where a test has measured them."""
