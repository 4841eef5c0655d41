"""Complex modes of the brake over friction, and at the operating points of the friction map.

A root s = sigma + i omega with sigma > 0 is a squeal candidate: it says which motion can grow, not how loud it ends up.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import eigvalsh

from pipeline.contract import Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.friction_corrections import FrictionBasis, friction_basis
from pipeline.physics.friction_law import FrictionLaw, friction_at
from pipeline.physics.quadratic_modes import follow_roots, quadratic_modes, quadratic_roots, upper_half
from pipeline.physics.sliding_model import FrictionState, SlidingModel, sliding_model
from pipeline.products import ComplexModes, FrictionMap, ReducedModel

#: friction values of one task of the fan-out
_CHUNK = 7


class Settings(Section):
    """Friction sweep, operating points and the terms of the linearised system."""

    speeds: Quantities("rad/s", gt=0) = option(
        ("8.5 rad/s", "10.25 rad/s", "12 rad/s"), "disc speeds of the operating points; the sweep runs at their mean")
    friction_max: float = option(0.8, "last friction coefficient of the sweep, which starts at 0", gt=0)
    friction_steps: int = option(41, "points of the sweep, both ends included", ge=2)
    frequency_max: Quantity("Hz", gt=0) = option("20 kHz", "real modes below it span the motion")
    smallest_correction: float = option(
        1e-3, "corrections for friction and damping below this share of the modal amplitude are left out", ge=0)
    sliding_distance: Quantity("m", ge=0) = option("10 mm", "sliding distance at which the friction map is read")
    friction_slopes: bool = option(True, "friction that changes with pressure and slip speed, at the operating points")
    friction_damping: bool = option(True, "friction that turns with the slip velocity damps sideways motion")
    gyroscopic: bool = option(True, "gyroscopic terms of the disc")
    centrifugal: bool = option(True, "centrifugal terms of the disc")
    neutral: float = option(1e-6, "growth below this share of abs(s) counts as neither growth nor decay", ge=0)


@dataclass(frozen=True)
class _State:
    """One preload state: the model at the speed of the sweep, projected on its basis."""

    model: SlidingModel
    basis: FrictionBasis


@dataclass(frozen=True)
class _Point:
    """One operating point."""

    state: int
    model: SlidingModel
    friction: FrictionState

    @property
    def mean_friction(self):
        """Friction coefficient, mean over the contacts weighted by their preload; 0 without load."""
        preload = self.model.contacts.preload
        return float(preload @ self.friction.coefficient / preload.sum()) if preload.any() else 0.0


@stage
def complex_modes(model: ReducedModel, friction_map: FrictionMap, settings: Settings,
                  context: Context) -> ComplexModes:
    """Find the complex modes over friction and at the operating points.

    Method:
    All complex modes were computed at {friction_steps} friction coefficients from 0 to {friction_max} and at the
    operating points of the friction map, on the real modes below {frequency_max} and their friction
    corrections; a mode counts as unstable when its growth rate exceeds {neutral} of its angular frequency.
    """
    models = [sliding_model(model, k, np.mean(settings.speeds)) for k in range(len(model.pressure))]
    states = context.map(partial(_state, settings), models, "real modes")
    friction = np.linspace(0.0, settings.friction_max, settings.friction_steps)
    roots = _sweep(states, friction, settings, context)
    points = [_point(k, s.model.at_speed(v), friction_map, settings)
              for k, s in enumerate(states) for v in settings.speeds]
    modes = context.map(partial(_operating_modes, settings), points, "operating points")
    branches = min(max(len(s.basis.frequency) for s in states), *(s.model.size for s in states))
    return ComplexModes(
        pressure=model.pressure, friction=friction, root=[r[:, :branches] for r in roots],
        real_frequency=[_lowest_frequencies(s.model, branches) for s in states],
        operating_pressure=[model.pressure[p.state] for p in points], operating_speed=[p.model.speed for p in points],
        operating_friction=[p.mean_friction for p in points],
        operating_root=[_lowest(m.value, branches) for m in modes],
        **_unstable(points, modes, states, model.recovery, settings),
        corrections=max(s.basis.corrections for s in states))


def _state(settings, model):
    basis = friction_basis(model, settings.frequency_max, settings.friction_damping, settings.smallest_correction)
    return _State(model.projected(basis.shape), basis)


def _sweep(states, friction, settings, context):
    """Roots (friction, n) of every state, followed over friction from the lowest without friction upwards."""
    chunks = np.array_split(friction, -(-len(friction) // _CHUNK))
    results = context.map(partial(_roots_over_friction, settings), [(s.model, c) for s in states for c in chunks],
                          "friction sweep")
    roots = [np.vstack(results[k:k + len(chunks)]) for k in range(0, len(results), len(chunks))]
    return [follow_roots(r[:, np.argsort(abs(r[0]), kind="stable")]) for r in roots]


def _roots_over_friction(settings, task):
    """One root of each conjugate pair at each friction coefficient, (friction, n)."""
    model, friction = task
    roots = [quadratic_roots(*_linearised(model, mu, settings)) for mu in friction]
    return np.array([r[upper_half(r)] for r in roots])


def _point(state, model, friction_map, settings):
    """Operating point with the friction of the map at the static pressure and sliding speed of each contact."""
    law = FrictionLaw(friction_map.pressure, friction_map.speed, friction_map.distance, friction_map.friction)
    places = zip(model.contacts.pressure, abs(model.sliding_speed), strict=True)
    read = np.array([friction_at(p, v, settings.sliding_distance, *law.table) for p, v in places]).reshape(-1, 4)
    slopes = read[:, 1:3] * settings.friction_slopes
    return _Point(state, model, FrictionState(read[:, 0], *slopes.T))


def _operating_modes(settings, point):
    return quadratic_modes(*_linearised(point.model, point.friction, settings))


def _linearised(model, friction, settings):
    return model.linearised(friction, friction_damping=settings.friction_damping, gyroscopic=settings.gyroscopic,
                            centrifugal=settings.centrifugal)


def _unstable(points, modes, states, recovery, settings):
    """Growing modes below the frequency limit, strongest first, with their shapes on the surface."""
    found = []
    for number, (point, mode) in enumerate(zip(points, modes, strict=True)):
        root, limit = mode.value, 2 * np.pi * settings.frequency_max
        grows = (root.real > settings.neutral * abs(root)) & (root.imag >= 0) & (abs(root) < limit)
        found += [(number, root[k], states[point.state].basis.shape @ mode.right[:, k]) for k in np.flatnonzero(grows)]
    found.sort(key=lambda f: -f[1].real)
    shapes = [_normalised(recovery @ q.astype(np.complex64)) for _, _, q in found]
    return {"unstable_operating": [f[0] for f in found], "unstable_root": [f[1] for f in found],
            "unstable_shape": np.array(shapes).reshape(len(found), *recovery.shape[:2])}


def _normalised(shape):
    """The shape with its largest component 1, which also fixes its phase."""
    return shape / shape.ravel()[abs(shape).argmax()]


def _lowest(roots, count):
    """One of each conjugate pair, the ``count`` smallest."""
    half = roots[upper_half(roots)]
    return half[np.argsort(abs(half), kind="stable")[:count]]


def _lowest_frequencies(model, count):
    """The ``count`` lowest frequencies (Hz) of the closed system without friction, damping and gyroscopic terms."""
    mass, _, stiffness = model.frictionless(gyroscopic=False)
    return np.sqrt(np.maximum(eigvalsh(stiffness, mass), 0.0))[:count] / (2 * np.pi)
