"""Bodies of systems from mesh files: their Solids, materials and springs."""
