"""Mechanics on arrays: no files, no YAML, no command line, no products."""

from pipeline.environment import own_compiled_code

own_compiled_code()
