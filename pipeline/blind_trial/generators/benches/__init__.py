"""Practice benches: flutter rigs, a pin on a disc and a worn pad."""
