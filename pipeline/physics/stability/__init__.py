"""Stability of steady sliding: linearisation, mode coupling and lock-in."""
