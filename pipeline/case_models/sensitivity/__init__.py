"""Values of a brake by their names, and the matrices about steady sliding that they lead to."""
