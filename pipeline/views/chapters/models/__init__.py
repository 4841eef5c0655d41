"""Chapters on the systems other than the disc brake."""
