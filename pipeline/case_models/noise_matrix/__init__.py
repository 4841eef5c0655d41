"""Noise matrix of a brake: the schedule of its stops, the stops of a recording in it, draws solved at its conditions."""
