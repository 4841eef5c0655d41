"""Effects that excite or load the system: motion of the base, runout, pressure."""
