"""Commands for recordings of benches: a first case of a file, what a case can tell, sets of recordings."""
