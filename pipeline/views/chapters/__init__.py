"""The chapters of the report, one file per part of the chain."""
