"""Cases on the squealing bench: the workshop's model, the lists of lines that it was given, and what is true.

The workshop's disc is a thin plate of four cells along the radius, whose frequencies are those that it tapped on the
free disc; sixteen points of Gauss are its linings, and its friction and stiffness do not depend on the load. It
believes its chain to be one-way, with multiples of the tones of pads on a disc that does not move.
"""

import numpy as np
from numpy.polynomial import legendre

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.brake import brake_model, brake_parts, squealing_brake
from pipeline.blind_trial.generators.brake.annulus import Disc, thick, thin
from pipeline.blind_trial.generators.brake.squealing_brake import BAND, CONTACT_LOSS, DRAWN, INCLINED, LOADS, RESOLUTION

#: area of the piston in m^2; error of tapped frequencies; points of a lining along and across; orders with a circle
PISTON, _TAPPED, _POINTS, _CIRCLES = 2.5e-3, 0.003, (8, 2), 4
#: draws of each hypothesis, relative error of a frequency: that of coarser and finer plates at 10 kHz
_DRAWS, _ERROR = 400, 0.012


def write(seed, kind, folder):
    """A bench of a ``kind`` of ``squealing_brake``: nominal.yaml and recordings.h5 in a folder; returns the truth."""
    random = np.random.default_rng([seed, 3])
    shape = brake_parts.SHAPES[random.integers(len(brake_parts.SHAPES))]
    bench = squealing_brake.drawn(seed, kind, shape)
    lists = squealing_brake.heard(bench, seed)
    runs = {name: {"conditions": {"pressure": (load / PISTON, "Pa"), "speed": (speed, "rad/s")}, "channels": {},
                   "lines": {"microphone": (lists[name], RESOLUTION)}} for name, load, speed in
            squealing_brake.campaign()}
    case_files.leave(folder, nominal(shape, tapped(bench.values, shape, random)), runs)
    return {"kind": kind, "seed": seed, "values": bench.values}


def tapped(values, shape, random):
    """{(order, number of circles): Hz} of the free disc, as tapped."""
    plate = Disc(*shape, values["young"], brake_parts.POISSON, values["density"])
    waves = {order: thick(plate, order).frequency for order in range(brake_parts.ORDERS + 1)}
    return {(order, circle): frequency[circle] * (1 + _TAPPED * random.standard_normal())
            for order, frequency in waves.items() for circle in range(1 + (order <= _CIRCLES))}


def nominal(shape, frequency):
    """The case of the workshop, with the tapped ``frequency`` {(order, circles): Hz} of its disc."""
    waves = _waves(shape, frequency)
    return {
        "chain": "lumped_squeal", "title": "Squealing brake",
        "description": "Tones of a bench at six operating points: made by pads on a disc that does not move, or by a"
                       " disc that is flexible in the loop?",
        "lumped": {"masses": brake_model.masses(waves), "springs": _springs(waves),
                   "contacts": brake_model.contacts(waves, shape, _points(shape)),
                   "inputs": {"press": {"along": {"pad_inner.z": -1, "caliper.z": -1}, "force": f"{PISTON:g} N"}},
                   "load_factors": [f"{load / PISTON:g} Pa" for load in LOADS]},
        "complex_modes": {"speeds": ["4 rad/s"], "friction": DRAWN["friction"], "friction_steps": 3,
                          "frequency_max": f"{BAND[1]:g} Hz", "damping_speed": f"{LOADS[1] / CONTACT_LOSS:.3g} m/s"},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "line_evidence": _asked(waves)}


def _asked(waves):
    """Section line_evidence: what scatters about the drawing, and the hypotheses."""
    falling = {"falling": [0, 0.1]}
    return {
        "runs": [name for name, *_ in squealing_brake.campaign()], "list": "microphone", "disc": list(waves),
        "low": f"{BAND[0]:g} Hz", "high": f"{BAND[1]:g} Hz", "heard": [0.2, 0.95], "model_error": _ERROR,
        "draws": _DRAWS, "sources": [
            *({"kind": "joint_stiffness", "part": part, "variation": 0.2}
              for part in ("abutment_outer", "abutment_inner", "fingers")),
            {"kind": "contact_stiffness", "variation": 0.2}, {"kind": "joint_loss", "variation": 0.5},
            {"kind": "damping_speed", "range": [0.33, 3]}, {"kind": "friction", "variation": 0.06},
            {"kind": "friction_over_speed", "variation": 0.01}],
        "hypotheses": {"one_way": {"disc": "rigid", "harmonics": True},
                       "one_way_falling_friction": {"disc": "rigid", "harmonics": True, **falling},
                       "flexible_disc": {"disc": "flexible"},
                       "flexible_saturated": {"disc": "flexible", "harmonics": True},
                       "flexible_falling_friction": {"disc": "flexible", "harmonics": True, **falling}}}


def _waves(shape, frequency):
    """{body: (order, mass kg, stiffness N/m, at)} as ``brake_model`` has them, at the tapped frequencies."""
    waves = {}
    for (order, circle), tapped_at in frequency.items():
        plate = thin(brake_model.drawn(shape), order)
        rim = plate.at(shape[2])[0][0, circle]

        def at(radius, plate=plate, circle=circle, rim=rim):
            return tuple(float(part[0, circle] / rim) for part in plate.at(radius))

        waves[f"wave_{order:02d}{'_circle' * circle}"] = (order, rim**-2, (2 * np.pi * tapped_at / rim) ** 2, at)
    return waves


def _springs(waves):
    """Springs of the waves and joints; abutments are inclined."""
    springs = brake_model.springs(waves, DRAWN)
    for pad in brake_parts.PADS:
        springs[f"abutment_{pad}"]["along"] = {f"pad_{pad}.x": float(np.cos(INCLINED)),
                                               f"pad_{pad}.z": float(np.sin(INCLINED))}
    return springs


def _points(shape):
    """[(name, angle, radius, stiffness)] of a lining by Gauss's rule over its face."""
    (along, weight_along), (across, other) = (legendre.leggauss(count) for count in _POINTS)
    radius = shape[2] - brake_parts.INSET - brake_parts.WIDTH / 2 * (1 - across)
    share = np.outer(weight_along, other * radius)
    share *= DRAWN["contact"] / share.sum()
    return [(f"{k}{m}", brake_parts.HALF_ANGLE * along[k], radius[m], f"{share[k, m]:.6g} N/m")
            for k in range(_POINTS[0]) for m in range(_POINTS[1])]
