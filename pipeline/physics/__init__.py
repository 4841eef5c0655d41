"""Mechanics on arrays: no files, no YAML, no command line, no products."""
