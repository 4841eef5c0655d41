"""Our numbers for the facts of the disc brake, from the products that a case has."""

from pipeline.validation import friction, modes, motion

#: fact key or pattern -> product field
FIELDS = {**friction.FIELDS, **motion.FIELDS, **modes.FIELDS}

#: product -> (product, facts, known) -> rows
_ROWS = {
    "micro_friction": lambda micro_friction, facts, known: friction.friction_rows(micro_friction, known),
    "multibody": lambda multibody, facts, known: motion.motion_rows(multibody, known),
    "structure": lambda structure, facts, known: modes.disc_mode_rows(structure, facts),
    "complex_modes": lambda complex_modes, facts, known: modes.system_mode_rows(complex_modes, known),
    "squeal": lambda squeal, facts, known: modes.squeal_rows(squeal, known),
}


def disc_brake_rows(products, facts, known):
    """Rows of all ``products`` (name -> product or None); ``known`` = published values in SI by key."""
    rows = {}
    for name, write in _ROWS.items():
        if products.get(name) is not None:
            rows |= write(products[name], facts, known)
    return rows
