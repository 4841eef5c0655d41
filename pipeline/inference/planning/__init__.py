"""Choice of the next experiment and of a measurement campaign."""
