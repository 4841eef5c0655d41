"""Steady sliding of finite elements themselves: Newton's method on all displacements, with one sparse factor.

Contact i carries N_i = A_i p(c_i) at its closure c_i = -(n_i q) - g_i, and friction s_i mu_i N_i along its tangent:

    K q = f + sum_i (n_i + s_i mu_i t_i) N_i.                                                                       (1)

The derivative of (1) is the stiffness of the small motion. Each step is solved for by GMRES with the factor of the
first one without friction, which is symmetric and half as large: friction, and contacts that open or stiffen, change
few directions of it. A step that leaves larger forces out of balance is halved. Other than ``equilibrium``, which
condenses the bodies to their contacts, this costs as much for thousands of contacts as for some.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.contact.static_preload import Preload
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.sliding.equilibrium import SlidingState, model_about
from pipeline.physics.sliding.model import SlidingModel

#: nodal forces out of balance, over those of the contacts
BALANCED = 1e-9
#: steps at most, and halvings of each
_STEPS, _HALVINGS = 40, 8
#: forces out of balance, over those of the contacts, up to which the last state is where the next begins
_NEAR = 0.1
#: residual of the linear solution of a step, iterations for it with one factor before it is made anew
_LINEAR, _ITERATIONS = 1e-4, 40


def sliding_on_elements(model: SlidingModel, input_force: np.ndarray, law: tuple, friction: Callable,
                        closure: np.ndarray, solve: "Solutions", centrifugal: bool = True) -> SlidingState:
    """SlidingState of a sparse SlidingModel under ``input_force`` (i,) N.

    ``law``: closures (k,) m and pressures (k,) Pa of the normal contact, from 0; ``friction``: function of pressure and
    sliding speed (c,) that gives a FrictionState; ``closure`` (c,) m to begin with, such as that of a coarser model;
    ``solve``: Solutions, whose factor states of the same model at other loads and speeds may share. Raises
    ConvergenceError where the forces do not balance.
    """
    sought, motion = _Equilibrium(model, input_force @ model.input_rows, law, friction, centrifugal), solve.last
    missing, size = (np.inf, 1.0) if motion is None else sought.missing(motion)
    if not missing <= _NEAR * size:
        motion = solve(*sought.linear(closure))
        missing, size = sought.missing(motion)
    for _ in range(_STEPS):
        if missing <= BALANCED * size:
            solve.last = motion
            return sought.state(sought.closure(motion))
        step = solve(sought.stiffness(motion), sought.out_of_balance(motion), BALANCED * size / missing)
        for length in 0.5 ** np.arange(_HALVINGS):
            trial = sought.missing(motion - length * step)[0]
            if trial < missing:
                break
        motion = motion - length * step
        missing, size = sought.missing(motion)
    raise ConvergenceError("steady sliding on finite elements", f"nodal forces that balance within {BALANCED:g}",
                           f"{missing / size:.1e}", "raise the load, or lower friction")


class Solutions:
    """Solutions of linear equations by GMRES with the factor of a matrix before, or of the last where that is slow:
    without friction or, where that is slow too, with it; ``last``: the motion (n,) of the last state that was found
    with them, or None."""

    def __init__(self, solver):
        self._solver, self._factor, self.last = solver, None, None

    def __call__(self, matrix, rhs, enough=0.0):
        """x (n,) of A x = b, off by no more than a share of b, which need not be less than half of ``enough``."""
        accuracy = max(_LINEAR, enough / 2)
        answer, failed = (None, True) if self._factor is None else self._iterated(matrix, rhs, accuracy)
        for made, symmetric in ((matrix.without_friction, True), (matrix.assembled, False)):
            if not failed:
                break
            self._factor = None         # its memory goes before that of the next
            self._factor = factorise(made(), self._solver, symmetric)
            answer, failed = self._iterated(matrix, rhs, accuracy)
        return answer

    def _iterated(self, matrix, rhs, accuracy):
        """(x, 0 or what failed): x = F^-1 y with A F^-1 y = b, so that forces, not motions, are what is left."""
        forces = scipy.sparse.linalg.LinearOperator(matrix.shape, lambda b: matrix @ self._solved(b), dtype=float)
        answer, failed = scipy.sparse.linalg.gmres(forces, rhs, rtol=accuracy, restart=_ITERATIONS, maxiter=2)
        return self._solved(answer), failed

    def _solved(self, rhs):
        return self._factor.solve(np.ravel(rhs))


@dataclass(frozen=True)
class _Stiffness:
    """K + A k N, sparse, of ``bodies`` K (n, n) and contacts of ``stiffness`` k (c,) N/m: ``acting`` A (n, c) at
    closures by ``normal`` N (c, n)."""

    bodies: "scipy.sparse.csr_matrix"
    acting: "scipy.sparse.csr_matrix"
    stiffness: np.ndarray
    normal: "scipy.sparse.csr_matrix"

    @property
    def shape(self):
        return self.bodies.shape

    def __matmul__(self, motion):
        return self.bodies @ motion + self.acting @ (self.stiffness * (self.normal @ motion))

    def assembled(self):
        return self.bodies + self.acting @ (scipy.sparse.diags(self.stiffness) @ self.normal)

    def without_friction(self):
        return self.bodies + self.normal.T @ (scipy.sparse.diags(self.stiffness) @ self.normal)


@dataclass(frozen=True)
class _Equilibrium:
    """Equation (1) of a sparse SlidingModel under nodal ``load`` (n,) N."""

    model: SlidingModel
    load: np.ndarray
    law: tuple
    friction: Callable
    centrifugal: bool

    def __post_init__(self):
        bodies = self.model.supported(centrifugal=self.centrifugal)[2].real
        object.__setattr__(self, "bodies", scipy.sparse.csr_matrix(bodies))

    def closure(self, motion):
        contacts = self.model.contacts
        return -(contacts.normal @ motion) - contacts.gap

    def state(self, closure):
        force, slope = force_at_rest(closure, self.model.contacts.area, *self.law)
        friction = self.friction(force / self.model.contacts.area, abs(self.model.sliding_speed))
        return SlidingState(Preload(force, slope, closure), friction)

    def stiffness(self, motion):
        return self._about(self.state(self.closure(motion)))

    def _about(self, state):
        about = model_about(self.model, state.contact)
        acting = about.contacts.normal.T + about.contacts.tangent.T @ scipy.sparse.diags(about.coupling(state.friction))
        return _Stiffness(self.bodies, acting, state.contact.stiffness, about.contacts.normal)

    def out_of_balance(self, motion):
        """(n,) N: left less right side of (1)."""
        return self.bodies @ motion - self.load - self._pressed(self.state(self.closure(motion)))

    def _pressed(self, state):
        contacts, force = self.model.contacts, state.contact.force
        drawn = self.model.direction() * state.friction.coefficient * force
        return contacts.normal.T @ force + contacts.tangent.T @ drawn

    def missing(self, motion):
        """(Size of what is out of balance, size of the contact forces) in N."""
        state = self.state(self.closure(motion))
        pressed = self._pressed(state)
        return np.linalg.norm(self.bodies @ motion - self.load - pressed), np.linalg.norm(pressed)

    def linear(self, closure):
        """(Matrix, right side) of the displacements where (1) is taken as linear about closures (c,)."""
        state, contacts = self.state(closure), self.model.contacts
        more = state.contact.stiffness * (closure + contacts.gap)
        coupling = model_about(self.model, state.contact).coupling(state.friction)
        rhs = self.load + self._pressed(state) - contacts.normal.T @ more - contacts.tangent.T @ (coupling * more)
        return self._about(state), rhs
