"""Friction laws of joints with states, or that follow the position."""
