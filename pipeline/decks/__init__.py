"""Readers of files that finite-element programs write: matrices, each in a process of its own, and meshes."""
