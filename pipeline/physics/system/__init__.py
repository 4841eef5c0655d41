"""A linear system about a state of motion as a sum of typed terms, from which everything else follows."""
