"""What was computed, in one paragraph of the first screen: bodies, contacts, operating points, what is linear."""

from pipeline.views.chapters.unstable_modes import words
from pipeline.views.figures.number_format import plural, span

#: products that follow the motion with its contacts, not only about steady sliding
_NONLINEAR = {"transient": "time integration with contact", "limit_cycle": "motion with contact from steady sliding on"}


def system(products):
    """Text on the system and its assumptions, from ComplexModes and what followed; empty without these."""
    modes = products.get("complex_modes")
    if modes is None:
        return ""
    bodies = [words(name) for name in modes.body_name]
    named = " and ".join(filter(None, (", ".join(bodies[:-1]), bodies[-1])))
    contacts, pressure = plural(modes.operating_force.shape[1], "contact"), span(modes.operating_pressure, "Pa")
    speed, friction = span(modes.operating_speed, "rad/s"), span(modes.operating_friction, "1")
    beyond = "".join(f", and {text}" for name, text in _NONLINEAR.items() if products.get(name) is not None)
    return (f"{named[0].upper()}{named[1:]} in steady sliding on {contacts}, at {pressure}, {speed} and friction"
            f" {friction}; vibration linear about it{beyond}. What the model leaves out and the origin of every value"
            " are listed after the chapters.")
