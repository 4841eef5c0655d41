"""Whole pages: the report, its summary, the page of a trial."""
