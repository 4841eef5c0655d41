"""Rupture along a bimaterial interface."""
