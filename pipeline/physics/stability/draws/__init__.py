"""Draws of a brake whose values scatter: their sliding states and growing roots, with the physics of effects."""
