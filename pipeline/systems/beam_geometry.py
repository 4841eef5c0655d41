"""The geometry of the beam on beam as an inverse problem: parameters, and what they cost.

A geometry is a vector of PARAMETERS. Each number that the paper prints has a band, somewhat inside the tolerance with
which it is compared; the cost is the sum over these numbers of ((distance from the band) / scale)^2, 0 where all lie
inside. A coalescence that is missing costs _MISSING; one that the paper does not know _EXTRA. Fixed are the contact
80 mm from the clamp, 3 kg, 9 N, 5 degrees, steel, and friction on the face of the track.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.stability.coalescence import coalescences
from pipeline.systems.beam_on_beam import build, joined

#: name, lower and upper bound; lengths in mm, widths and damping as logarithms, stiffnesses as powers of ten (SI)
PARAMETERS = (
    ("L1 / mm", 20.0, 160.0), ("t1 / mm", 3.0, 16.0), ("ln(b1 / b2)", np.log(0.2), np.log(5.0)),
    ("L2 / mm", 150.0, 600.0), ("t2 / mm", 5.0, 30.0), ("contact offset", -1.0, 1.0),
    ("lg clamp rotation", 2.5, 6.5), ("lg clamp", 5.5, 10.0), ("lg guide rotation", 2.5, 6.5), ("lg guide", 5.5, 10.0),
    ("ln(b2 / mm)", np.log(0.6), np.log(15.0)), ("ln(alpha 1)", np.log(40.0), np.log(500.0)),
    ("ln(alpha 2)", np.log(5e-9), np.log(6e-7)))
#: how many of them the coalescences depend on; the others matter to the motion alone
GEOMETRY = 10
NAMES, LOWER, UPPER = (np.array(column) for column in zip(*PARAMETERS, strict=True))

#: sense of the tilt that flutters, rad
TILT = -np.pi / 36
_MISSING, _EXTRA = 60.0, 5.0
#: (frequency, friction) of the published coalescences, modes 5 and 6 without friction
COALESCENCES, MODES = ((400.0, 0.16), (2800.0, 0.12), (7700.0, 0.23)), (2500.0, 3100.0)
#: relative half-width of the bands of frequencies and its scale; of friction
_FREQUENCY, _FRICTION = (0.03, 0.015), (0.018, 0.015)
#: of the motion: lower and upper end of the band, scale
MOTION = {"fundamental": (2630.0, 2770.0, 30.0), "peak_force": (33.0, 52.0, 3.0), "peak_slip": (33e-3, 57e-3, 3e-3),
          "share_open": (0.115, 1.0, 0.015), "share_stick": (0.115, 1.0, 0.015), "share_slip": (0.115, 1.0, 0.015),
          "second_height": (8.0, np.inf, 2.0), "third_height": (8.0, np.inf, 2.0), "low_level": (-np.inf, -8.0, 2.0),
          "vibrating_share": (0.1, 0.9, 0.05)}
#: samples of the frequency axis, and degrees of the polynomials, fast enough for 1e5 evaluations
_FREQUENCIES = np.geomspace(40.0, 10.5e3, 2600)
_DEGREES = 9, 12


@dataclass(frozen=True)
class Linear:
    """Cost and coalescences of a geometry; ``unstable`` modes at friction 0.2 without damping."""

    cost: float
    found: object
    unstable: int


def described(vector, tilt=TILT):
    """Parameters of a vector, as ``beam_on_beam.build`` takes them; shorter ones have rigid supports or 10 mm width."""
    vector = np.asarray(vector, float)
    springs = 10 ** vector[6:GEOMETRY] if len(vector) >= GEOMETRY else [None] * 4
    width = np.exp(vector[10]) * 1e-3 if len(vector) > GEOMETRY else 10e-3
    length, thickness, ratio, track_length, track_thickness, offset = vector[:6]
    drag = np.exp(vector[11:13]) if len(vector) > GEOMETRY else (0.0, 0.0)
    return SimpleNamespace(
        slider=SimpleNamespace(length=length * 1e-3, thickness=thickness * 1e-3, width=width * np.exp(ratio), tilt=tilt,
                               guide_rotation_stiffness=springs[2], guide_stiffness=springs[3], degree=_DEGREES[0]),
        track=SimpleNamespace(length=track_length * 1e-3, thickness=track_thickness * 1e-3, width=width,
                              clamp_rotation_stiffness=springs[0], clamp_stiffness=springs[1], degree=_DEGREES[1]),
        material=SimpleNamespace(young=210e9, poisson=0.3, density=7800.0, mass_damping=drag[0],
                                 stiffness_damping=drag[1]),
        contact=SimpleNamespace(distance=0.08, offset=offset, lever=1.0, mass=3.0, force=9.0, patch=4e-3),
        sensor=SimpleNamespace(height=length * 0.5e-3))


def modes_of(bodies):
    """(ContactModes, sensor row, load row) of all modes of both beams."""
    squared, shapes = zip(*(scipy.linalg.eigh(b.stiffness.toarray(), b.mass.toarray()) for b in bodies), strict=True)
    return joined(bodies, [np.maximum(values, 0.0) for values in squared], shapes)


def linear(vector, tilt=TILT):
    """Linear of a vector; a geometry that cannot be built costs as much as one without any coalescence, and more."""
    try:
        modes, *_ = modes_of(build(described(vector, tilt), "timoshenko"))
    except ConfigError:
        return Linear(10 * _MISSING, None, 0)
    pairs = coalescences(modes, _FREQUENCIES, -1.0, most=0.6)
    cost, used = 0.0, set()
    for frequency, friction in COALESCENCES:
        costs = (_outside(pairs.onset_frequency / frequency - 1, *_FREQUENCY)
                 + _outside(pairs.onset_friction - friction, *_FRICTION))
        nearest = costs.min(initial=np.inf)
        if nearest < _MISSING:
            used.add(int(np.argmin(costs)))
        cost += _MISSING * np.tanh(nearest / _MISSING)
    others = [k for k in range(len(pairs.onset_frequency)) if k not in used and pairs.onset_friction[k] < 0.5]
    cost += _EXTRA * len(others) + _modes_cost(pairs.frictionless)
    return Linear(float(cost), pairs, int(np.sum(pairs.onset_friction < 0.2) - np.sum(pairs.end_friction < 0.2)))


def motion_cost(values):
    """Cost of a motion: ``values`` maps the keys of MOTION to numbers."""
    cost = 0.0
    for key, (low, high, scale) in MOTION.items():
        cost += min((max(low - values[key], values[key] - high, 0.0) / scale) ** 2, _MISSING)
    return float(cost)


def _modes_cost(frequencies):
    if len(frequencies) < 6:
        return 2 * _MISSING
    costs = _outside(frequencies[4:6] / np.array(MODES) - 1, *_FREQUENCY)
    return float(_MISSING * np.tanh(costs.sum() / _MISSING))


def _outside(distance, half_width, scale):
    return (np.maximum(abs(distance) - half_width, 0.0) / scale) ** 2
