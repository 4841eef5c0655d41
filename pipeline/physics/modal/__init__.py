"""Modal analysis: natural modes, quadratic eigenproblems and modal superposition."""
