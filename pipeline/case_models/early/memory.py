"""How much memory a brake takes, about, before anything of it is computed."""

from pipeline.case_models.early.work import FREEDOMS, elements
from pipeline.case_models.refinement.finer_settings import finer, refined

#: bytes of two processes without a model, and for each degree of freedom of the largest one: peaks of seven brakes, of
#: 10,000 to 190,000 degrees of freedom, were .7 to 1.4 times what these say (the latter with vanes, which cut the mesh)
_BASE, _EACH = 0.6e9, 34e3


def peak_memory(sections):
    """Bytes that a chain with these filled ``sections`` takes at its peak, all processes together; 0 without a brake
    whose modes are sought."""
    if not {"structure", "complex_modes"} <= set(sections):
        return 0.0
    brake = sections["structure"]
    sizes = [elements(brake)]
    if "convergence" in sections:
        settings = sections["convergence"]
        names = refined(brake, settings.refinements)
        sizes.append(elements(finer(brake, names, settings.meshes, settings.contact_points)))
    return _BASE + _EACH * FREEDOMS * max(sizes)
