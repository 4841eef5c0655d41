"""The model linearised about steady sliding and its equilibrium."""
