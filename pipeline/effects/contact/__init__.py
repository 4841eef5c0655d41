"""Effects on the contact surface: stiffness, damping, wear, heat."""
