"""Effects on the structure: mass, stiffness, damping, gyroscopic terms."""
