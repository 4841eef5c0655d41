"""Blind trials of the diagnosis: generators of cases, the sealed protocol, and baseline methods."""
