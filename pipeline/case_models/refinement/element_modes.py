"""Modes of a brake on its finite elements alone, each followed from one of a reduced or coarser model."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.case_models.refinement.unreduced_brake import BodyMatrices, freedoms, unreduced
from pipeline.physics.modal.followed_roots import followed_roots
from pipeline.physics.numerics.memory import refuse_beyond_memory
from pipeline.physics.numerics.sparse_solver import Successive, factorise
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.shared_operator import SharedOperator, SlidingPoint
from pipeline.physics.sliding.unreduced_equilibrium import Solutions, sliding_on_elements
from pipeline.systems.disc_brake import build, moduli_left, softened

#: bytes a degree of freedom: matrices, a factor and the search space of a family (measured: 34,000 to 35,000)
_BYTES = 36e3
#: frequencies of one family, which shares a factor, differ by no more than this factor, or this many rad/s: modes are
#: about as dense at all frequencies, and each that lies between costs the others steps
_FAMILY, _APART = 1.1, 2 * np.pi * 250
#: a factor is made beside the middle of its family, where it is regular
_BESIDE = 1.001


@dataclass(frozen=True)
class OperatingPoint:
    """Nominal ``pressure`` Pa, ``speed`` rad/s, ``temperature`` K of the linings above that of reference; ``settings``:
    the section ``complex_modes``."""

    pressure: float
    speed: float
    temperature: float
    settings: object


@dataclass(frozen=True)
class ElementModes:
    """Of each mode that was followed (g,) its ``root`` 1/s, nan where it is gone, and the MAC of the contact motion;
    ``freedoms`` and ``contacts`` of the model."""

    root: np.ndarray
    likeness: np.ndarray
    freedoms: int
    contacts: int


def brake_of(section, point):
    """DiscBrake of the section ``structure`` with linings as stiff as they are at an OperatingPoint."""
    pad = section.pad
    times = (point.pressure / pad.lining_pressure) ** pad.lining_pressure_exponent
    if point.temperature:
        times *= moduli_left(pad.lining_softening, point.temperature)
    return softened(build(section), float(times))


def element_modes(section, point, starts, matrices: BodyMatrices, tolerance: float) -> ElementModes:
    """ElementModes of the section ``structure`` at an OperatingPoint, from Starts; ``tolerance`` of the residuals.

    Raises ConfigError, before anything is solved, where memory will not do; ConvergenceError where steady sliding is
    not found.
    """
    brake, settings = brake_of(section, point), point.settings
    count = freedoms(brake)
    refuse_beyond_memory(_BYTES * count, f"a finite-element model of {count} degrees of freedom",
                         "convergence.refinements", "refine less at once (convergence.meshes), or state fewer of them")
    fluid = brake.fluid and section.piston.fluid.loss_factor
    model = unreduced(brake, matrices, point.speed, fluid)
    nearest = _nearest(brake.contacts, starts)
    load = np.full(model.input_rows.shape[0], point.pressure * brake.pad_area)
    sliding = sliding_on_elements(model, load, starts.law, starts.friction, starts.closure[nearest],
                                  Solutions(matrices.solver), settings.centrifugal)
    friction = sliding.friction if settings.friction_slopes else FrictionState(sliding.friction.coefficient)
    about = model_about(model, sliding.contact, settings.damping_speed)
    motion = starts.motion[:, nearest].reshape(-1, len(starts.root))
    search = _Search(about.linearised(friction, settings.friction_damping, settings.gyroscopic, settings.centrifugal),
                     SharedOperator.of(about, settings.gyroscopic, settings.centrifugal),
                     SlidingPoint.of(about, friction, settings.friction_damping), matrices.solver, tolerance)
    return ElementModes(*search.followed(starts.root, motion), count, len(nearest))


def _nearest(contacts, starts):
    """(c,) index of the contact of the Starts that is nearest to each, on the same body."""
    chosen = np.empty(len(contacts.area), int)
    for body in np.unique(contacts.body):
        here, there = np.flatnonzero(contacts.body == body), np.flatnonzero(starts.body == body)
        chosen[here] = there[scipy.spatial.cKDTree(starts.position[there]).query(contacts.position[here])[1]]
    return chosen


class _Search:
    """Modes of a brake about steady sliding at a SlidingPoint, by its ``operator`` (M, C, K) and as SharedOperator.

    A family is searched with the factor of the symmetric part of T(s0), a third of the work of one of T(s0) itself, and
    with that where a mode is not found.
    """

    def __init__(self, operator, shared, point, solver, tolerance):
        self._operator, self._shared, self._point = operator, shared, point
        self._solver, self._tolerance, self._symmetric = solver, tolerance, Successive(solver)

    def followed(self, sought, motion):
        """(root (g,), likeness (g,)) of modes ``sought`` (g,) by rising frequency, whose contacts move by ``motion``
        (3c, g)."""
        root, likeness = np.full(len(sought), complex(np.nan, np.nan)), np.zeros(len(sought))
        for group in families(sought.imag):
            target = _BESIDE * 1j * np.sqrt(sought[group[0]].imag * sought[group[-1]].imag)
            task = sought[group], motion[:, group]
            found = self._found(self._symmetric.factor(self._shared.symmetric(self._point, target)), *task)
            if np.isnan(found.root).any():
                self._symmetric.forget()        # its memory goes before that of the larger one
                found = self._found(self._whole(target), *task)
            root[group], likeness[group] = found.root, found.likeness
        return root, likeness

    def _found(self, factor, sought, motion):
        modes = zip(sought, motion.T, strict=True)
        forces = np.stack([self._shared.moving(self._point, *mode) for mode in modes], axis=1)
        return followed_roots(self._operator, lambda b: factor.solve(b).astype(complex), sought, forces,
                              self._shared.rows, motion, self._tolerance)

    def _whole(self, target):
        mass, damping, stiffness = self._operator
        return factorise((target**2 * mass + target * damping + stiffness).tocsr(), self._solver, symmetric=False,
                         single=True)


def families(frequency):
    """[indices] of rising ``frequency`` (g,) rad/s, each near the first of its own."""
    groups = []
    for k, each in enumerate(frequency):
        first = frequency[groups[-1][0]] if groups else -np.inf
        if each < max(_FAMILY * first, first + _APART):
            groups[-1].append(k)
        else:
            groups.append([k])
    return groups
