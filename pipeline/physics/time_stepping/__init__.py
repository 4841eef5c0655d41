"""Time integration of reduced models with contact and friction."""
