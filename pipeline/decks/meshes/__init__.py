"""Meshes of bodies with their sets, materials and sections, from decks of finite-element programs."""
