"""Which single value, changed as far as parts can be, takes the growth from a mode: by derivatives, then by roots."""

from fnmatch import fnmatchcase

import numpy as np

from pipeline.case_models.sensitivity.matrices import system_of
from pipeline.contract import ConvergenceError
from pipeline.physics.modal.quadratic_eigenproblem import DenseFactors, polished

#: values that a designer may change -> largest decrease and increase, in shares of the value; those of loss factors in
#: units of the factor
LIMITS = (("friction", (0.3, 0.3)), ("*_stiffness", (0.5, 1.0)), ("*.lining_young", (0.5, 1.0)), ("*young", (0.1, 0.1)),
          ("*densit*", (0.1, 0.1)), ("*.loss_factor", (0.0, 0.2)), ("*_loss_factor", (0.0, 0.2)))
#: values whose names end so are conditions, or stand for many parts at once
_GIVEN = ("contact_stiffness", "structure.joints.seal_stiffness", "structure.joints.piston_stiffness", "*.fluid.*")
#: growth rate that is aimed at, over the one of the mode: slightly stable
_AIM = -0.01
#: solutions of the whole model at most
_TRIALS = 5
#: change of a frequency beyond which another mode was found
_SAME = 0.02


def candidates(values, growth, slopes, count):
    """Indices of the Parameters ``values`` that take the ``growth`` 1/s of a mode at the smallest part of what they can
    be changed by, at most ``count``; ``slopes`` (p,) 1/s of the growth rate per reference."""
    needed = -growth / np.where(slopes == 0, np.inf, slopes)
    share = np.array([_share(value, step) for value, step in zip(values, needed, strict=True)])
    order = np.argsort(share, kind="stable")
    return [int(k) for k in order[:count] if share[k] <= 1]


def _share(value, step):
    """Needed ``step``, in references of a Parameter, over what it can be changed by; infinite where it cannot."""
    limit = next((room for pattern, room in LIMITS if fnmatchcase(value.name, pattern)), None)
    if limit is None or step == 0 or any(fnmatchcase(value.name, pattern) for pattern in _GIVEN):
        return np.inf
    of_loss = value.name.endswith("loss_factor")
    room = limit[int(step > 0)] / value.reference if of_loss else limit[int(step > 0)] * value.value / value.reference
    return abs(step) / room if room > 0 else np.inf


def stabilised(case, root, shape, value, slope, friction_map, points):
    """(step, root) at which a mode no longer grows, or grows least: a Parameter by ``step`` references more, and the
    root 1/s in the whole reduced model, found by secants; None where the mode cannot be followed.

    ``root`` 1/s and ``shape`` (n,) of the mode of a Case; ``slope`` complex 1/s per reference.
    """
    path, aim = [(0.0, root)], _AIM * root.real
    first = (aim - root.real) / slope.real
    step, expected = first, root + first * slope
    for _ in range(_TRIALS):
        try:
            system = system_of(value.changed(case, step), friction_map, points)
            now, shape = polished(*system.matrices(), expected, shape, system.beside, DenseFactors(np.complex64))
        except ConvergenceError:
            break
        if abs(now.imag / expected.imag - 1) > _SAME:
            break
        path.append((step, now))
        slope = (path[-1][1] - path[-2][1]) / (path[-1][0] - path[-2][0])
        if now.real <= 0 or slope.real * first >= 0:
            break
        step = min(max(step + (aim - now.real) / slope.real, 2 * min(first, 0.0)), 2 * max(first, 0.0))
        if step == path[-1][0]:
            break
        expected = now + (step - path[-1][0]) * slope
    return min(path[1:], key=lambda point: point[1].real, default=None)
