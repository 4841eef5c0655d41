"""Measured friction beside the map: where they differ, and which values of the micro scale that asks for."""
