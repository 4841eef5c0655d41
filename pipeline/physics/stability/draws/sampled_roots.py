"""Unstable roots of many draws of a Family, on bases that serve all of them.

Real modes of the nominal brake below a limit, with corrections for everything that a draw changes (``friction_basis``),
are one basis V (n, m) for all draws of one load. On it a draw at an operating point is its sliding state
(``sampled_sliding``), and the roots about it that grow, or nearly do (``growing_roots``).

For some draws of the same scatter, the training, what V leaves out of the growing modes is computed from their residual
in the whole model, and joins V.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.growing_roots import growing_roots, spectrum_roots
from pipeline.physics.modal.natural_modes import all_modes
from pipeline.physics.sliding.model import SlidingModel
from pipeline.physics.stability.draws.draw_system import BodyLosses, about, draw_system
from pipeline.physics.stability.draws.sampled_sliding import GivenSliding, SlidingBasis, sliding_basis
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.physics.stability.linearisation import maxwell_branches, with_slopes
from pipeline.physics.system.forms import spread
from pipeline.physics.system.terms import Kind, What

#: what joins the basis for the training: amplitudes above this share of the mode
_JOINING = 1e-4
#: growth rate in 1/s from which on roots are compared, and the share of them within which they are the same
_GROWS, _SAME = 1e-2, 1e-6


@dataclass(frozen=True)
class Sampled:
    """A Family on its bases: what the roots of a draw need.

    ``sliding``: basis of its sliding states; ``basis`` (n, m) mass-orthonormal, and ``small``, the SlidingModel, and
    ``losses``, the BodyLosses, on it; ``below`` Hz limits the modes.
    """

    sliding: SlidingBasis | GivenSliding
    basis: np.ndarray
    small: SlidingModel
    losses: BodyLosses
    below: float

    @property
    def family(self):
        """The Family."""
        return self.sliding.family

    def compact(self):
        """The same without what only the whole model needs: for tasks in other processes."""
        family = replace(self.family, model=self.small, loss=self.small.mass[:0], lining=None)
        sliding = self.sliding.compact(family)
        return replace(self, sliding=sliding, basis=self.basis[:0])

    def roots(self, factors, speed):
        """Roots (r,) 1/s of a draw at ``speed`` rad/s by falling growth rate: all that grow, and the least stable one.

        Only those below the frequency limit. Raises ConvergenceError where a draw has no sliding state.
        """
        return self.modes(factors, speed).value

    def modes(self, factors, speed):
        """Growing: ``roots``, their shapes (m, r) on the basis and their residuals."""
        matrices, beside = self.system(factors, speed)
        return growing_roots(*matrices, 2 * np.pi * self.below, beside)

    def spectrum(self, factors, speed):
        """Growing of a draw as of ``modes``, from all its roots on the basis."""
        matrices, beside = self.system(factors, speed)
        return spectrum_roots(*matrices, 2 * np.pi * self.below, beside)

    def missed(self, factors, speed):
        """Number of growing roots of a draw that only one of ``modes`` and ``spectrum`` has."""
        some, every = (each.value[each.value.real > _GROWS]
                       for each in (self.modes(factors, speed), self.spectrum(factors, speed)))
        same = abs(some[:, None] - every) <= _SAME * abs(every)
        return int(np.sum(~same.any(axis=0)) + np.sum(~same.any(axis=1)))

    def system(self, factors, speed):
        """((C, K without friction and losses, what these add to it) of a draw about its sliding state, each (m, m), the
        last complex, what settles beside it or None)."""
        factors = self.family.filled(factors)
        contact = self.sliding.slide(factors, speed)
        whole = draw_system(self.family, self.small.at_speed(speed), factors, contact, self.losses)
        held, drawn = (whole.where(chosen) for chosen in (lambda term: not follows(term), follows))
        change = drawn.matrix(Kind.STIFFNESS) + 1j * whole.matrix(Kind.LOSS)
        return (whole.matrix(Kind.DAMPING), held.matrix(Kind.STIFFNESS), change), whole.beside


def follows(term):
    """Whether a Term is the stiffness by which friction follows the normal force."""
    return term.name == What.CIRCULATORY


def sampled(family, speeds, below, training=(NOMINAL,), smallest=1e-2):
    """Sampled of a Family at the ``speeds`` (v,) rad/s, for roots ``below`` a frequency in Hz.

    ``training``: Factors that its bases are made to serve; corrections up to ``smallest`` per unit of modal amplitude
    are left out. Raises ConfigError for a speed of 0 with friction that turns with the slip.
    """
    middle = float(np.mean(speeds))
    if family.friction_damping and not np.all(speeds):
        raise ConfigError("probability: speeds", "speeds other than 0, with friction damping", "0 rad/s",
                          "leave it out, or set friction_damping to false")
    training = [family.filled(factors) for factors in training]
    sliding = sliding_basis(family, speeds, training)
    contact = sliding.slide(NOMINAL, middle)
    model = with_slopes(about(family, family.model.at_speed(middle), NOMINAL, contact)[0], contact.slopes)
    basis = friction_basis(model, below, family.friction_damping, smallest, model.contacts.stiffness,
                           family.centrifugal, _scattered(family)).shape
    first = _on(sliding, basis, below)
    return _on(sliding, _joined(family.model.mass, basis, _missing(first, model, training, middle)), below)


def _on(sliding, basis, below):
    """Sampled on a basis."""
    family = sliding.family
    return Sampled(sliding, basis, family.model.projected(basis), BodyLosses.on(family, basis), below)


def _scattered(family):
    """(k, n, n) N/m: what else a draw changes: losses, linings, joints by the first part of their name."""
    joints = family.model.joints
    others = [family.imaginary_stiffness()] + ([] if family.lining is None else [family.lining])
    branches, springs, _ = maxwell_branches(family.model)
    others += [spread(branches, springs, branches)] * (len(springs) > 0)
    groups = np.array([name.split("_")[0] for name in joints.name])
    for group in dict.fromkeys(groups):
        rows = joints.rows[groups == group]
        others.append(spread(rows, joints.stiffness[groups == group], rows))
    return np.array(others)


def _missing(first, about, training, speed):
    """(n, 2 g): what the basis of ``first`` leaves out of the growing modes of the ``training``, real and imaginary.

    Answers of the modes of the nominal brake ``about`` to the residuals, at the frequency of each root.
    """
    family = first.family
    mass, _, stiffness = about.frictionless(gyroscopic=False, centrifugal=family.centrifugal)
    square, modes = all_modes(stiffness, mass)
    high, losses = square > (2 * np.pi * first.below) ** 2, BodyLosses.whole(family)
    answers = [np.empty((family.model.size, 0))]
    for factors in training:
        growing, contact = first.modes(factors, speed), first.sliding.slide(factors, speed)
        system = draw_system(family, family.model.at_speed(speed), factors, contact, losses)
        for root, shape in zip(growing.value, (first.basis @ growing.shape).T, strict=True):
            force = modes[:, high].T @ system.apply(root, shape)
            answer = modes[:, high] @ (force / (square[high] - abs(root) ** 2)) / np.linalg.norm(shape @ mass)
            answers.append(np.column_stack((answer.real, answer.imag)))
    return np.hstack(answers)


def _joined(mass, basis, more):
    """(n, m + k) mass-orthonormal: the basis, and what ``more`` (n, g) adds to it."""
    for _ in range(2):
        more = more - basis @ (basis.T @ (mass @ more))
    square, direction = scipy.linalg.eigh(more.T @ mass @ more)
    kept = square > _JOINING**2
    return np.hstack((basis, more @ (direction[:, kept] / np.sqrt(square[kept]))))

