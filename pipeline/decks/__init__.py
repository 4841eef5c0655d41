"""Readers of files that finite-element programs write; each in a process of its own."""
