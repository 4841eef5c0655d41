"""A lumped system in the YAML: its sections, and how they become rows and matrices."""
