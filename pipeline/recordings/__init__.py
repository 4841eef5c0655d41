"""Readers of measured files; each returns plain columns or runs."""
