"""What joins recordings, benches, effects and inference into one verdict."""
