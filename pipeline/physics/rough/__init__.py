"""Rough contact: topography, layered solids, shear limit and Archard wear."""
