"""Onsets of squeal: the window of free growth in a record, its growth rate and frequency, and the spread over stops."""
