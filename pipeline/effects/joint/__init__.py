"""Effects that act in a joint: friction, damping, nonlinear stiffness, play."""
