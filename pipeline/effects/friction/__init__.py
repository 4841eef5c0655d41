"""Effects on the friction law of a sliding contact."""
