"""Mechanics on arrays: no files, no YAML, no command line, no products."""

from pipeline.environment import use_compiled_cache

use_compiled_cache()
