"""Our numbers for the facts of the disc brake, from the products that a case has."""

from pipeline.validation.friction import friction_rows
from pipeline.validation.modes import disc_mode_rows, squeal_rows, system_mode_rows
from pipeline.validation.motion import motion_rows

#: product -> (product, facts, known) -> rows
_ROWS = {
    "micro_friction": lambda micro, facts, known: friction_rows(micro, known),
    "multibody": lambda multibody, facts, known: motion_rows(multibody, known),
    "structure": lambda structure, facts, known: disc_mode_rows(structure, facts),
    "complex_modes": lambda modes, facts, known: system_mode_rows(modes, known),
    "squeal": lambda squeal, facts, known: squeal_rows(squeal, known),
}


def disc_brake_rows(products, facts, known):
    """Rows of all ``products`` (name -> product or None); ``known`` = published values in SI by key."""
    rows = {}
    for name, write in _ROWS.items():
        if products.get(name) is not None:
            rows |= write(products[name], facts, known)
    return rows
