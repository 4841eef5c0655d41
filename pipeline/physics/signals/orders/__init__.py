"""Orders of a shaft: what turns with it, and which of it stands out."""
