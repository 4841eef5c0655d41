"""Nonlinear motion about steady sliding, in the complex modes of the sliding system."""
