"""A run as one system of matrices: of its reduced sliding model, of its full finite elements, or as it was given."""

from dataclasses import dataclass, field

import numpy as np
import scipy

from pipeline.case_models.matrices.full_matrices import lacking_terms
from pipeline.case_models.matrices.sliding_terms import sliding_state, terms_about, terms_of
from pipeline.contract import ConfigError
from pipeline.exports.run_products import described, operating_point, product_of, sliding_products
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.system.terms import Term
from pipeline.products import Matrices, MatrixModes, Structure
from pipeline.systems.fem_bodies import full_model


@dataclass(frozen=True)
class MatrixSystem:
    """Term ``terms`` that hold at ``speed`` rad/s; ``about``: what they are; ``highest`` Hz that is of interest.

    ``freedoms``: (columns, rows (n,)) of a table with one row for each degree of freedom; ``rows`` {name: (r, n)} of
    the inputs and sensors with their names; ``speeds`` at which modes are asked for, ``friction`` and that of a
    map over that of the terms.
    """

    terms: tuple
    speed: float
    about: str
    highest: float
    freedoms: tuple
    rows: dict = field(default_factory=dict)
    speeds: tuple = ()
    friction: float = 1.0
    map_friction: tuple = (0.0, 0.5, 1.0, 1.5)


def is_given_as_matrices(folder):
    """Whether a run ``folder`` is that of a system that was given as matrices."""
    return (folder / f"{Matrices.name}.h5").exists()


def reduced_system(folder, wanted=None):
    """MatrixSystem of the reduced sliding model of a run ``folder`` about an operating point (None: the most unstable).

    Raises ConfigError for an operating point that does not exist and for what matrices cannot hold, ProductError for a
    missing product.
    """
    modes, model, friction_map, effects = sliding_products(folder)
    operating = operating_point(modes, wanted)
    state = sliding_state(modes, model, friction_map, effects, operating)
    bodies = [*map(str, state.about.body_name)]
    names = [bodies[k] if k >= 0 else "" for k in state.about.coordinate_body]
    return _about_state(state, terms_of(state), f"reduced sliding model, operating point {described(modes, operating)}",
                        (("row", "body"), list(enumerate(names, 1))), state.about)


def full_system(folder, wanted=None, solver="superlu"):
    """The same of the full finite-element matrices about their own sliding state.

    Raises ConfigError as well where the full matrices lack a part of the reduced model.
    """
    structure = product_of(Structure, folder)
    modes, model, friction_map, effects = sliding_products(folder)
    operating = operating_point(modes, wanted)
    state = sliding_state(modes, model, friction_map, effects, operating)
    lacking = lacking_terms(structure, state.posed, state.settings)
    if lacking:
        raise ConfigError("--full", "a case whose terms all have full finite-element matrices",
                          ", ".join(lacking), "export the reduced model, or take these out of the case")
    state = state.on_elements(full_model(structure, solver), solver)
    return _about_state(state, terms_about(state.about, state.friction, state.settings),
                        f"full finite-element matrices, operating point {described(modes, operating)}",
                        _nodes(structure, state.about.mass.shape[0]), state.about, map_friction=(1.0,))


def given_system(folder):
    """MatrixSystem of a run ``folder`` whose system was given as matrices, term by term, as it was given."""
    given = product_of(Matrices, folder)
    modes, size = product_of(MatrixModes, folder, optional=True), int(given.size)
    terms = tuple(Term.whole(name, str(term.kind), scipy.sparse.csr_matrix((term.value, (term.row, term.column)),
                                                                           (size, size)), str(term.times))
                  for name, term in given.terms.items())
    labels = zip(given.node, given.direction, strict=True) if len(given.node) else [("", "")] * size
    freedoms = [(k, *label) for k, label in enumerate(labels, 1)]
    speed = float(given.reference_speed)
    known = {} if modes is None else {"speeds": tuple(map(float, modes.roots.speed)), "friction": float(modes.friction)}
    return MatrixSystem(terms, speed, "system that was given as matrices", float(modes.highest) if modes else 1e4,
                        (("row", "node", "direction"), freedoms), **known)


def _about_state(state, terms, about, freedoms, model, **others):
    """MatrixSystem of ``terms`` about a SlidingState; a drive at rest has no terms that change with its speed."""
    rows = {"inputs": model.input_rows, "sensors": model.sensor_rows}
    rows = {name: each.toarray() if scipy.sparse.issparse(each) else np.asarray(each) for name, each in rows.items()}
    rows |= {"input_name": np.array(model.input_name, str), "sensor_name": np.array(model.sensor_name, str)}
    return MatrixSystem(terms, abs(state.about.speed) or 1.0, about, float(state.settings.frequency_max), freedoms,
                        rows, **others)


def _nodes(structure, size):
    """Table of the degrees of freedom of the full matrices: body, node (from 0, as in structure.h5) and direction."""
    rows = []
    for name in structure.body_name:
        body = structure.body(str(name))
        free = free_freedoms(len(body.node), body.supported)
        rows += [(str(name), int(k) // 3, int(k) % 3 + 1) for k in free]
    rows += [("brake_fluid", "", "")] * (size - len(rows))
    return ("row", "body", "node", "direction"), [(k, *row) for k, row in enumerate(rows, 1)]
