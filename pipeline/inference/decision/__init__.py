"""From fits to a verdict: evidence, held-out prediction and decision rules."""
