"""Friction laws: tables, dry friction and state variables."""
