"""Brake rigs: an annulus between two pads."""
