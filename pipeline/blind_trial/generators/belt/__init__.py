"""Belt rigs: a mass on a moving belt, with friction that is hidden from the diagnosis."""
