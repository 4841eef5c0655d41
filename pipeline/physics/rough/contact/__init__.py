"""Contact of two rough solids: normal, yielding, and with a limit of shear."""
