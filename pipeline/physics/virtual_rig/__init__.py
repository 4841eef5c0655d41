"""Response, modes and roots of a virtual test rig."""
