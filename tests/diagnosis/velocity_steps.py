"""A block that a machine drags over a counterface through velocity steps, integrated by SciPy from the law alone.

The load point is recorded, the load cell is the spring of the machine. The block has no inertia to speak of, which the
truth leaves out: its speed is what the regularised law gives for the force of the spring, v = 2 v_0 sinh(F / (a F_0))
exp(-(1 + b psi) / a).
"""

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.products import Channel, Recording
from pipeline.products import Run as RunProduct
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model

RATE, MACHINE, DRAG, REFERENCE = 100.0, 1e5, 100.0, 1e-6
SYSTEM = {"masses": {"block": {"mass": "1 kg", "moves": ["x"]}},
          "springs": {"machine": {"between": ["block.x", "ground"], "stiffness": f"{MACHINE} N/m"},
                      "face": {"between": ["block.x", "ground"], "damping": f"{DRAG} N s/m"}},
          "inputs": {"load_point": {"displaces": "machine", "displacement": "1 m"}},
          "sensors": {"block": {"along": {"block.x": 1}, "quantity": "displacement", "unit": "m"}}}
LAID = {"step": "5 ms", "inputs": {"load_point": {"channel": "point"}},
        "channels": {"slip": {"quantity": "displacement", "source": "block"},
                     "load": {"quantity": "joint_force", "source": "machine"}}}
NOISE = {"slip": 5e-7, "load": 0.05}
#: speeds of the load point in um/s, each for 4 s; the first loads the block
COURSES = {"steps_1": (200, 20, 200, 20), "steps_2": (200, 50, 500, 50), "steps_3": (300, 10, 100, 300),
           "steps_4": (250, 25, 250, 100)}


def load_point(speeds):
    """Displacement (n,) in m at the samples."""
    since = np.arange(len(speeds)) * 4.0
    time = np.arange(round(4.0 * len(speeds) * RATE) + 1) / RATE
    change = 1e-6 * np.diff(speeds, prepend=0.0)
    return np.maximum(time[:, None] - since, 0.0) @ change


def dragged(point, force, direct, evolution, length, law):
    """(slip, load), each (n,), under rate-and-state friction by the ``law`` ageing or slip."""
    time = np.arange(len(point)) / RATE

    def speed(t, x, psi):
        pull = MACHINE * (np.interp(t, time, point) - x)
        return 2 * REFERENCE * np.sinh(np.clip(pull / (force * direct), -600, 600)) * np.exp(
            -(1 + evolution * psi) / direct)

    def slope(t, state):
        v = speed(t, *state)
        if law == "ageing":
            return [v, REFERENCE / length * np.exp(-state[1]) - abs(v) / length]
        return [v, -abs(v) / length * (state[1] + np.log(max(abs(v), 1e-300) / REFERENCE))]

    whole = solve_ivp(slope, (0, time[-1]), [0.0, 0.0], "Radau", time, rtol=1e-7, atol=1e-12, max_step=0.02)
    return whole.y[0], MACHINE * (whole.y[0] - point)


def recording(force=30.0, direct=0.012, evolution=0.018, length=2e-5, law="ageing", seed=1):
    """Product Recording of the COURSES with NOISE."""
    random, runs = np.random.default_rng(seed), {}
    for name, speeds in COURSES.items():
        point = load_point(speeds)
        shown = dict(zip(("slip", "load"), dragged(point, force, direct, evolution, length, law), strict=True))
        channels = {n: _channel(v + NOISE[n] * random.standard_normal(len(v)), "N" if n == "load" else "m", "response")
                    for n, v in shown.items()}
        channels["point"] = _channel(point, "m", "excitation")
        runs[name] = RunProduct(description="", repeat_of="", channels=channels)
    return Recording(source=["made for a test"], runs=runs)


def _channel(samples, unit, role):
    return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures="", rate=RATE, begin=0.0,
                   place="", position=[], direction=[], role=role)


def problem(given, weighed=()):
    """DiagnosisProblem of a Recording, its last run held out."""
    laid = fill(benches.Settings, LAID, "bench")
    reduced = reduced_model(lumped(settings=fill(LumpedSettings, SYSTEM, "lumped")), settings=ReductionSettings())
    asked = {"parameters": {"joints.machine.stiffness": {"spread": 0.05}}, "held_out": ["steps_4"],
             "noise": {"std": {"slip": f"{NOISE['slip']} m", "load": f"{NOISE['load']} N"}}, "effects": list(weighed)}
    return forced_problem(benches.built(reduced, laid), recorded(given, laid, reduced),
                          fill(Settings, asked, "diagnosis"))
