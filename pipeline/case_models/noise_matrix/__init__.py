"""Noise matrix of a brake: schedule, draws at its conditions, the stops of a recording in it."""
