"""Chapters on recordings, diagnoses and trials."""
