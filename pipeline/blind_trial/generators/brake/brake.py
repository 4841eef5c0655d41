"""A practice bench: a disc brake, tapped lifted, pressed at rest and in sliding, with physics that nobody was told of.

Its parts are those of ``brake_parts``. A lining presses with N where it closes by a and is dragged with T,

    N = p_0 (a / a_0)^(1 + e) + d a',    T = mu N (N / p_0)^f (1 + r exp(-v / v_s)),    L T_m' = v (T - T_m),

v the slip; at rest it holds on with a stiffness along the disc. Taps are free small motions about the state in which
the brake holds or slides steadily, so sums of complex modes, exactly. Gyroscopic forces are left out: the disc turns
less than once in six seconds. The recorder filters (Butterworth, order 4), adds noise and rounds to 16 bits.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig
from scipy.signal import butter, sosfilt

from pipeline.blind_trial.generators.brake import pad_joints
from pipeline.blind_trial.generators.brake.brake_parts import HIGHEST, PADS
from pipeline.blind_trial.generators.spring_mass.sensors import converted
from pipeline.contract.errors import ConvergenceError

#: what can be hidden, with the sizes it is given: low and high of a draw
HIDDEN = {
    "contact_stiffness_law": {"exponent": (0.25, 0.6)},
    "contact_damping": {"damping": (60.0, 240.0)},
    "falling_friction": {"rise": (0.02, 0.06), "decay_speed": (0.04, 0.12)},
    "contact_memory": {"length": (3e-6, 15e-6)},
    "pressure_dependent_friction": {"exponent": (-0.35, -0.15)},
    "doublet_split": {"share": (0.006, 0.02), "angle": (0.3, 1.2)},
    "attached_mass": {"mass": (0.02, 0.08)},
    "added_stiffness": {"stiffness": (1e5, 5e5)},
    "moving_base": {"compliance": (5e-9, 2e-8), "frequency": (700.0, 1600.0)},
}
#: the same of physics that the catalogue lacks
FOREIGN = {"heated_disc": {"drop": (0.01, 0.03)}, "slack_abutment": {"exponent": (0.15, 0.4)},
           "resonant_clip": {"mass": (0.01, 0.03), "frequency": (900.0, 2800.0)}}
#: decoys: what a sensor, not physics, does
DECOYS = {"sensor_gain": {"error": (0.2, 0.5)}, "sensor_delay": {"delay": (50e-6, 150e-6)}}
#: forces of the piston in N, speeds of the disc in rad/s; force at which laws that depend on pressure are as drawn
LOADS, SPEEDS, REFERENCE = (300.0, 700.0, 1500.0), (0.25, 0.5, 1.0), 700.0
RATE, DURATION = 25.6e3, 0.3
CHANNELS = {"laser_a": "velocity", "laser_b": "velocity", "laser_c": "velocity", "laser_outer": "velocity",
            "accelerometer": "acceleration", "laser_inner": "velocity"}
_UNIT, _NOISE = {"velocity": "m/s", "acceleration": "m/s^2"}, {"velocity": 5e-7, "acceleration": 0.01}
#: instants a sample, corner of the recorder in Hz, error of gains that a calibration leaves
_FINE, _CORNER, _GAIN = 4, 10e3, 0.002
#: sizes of taps at rest and in sliding, N s; powers of e by which a tap may grow while it is recorded
_TAPS, _GROWN = (2e-3, 2e-4), 3.0
_ROUNDS, _TOLERANCE, _OPEN = 60, 1e-10, 1e-3


@dataclass(frozen=True)
class Run:
    """An operating point: ``load`` N of the piston, ``speed`` rad/s, ``warmth`` of the disc from 0 at first to 1."""

    name: str
    load: float
    speed: float
    warmth: float


def campaign():
    """Runs of a brake: lifted, at rest under every load, in sliding under every load and at every speed."""
    plan = [("lifted", 0.0, 0.0), *((f"rest_{load:g}N", load, 0.0) for load in LOADS)]
    plan += [(f"sliding_{load:g}N_{speed:g}", load, speed)
             for load, speed in (*((load, SPEEDS[1]) for load in LOADS), *((LOADS[1], s) for s in SPEEDS[::2]))]
    return tuple(Run(*each, k / (len(plan) - 1)) for k, each in enumerate(plan))


def record(brake, seed, plan=None):
    """{run: dict} of the runs of a ``plan``, none: a whole campaign, as ``files.leave`` takes it, every run twice.

    ConvergenceError where the brake squeals, or where a lining lifts off.
    """
    random, runs = np.random.default_rng([seed, 1]), {}
    gain = dict(zip(CHANNELS, 1 + _GAIN * random.standard_normal(len(CHANNELS)), strict=True))
    for run in plan or campaign():
        root, shape, kick = vibrations(brake, run)
        if root.real.max() * DURATION > _GROWN:
            raise ConvergenceError("practice brake", "a brake that does not squeal",
                                   f"growth by {root.real.max():.3g} 1/s in {run.name}")
        for again in (1, 2):
            blow = _TAPS[run.speed > 0] * random.uniform(0.5, 1.5, len(brake.taps))
            runs[f"{run.name}_{again}"] = {
                "repeat_of": f"{run.name}_1" if again == 2 else "",
                "conditions": {"press": (run.load, "N"), "speed": (run.speed, "rad/s")},
                "channels": _recorded(brake, root, shape * (kick @ blow)[:, None], gain, random)}
    return runs


def _recorded(brake, root, amplitude, gain, random):
    """{channel: (samples, unit, quantity, rate, role)} of velocities Re sum amplitude exp(root t)."""
    time = np.arange(round(DURATION * RATE) * _FINE) / (RATE * _FINE)
    waves = np.exp(np.outer(root, time))
    guard = butter(4, _CORNER, fs=RATE * _FINE, output="sos")
    late, wrong = (brake.hidden.get(name, {}) for name in ("sensor_delay", "sensor_gain"))
    channels = {}
    for (name, quantity), amplitudes in zip(CHANNELS.items(), amplitude.T, strict=True):
        values = gain[name] * ((root ** (quantity == "acceleration") * amplitudes) @ waves).real
        if late.get("channel") == name:
            values = np.interp(time - late["delay"], time, values, left=0.0)
        if wrong.get("channel") == name:
            values = (1 + wrong["error"]) * values
        values = sosfilt(guard, values)[::_FINE]
        values = values + _NOISE[quantity] * random.standard_normal(len(values))
        channels[name] = (converted(values, 1.25 * abs(values).max()).astype(np.float32), _UNIT[quantity], quantity,
                          RATE, "response")
    return channels


def vibrations(brake, run):
    """(root (p,), shape (p, s), kick (p, h)) below HIGHEST: blows J give velocities Re sum shape (kick J) e^pt."""
    matrix, size = small_motion(brake, run), len(brake.mass)
    value, left, right = eig(matrix, left=True)
    kept = (value.imag > 0) & (value.imag < 2 * np.pi * HIGHEST)
    left, right = left[:, kept].conj().T, right[:, kept]
    blow = np.zeros((len(matrix), len(brake.taps)))
    blow[size:2 * size] = np.linalg.solve(brake.mass, brake.taps.T)
    kick = 2 * (left @ blow) / np.sum(left.T * right, axis=0)[:, None]
    return value[kept], (brake.sensors @ right[size:2 * size]).T, kick


def small_motion(brake, run):
    """State matrix of (q, q', friction that lags) about the steady state of a run. ConvergenceError as ``record``."""
    size, stiffness, damping = len(brake.mass), parts(brake, run), brake.damping
    push, fed, rate = np.zeros((size, 0)), np.zeros((0, 2 * size)), np.zeros(0)
    if run.load > 0:
        place, press, slope = pressed(brake, run)
        loss = brake.share * brake.hidden.get("contact_damping", {}).get("damping", 0.0)
        stiffness = pad_joints.leaning(brake, stiffness, place) + (brake.normal.T * slope) @ brake.normal
        damping = damping + (brake.normal.T * loss) @ brake.normal
        if run.speed > 0:
            _, gain, drag = friction(brake, run, press)
            drawn = np.hstack(((gain * slope)[:, None] * brake.normal,
                               (gain * loss)[:, None] * brake.normal + drag[:, None] * brake.tangent))
            if memory := brake.hidden.get("contact_memory"):
                rate = run.speed * brake.radius / memory["length"]
                push, fed = brake.tangent.T, -rate[:, None] * drawn
            else:
                stiffness, damping = (whole + brake.tangent.T @ part for whole, part in zip(
                    (stiffness, damping), np.hsplit(drawn, 2), strict=True))
    whole = np.zeros((2 * size + len(rate),) * 2)
    whole[:size, size:2 * size] = np.eye(size)
    whole[size:2 * size] = np.linalg.solve(brake.mass, np.hstack((-stiffness, -damping, push)))
    whole[2 * size:] = np.hstack((fed, -np.diag(rate)))
    return pad_joints.relaxing(brake, whole)


def parts(brake, run):
    """Stiffness (n, n) of the parts, as warm and as loaded as in a run, and of linings that hold on."""
    stiffness = pad_joints.relaxed(brake)
    if heat := brake.hidden.get("heated_disc"):
        cold = np.ones(len(stiffness))
        cold[:brake.disc] = np.sqrt(1 - heat["drop"] * run.warmth)
        stiffness *= np.outer(cold, cold)
    if (slack := brake.hidden.get("slack_abutment")) and run.load > 0:
        for k, pad in enumerate(PADS):
            at = brake.disc + 3 * k
            stiffness[at, at] += brake.values[f"abutment_{pad}"] * ((run.load / REFERENCE) ** slack["exponent"] - 1)
    if run.load > 0 and run.speed == 0:
        stiffness += (brake.tangent.T * (brake.share * brake.values["shear"])) @ brake.tangent
    return stiffness


def friction(brake, run, press):
    """(T / N, dT / dN, dT / dt' less its sign), each (c,), at forces ``press`` (c,): slip is speed radius - t'."""
    slip = run.speed * brake.radius
    falling = brake.hidden.get("falling_friction", {"rise": 0.0, "decay_speed": 1.0})
    power = brake.hidden.get("pressure_dependent_friction", {}).get("exponent", 0.0)
    fall = falling["rise"] * np.exp(-slip / falling["decay_speed"])
    still = brake.values["friction"] * (press / (REFERENCE * brake.share)) ** power
    return still * (1 + fall), still * (1 + fall) * (1 + power), -still * press * fall / falling["decay_speed"]


def pressed(brake, run):
    """(q (n,), N (c,), dN/da (c,)) of the steady state of a run, by Newton's method. ConvergenceError as ``record``."""
    exponent = brake.hidden.get("contact_stiffness_law", {}).get("exponent", 0.0)
    stiffness, normal, tangent = parts(brake, run), brake.normal, brake.tangent
    force, reach = REFERENCE * brake.share, (1 + exponent) * REFERENCE / brake.values["contact"]
    nominal = reach * (run.load / REFERENCE) ** (1 / (1 + exponent))
    displacement = np.linalg.lstsq(normal, np.full(len(normal), -nominal), rcond=None)[0]
    for _ in range(_ROUNDS):
        approach = np.maximum(-normal @ displacement, _OPEN * reach)
        press = force * (approach / reach) ** (1 + exponent)
        slope = (1 + exponent) * press / approach
        drawn, gain, _ = friction(brake, run, press) if run.speed > 0 else np.zeros((3, len(press)))
        held = pad_joints.carried(brake, stiffness @ displacement, displacement)
        error = held - press @ (normal + drawn[:, None] * tangent) - brake.press * run.load
        there = pad_joints.leaning(brake, stiffness, displacement)
        step = np.linalg.solve(there + ((normal + gain[:, None] * tangent).T * slope) @ normal, error)
        displacement = displacement - step
        if max(abs(normal @ step).max(), pad_joints.moved(brake, step)) < _TOLERANCE * reach:
            break
    else:
        raise ConvergenceError("practice brake", "a steady state", f"none in {run.name}")
    if (-normal @ displacement <= _OPEN * reach).any():
        raise ConvergenceError("practice brake", "linings that touch all over", f"one that lifts off in {run.name}")
    return displacement, press, slope
