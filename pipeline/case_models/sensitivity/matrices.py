"""A reduced brake about its steady sliding, as a System, by its products and what is varied in them."""

from dataclasses import dataclass, fields, make_dataclass, replace

import numpy as np

from pipeline.case_models.scatter import family
from pipeline.physics.modal.quadratic_eigenproblem import operator, polished
from pipeline.physics.modal.root_derivatives import with_vectors
from pipeline.physics.stability.draws.scatter import Factors
from pipeline.physics.stability.draws.whole_roots import about_sliding, system_about
from pipeline.products import Effects, ReducedModel


@dataclass(frozen=True)
class Case:
    """A product ReducedModel at one operating point, its Effects, or None, and what is varied beside them.

    ``state``: row of its preload; ``speed`` rad/s; ``load``: factor on the input force; ``factors``: as of a draw.
    """

    model: object
    state: int
    speed: float
    load: float = 1.0
    factors: Factors = Factors()
    effects: Effects | None = None


def varied(case, friction_map, points, friction=None):
    """Family of a Case; ``points``: settings of its stability a StabilitySettings; ``friction``: a law of
    pressure and speed in place of that of the map or the settings, effects included."""
    made = family(case.model, case.state, friction_map, points, case.effects)
    if friction is not None:
        made = replace(made, friction=friction)
    made = replace(made, input_force=case.load * made.input_force)
    return made.at_speed(case.speed).varied(made.filled(case.factors))


def system_of(case, friction_map, points):
    """System of a Case about its own steady sliding."""
    made = varied(case, friction_map, points)
    return system_about(made, *about_sliding(made))


def mean_friction(case, friction_map, points):
    """Friction coefficient of a Case, mean over the contacts weighted by their force."""
    about, friction, _ = about_sliding(varied(case, friction_map, points))
    force = about.contacts.preload
    return float(force @ np.broadcast_to(friction.coefficient, force.shape) / force.sum())


def polished_root(system, root):
    """RootWithVectors of a System nearest a ``root``, which is near one of its own."""
    given, beside = system.matrices(), system.beside
    start = np.linalg.solve(operator(*given, root, beside)[0], np.ones(system.size))
    return with_vectors(given, *polished(*given, root, start, beside), beside)


#: the fields of a product ReducedModel, in an object that does not check them at every change
Fields = make_dataclass("Fields", [f.name for f in fields(ReducedModel)], frozen=True,
                        namespace={"__module__": __name__})


def without_surface(model):
    """The Fields of a product ReducedModel, without what pictures alone need."""
    kept = {f.name: getattr(model, f.name) for f in fields(ReducedModel)}
    return Fields(**{**kept, "visible_position": np.empty((0, 3)), "visible_body": np.empty(0, int),
                     "visible_face": np.empty((0, 4), int), "recovery": np.empty((0, 3, len(model.mass)))})
