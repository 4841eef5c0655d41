"""Cases on the practice brake as a trial draws them: their two files, and their truth.

What a draw says of size and noise does not count here: both are those of the bench, drawn within their ranges.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.brake import brake
from pipeline.blind_trial.generators.brake.annulus import thick, thin
from pipeline.blind_trial.generators.brake.brake_model import (
    BAND,
    JOINTS,
    RESOLUTION,
    SEEN,
    SOURCES,
    SPLIT,
    SPREAD,
    STIFF,
    WAVE_SPREAD,
    WORDS,
    drawn,
    nominal,
)
from pipeline.blind_trial.generators.brake.brake_parts import LOSS, NOMINAL, ORDERS, SHAPES, built
from pipeline.blind_trial.generators.brake.pad_joints import FURTHER
from pipeline.blind_trial.generators.spring_mass.detectability import Explained
from pipeline.blind_trial.generators.spring_mass.placement import BELOW
from pipeline.blind_trial.generators.spring_mass.rig_case import FAR
from pipeline.contract.errors import ConvergenceError

#: values that the truth draws beside what the waves of the disc say of them
_OWN = ("contact", "shear", "friction", *JOINTS)
#: values that may be far off, by their names in the case
_FAR_OFF = {"contact": "contact.stiffness", **{name: f"joints.{name}.stiffness" for name in JOINTS}}
#: which value tells how much there is of what is hidden
_SIZE = {"contact_stiffness_law": "exponent", "contact_damping": "damping", "falling_friction": "rise",
         "contact_memory": "length", "pressure_dependent_friction": "exponent", "doublet_split": "share",
         "attached_mass": "mass", "added_stiffness": "stiffness", "moving_base": "compliance"}
#: largest departure of the logarithm of a value; relative step of differences; rounds for a size, and its tolerance
_LARGEST, _STEP, _ROUNDS, _NEAR = 0.3, 1e-3, 20, 0.2


def write(draw, folder, shape=None):
    """A disc brake, tapped lifted, pressed and sliding: its two files, and its truth. Its ``shape`` is drawn unless
    given."""
    random = np.random.default_rng([draw.seed, 2])
    drawn_shape = SHAPES[random.integers(len(SHAPES))]
    shape = shape or drawn_shape
    values = drawn_values(random)
    far = str(random.choice(tuple(_FAR_OFF))) if draw.kind == "wrong_value" else ""
    if far:
        values[far] = NOMINAL[far] * float(random.uniform(*FAR)) ** int(random.choice((-1, 1)))
    hidden = {name: sizes(random, name) for name in draw.hidden}
    seen = Seen(values, shape) if hidden and draw.kind != "sensor" else None
    if draw.kind == "below":
        hidden = _faint(seen, hidden, float(random.uniform(*BELOW)))
    case_files.leave(folder, nominal(shape), brake.record(built(values, shape, hidden=hidden), draw.seed))
    truth = {"class": draw.kind, "system": draw.system, "seed": draw.seed, "parameters": _known(values, shape),
             "effects": [named(*effect) for effect in hidden.items()], "wrong": _FAR_OFF.get(far, "")}
    return {**truth, "left": seen.left(hidden)} if seen else truth


def drawn_values(random):
    """{name: SI value} of a brake drawn about the drawing."""
    values = {name: value * _factor(random, SPREAD[name]) for name, value in NOMINAL.items()}
    return values | {f"loss_{order}": LOSS * _factor(random, SPREAD["loss"]) for order in range(ORDERS + 1)}


def hides():
    """{class: ((name,), ...)} of what a brake hides."""
    effects, decoys, foreign = (tuple((name,) for name in names) for names in (
        brake.HIDDEN, brake.DECOYS, brake.FOREIGN))
    return {"control": ((),), "wrong_value": ((),), "effect": effects, "below": effects, "sensor": decoys,
            "foreign": foreign}


class Seen:
    """What poles show of a brake of ``values`` and one of SHAPES that hides nothing, and what its values explain."""

    def __init__(self, values, shape):
        low, high = (2 * np.pi * edge for edge in BAND)
        self.values, self.shape = values, shape
        self.roots = [r[(r.imag > low) & (r.imag < high)] for r in _roots(built(values, shape))]
        nudged = [(SPREAD[name], built({**values, name: values[name] * (1 + _STEP)}, shape)) for name in _OWN]
        nudged += [(spread, built(values, shape, {(what.split("_")[-1], order): 1 + _STEP}))
                   for what, spread in WAVE_SPREAD.items() for order in range(len(SEEN) + len(STIFF))]
        self.explained = Explained(np.array([spread / _STEP * self._change(bench) for spread, bench in nudged])[
            :, None, None])

    def left(self, hidden):
        """d of ``spring_mass.detectability``: what other values leave of the change of all poles by ``hidden``."""
        change = self._change(built(self.values, self.shape, hidden=hidden))
        return self.explained.left(change[None, None], np.ones(1))

    def _change(self, bench):
        """Changes (2 p,) of the poles of all runs in standard deviations, all growth rates first."""
        there = np.concatenate(self.roots)
        change = (np.concatenate(_followed(self.roots, bench)) - there) / (RESOLUTION * abs(there))
        return np.concatenate((change.real, change.imag))


def _roots(bench):
    """[(p,)] roots in rad/s of every run that turn."""
    spectra = [np.linalg.eigvals(brake.small_motion(bench, run)) for run in brake.campaign()]
    return [roots[roots.imag > 0] for roots in spectra]


def _followed(roots, bench):
    """[(p,)] of every run: the roots of a bench that come nearest to ``roots`` [(p,)], each once."""
    return [other[linear_sum_assignment(abs(np.subtract.outer(previous, other)))[1]]
            for previous, other in zip(roots, _roots(bench), strict=True)]


def _faint(seen, hidden, wanted):
    """What is hidden, so small that other values leave about ``wanted`` of it. ConvergenceError where none is found."""
    (name, parameters), = hidden.items()
    for _ in range(_ROUNDS):
        now = seen.left({name: parameters})
        if abs(np.log(now / wanted)) < _NEAR:
            return {name: parameters}
        parameters = {**parameters, _SIZE[name]: parameters[_SIZE[name]] * float(np.clip(wanted / now, 0.05, 2.0))}
    raise ConvergenceError("practice brake", f"a size that leaves {wanted:.2g}", f"{now:.2g} at last")


def _factor(random, spread):
    return float(np.exp(np.clip(spread * random.standard_normal(), -_LARGEST, _LARGEST)))


def sizes(random, name):
    """Values of what is hidden, and where it is."""
    ends = {**brake.HIDDEN, **brake.FOREIGN, **brake.DECOYS, **FURTHER}[name]
    sizes = {key: float(random.uniform(*pair)) for key, pair in ends.items()}
    where = {"doublet_split": ("order", SPLIT), "attached_mass": ("sensor", (0, 1, 2)),
             "added_stiffness": ("sensor", (0, 1, 2)), "resonant_clip": ("sensor", (0, 1, 2, 3, 5)),
             "moving_base": ("pad", (0, 1)), "cubic_stiffness": ("pad", (0, 1))}
    where |= dict.fromkeys(brake.DECOYS, ("channel", ("laser_outer", "accelerometer")))
    if name in where:
        key, options = where[name]
        sizes[key] = random.choice(options).item()
    return sizes


def named(name, values):
    """{name, place, parameters} of what is hidden, in the words of the catalogue where they mean the same."""
    location = {"heated_disc": "disc", "slack_abutment": "abutments", "shim_damping": "fingers"}.get(name, "contact")
    known = {key: value for key, value in values.items() if key not in ("order", "sensor", "pad", "channel")}
    if name == "doublet_split":
        location, known = f"{WORDS[values['order']]} 1", {}
    elif name == "contact_damping":
        known = {}
    elif name == "pressure_dependent_friction":
        known = {"exponent": -values["exponent"]}
    elif "sensor" in values:
        location = SOURCES[values["sensor"]]
    elif "pad" in values:
        location = JOINTS[values["pad"]]
    elif "channel" in values:
        location = values["channel"]
    return {"name": name, "place": location, "parameters": known}


def _known(values, shape):
    """{name in the case: true SI value, or factor} of what the reduced model means as the bench does."""
    plate = drawn(shape)
    true = replace(plate, young=values["young"], density=values["density"])
    factors = {f"bodies.{word}.frequency": float(thick(true, order).frequency[0] / thin(plate, order).frequency[0])
             for order, word in enumerate(SEEN)}
    return factors | {f"joints.{name}.stiffness": values[name] for name in JOINTS} | {
        "friction": values["friction"] / NOMINAL["friction"]}
