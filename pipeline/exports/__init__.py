"""What other programs read of a run: matrices, modes, functional mock-up units."""
