"""Values of a brake by their names, derivatives of its roots to them, and which of them take growth from a mode."""
