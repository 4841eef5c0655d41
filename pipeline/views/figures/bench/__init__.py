"""Figures of recordings, diagnoses and trials."""
