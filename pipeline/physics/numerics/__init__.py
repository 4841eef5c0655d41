"""Numerical methods shared by the mechanics."""
