"""Squealing brakes on a bench: the lines that are heard at each operating point, with a disc that moves or one that
does not.

Two-way, the disc is that of ``brake_parts``, whose bending waves are coupled to the pads by contact and friction, with
its forty points of Gauss on either lining; one-way, the same pads slide on a disc that does not move. Pads lean on
abutments whose faces are inclined by an angle b,

    elongation = cos b x + sin b u,      b < 0: friction and lift have opposite signs,

so that they flutter on either disc (N. Hoffmann, M. Fischer, R. Allgaier, L. Gaul, Mech. Res. Commun. 29 (2002) 197).
A mode that grows faster than a small rate squeals: one of these leaves a line with the probability that the bench
draws, a loud one its second harmonic too. Lines are read off a spectrum; a few come from something else.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.brake import brake, brake_parts

TWO_WAY, ONE_WAY, FOREIGN = "two_way", "one_way", "foreign"
#: what the drawings of the bench say, where it is not as in ``brake_parts``: N/m, 1; inclination of the abutments
DRAWN = {**brake_parts.NOMINAL, "contact": 3e8, "abutment_outer": 2.5e8, "abutment_inner": 2.2e8, "friction": 0.5}
INCLINED = -0.15
#: damping of a lining N s/m
CONTACT_LOSS = 60.0
#: standard deviations of the logarithm of the true values about the drawing
SPREAD = {"young": 0.05, "density": 0.03, "contact": 0.15, "friction": 0.08, "abutment_outer": 0.15,
          "abutment_inner": 0.15, "fingers": 0.15, "contact_loss": 0.3, "loss": 0.3}
#: what no drawing says: exponents of stiffness and friction over load, rise of friction at low speed, its speed m/s
UNDRAWN = {"stiffening": (0.0, 0.08), "friction_over_load": (-0.08, 0.08), "rise": (0.0, 0.03), "decay_speed": 0.3}
#: forces of the piston in N, speeds of the disc in rad/s
LOADS, SPEEDS = (350.0, 700.0, 1400.0), (2.0, 6.0)
#: Hz: band of the microphone, resolution of its spectrum
BAND, RESOLUTION = (1000.0, 15e3), 12.5
#: growth rate in 1/s that squeals, and above which a second harmonic is heard in this share of the cases
_SQUEALS, _LOUD, _SECOND = 5.0, 300.0, 0.3
#: share of growing modes that are heard, drawn once for a bench; lines of something else per test
_HEARD, _STRAY = (0.4, 0.9), 0.03
#: lines of a bench that no brake explains: their number, share of the tests that hear one
_LINES, _OFTEN = (2, 4), 0.6


@dataclass(frozen=True)
class Bench:
    """A bench of a ``kind``: its brake (None where lines are foreign), the share of tones heard, and its values."""

    kind: str
    brake: object
    heard: float
    values: dict


def drawn(seed, kind, shape):
    """Bench of a ``kind`` with one of ``brake_parts.SHAPES``, its values drawn about the drawing."""
    random = np.random.default_rng([seed, 1])
    values = {name: value * np.exp(SPREAD.get(name, 0.0) * random.standard_normal()) for name, value in DRAWN.items()}
    values |= {f"loss_{order}": brake_parts.LOSS * np.exp(SPREAD["loss"] * random.standard_normal())
               for order in range(brake_parts.ORDERS + 1)}
    damping = CONTACT_LOSS * np.exp(SPREAD["contact_loss"] * random.standard_normal())
    unstated = {name: float(random.uniform(*UNDRAWN[name])) for name in ("stiffening", "friction_over_load", "rise")}
    hidden = {"contact_damping": {"damping": damping}, "contact_stiffness_law": {"exponent": unstated["stiffening"]},
              "pressure_dependent_friction": {"exponent": unstated["friction_over_load"]},
              "falling_friction": {"rise": unstated["rise"], "decay_speed": UNDRAWN["decay_speed"]}}
    share = float(random.uniform(*_HEARD))
    whole = inclined(brake_parts.built(values, shape, hidden=hidden), values)
    made = {TWO_WAY: whole, ONE_WAY: held(whole), FOREIGN: None}[kind]
    return Bench(kind, made, share, {**values, "contact_loss": damping, **unstated, "heard": share})


def inclined(whole, values):
    """The brake with both abutments inclined by INCLINED."""
    for k, pad in enumerate(brake_parts.PADS):
        along = np.zeros(len(whole.mass))
        along[whole.disc + 3 * k] = 1.0
        leaning = np.cos(INCLINED) * along + np.sin(INCLINED) * np.roll(along, 1)
        whole = whole.with_joint(along, -values[f"abutment_{pad}"], -brake_parts.ABUTMENT_LOSS)
        whole = whole.with_joint(leaning, values[f"abutment_{pad}"], brake_parts.ABUTMENT_LOSS)
    return whole


def held(whole):
    """The brake on a disc that does not move."""
    pads = slice(whole.disc, None)
    square = {name: getattr(whole, name)[pads, pads] for name in ("mass", "damping", "stiffness")}
    rows = {name: getattr(whole, name)[:, pads] for name in ("normal", "tangent", "sensors", "taps")}
    return replace(whole, **square, **rows, press=whole.press[pads], disc=0)


def growing(whole, load, speed):
    """(g,) roots in 1/s that squeal at a force N of the piston and a speed in rad/s, by frequency."""
    root = np.linalg.eigvals(brake.small_motion(whole, brake.Run("", load, speed, 0.0)))
    root = root[(root.real > _SQUEALS) & (root.imag > 0)]
    return root[np.argsort(root.imag)]


def campaign():
    """[(name, force N, speed rad/s)] of the tests of a bench."""
    return [(f"{load:g}N_{speed:g}", load, speed) for load in LOADS for speed in SPEEDS]


def heard(bench, seed):
    """{test: (n,) Hz} of a bench: the lines that a person reads off the spectra, ascending."""
    random = np.random.default_rng([seed, 2])
    if bench.kind == FOREIGN:
        lines = random.uniform(*BAND, random.integers(_LINES[0], _LINES[1] + 1))
        lists = {name: lines[random.uniform(size=len(lines)) < _OFTEN] for name, *_ in campaign()}
    else:
        lists = {name: _heard(growing(bench.brake, load, speed), bench.heard, random)
                 for name, load, speed in campaign()}
    return {name: _read(np.append(lines, random.uniform(*BAND, random.poisson(_STRAY))), random)
            for name, lines in lists.items()}


def _heard(root, share, random):
    """Lines (n,) Hz that growing modes leave."""
    there = random.uniform(size=len(root)) < share
    frequency = root.imag / (2 * np.pi)
    second = there & (root.real > _LOUD) & (random.uniform(size=len(root)) < _SECOND)
    return np.append(frequency[there], 2 * frequency[second])


def _read(lines, random):
    """Lines in the band as read: to the nearest point of the spectrum, each once."""
    lines = lines + random.uniform(-RESOLUTION, RESOLUTION, len(lines))
    lines = RESOLUTION * np.round(lines / RESOLUTION)
    return np.unique(lines[(lines > BAND[0]) & (lines < BAND[1])])
