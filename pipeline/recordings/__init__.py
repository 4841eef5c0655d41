"""Readers of what benches write; each turns a file into plain columns or into runs."""
