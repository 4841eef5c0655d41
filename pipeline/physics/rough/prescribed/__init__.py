"""Surfaces with a prescribed spectrum and height distribution, and what a scan prescribes."""
