"""Finite elements: meshes, elasticity, beams, supports and force mapping."""
