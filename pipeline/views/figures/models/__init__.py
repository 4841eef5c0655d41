"""Figures of the systems other than the disc brake."""
