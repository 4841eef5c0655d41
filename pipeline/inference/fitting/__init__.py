"""Least-squares fits: calibration, refitting, noise and drift."""
