"""Rough surfaces of a case: the section ``surface`` of the YAML."""
