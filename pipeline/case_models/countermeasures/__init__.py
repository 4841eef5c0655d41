"""Variants of a brake that a user declares as countermeasures, and which of its modes are which before and after."""
