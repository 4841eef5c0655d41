"""The command line, derived from the stages."""
