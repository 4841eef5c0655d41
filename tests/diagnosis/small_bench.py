"""A pin on an arm that rubs on a rigid disc, tapped and turned: recordings of its free vibrations by their roots."""

import numpy as np

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, with_effects
from pipeline.case_models.runs import Recorded
from pipeline.contract.settings import fill
from pipeline.physics.virtual_rig.modes import modes, motions, order_locked
from pipeline.physics.virtual_rig.response import Run
from pipeline.physics.virtual_rig.sensor import ACCELERATION
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model

RATE, SECONDS, NOISE = 4096.0, 0.5, 1e-5
PIN, BENDING, CARRIAGE, ARM, CONTACT, SHEAR, TILT = 1.0, 4e5, 0.5, 1e5, 2e5, 3e5, 0.2
LUMPED = {
    "masses": {"pin": {"mass": f"{PIN} kg", "moves": ["y"]}, "carriage": {"mass": f"{CARRIAGE} kg", "moves": ["z"]}},
    "springs": {"bending": {"between": ["pin.y", "ground"], "stiffness": f"{BENDING} N/m", "damping": "8 N s/m"},
                "arm": {"between": ["carriage.z", "ground"], "stiffness": f"{ARM} N/m", "damping": "5 N s/m"}},
    "contacts": {"tip": {"tangent": {"pin.y": 1}, "normal": {"carriage.z": 1, "pin.y": TILT},
                         "stiffness": f"{CONTACT} N/m", "lever": "100 mm"}},
    "inputs": {"press": {"along": {"carriage.z": -1}, "force": "10 N"}},
    "sensors": {"tip": {"along": {"pin.y": 1, "carriage.z": 0.5}}}}
BENCH = {"step": "0.1 ms", "contact": "penalty", "friction": 0.3, "description": "elastic",
         "tangential_stiffness": f"{SHEAR} N/m", "poles": {"low": "40 Hz", "high": "400 Hz"},
         "channels": {"laser": {"quantity": "velocity", "source": "tip"},
                      "accelerometer": {"quantity": "acceleration", "source": "tip"},
                      "cell": {"quantity": "joint_force", "source": "arm"}}}
RUNS = {"lifted": (0.0, 0.0), "rest": (10.0, 0.0), "slow_5": (5.0, 0.5), "slow_10": (10.0, 0.5), "fast": (10.0, 2.0)}


def laid_out(**more):
    return fill(benches.Settings, {**BENCH, **more}, "bench")


def model():
    """Product ReducedModel."""
    return reduced_model(lumped(settings=fill(LumpedSettings, LUMPED, "lumped")), settings=ReductionSettings())


def bench(hidden=None, **more):
    """Bench with the block ``hidden`` of effects on it."""
    built = benches.built(model(), laid_out(**more))
    return with_effects(built, product(fill(EffectSettings, hidden or {}, "effects")))


def run(name):
    """Run of the plan above."""
    press, speed = RUNS[name]
    return Run(name, SECONDS, RATE, conditions={"press": press, "speed": speed})


def recorded(whole, seed=0):
    """{name: Recorded}: every run twice, sums of the modes of the bench in noise; and one turn under the cell."""
    random, found = np.random.default_rng(seed), {}
    time = np.arange(round(SECONDS * RATE) + 1) / RATE
    quiet = {"velocity": 1.0, "acceleration": 2 * np.pi * 150}
    for name in RUNS:
        root, shape = modes(whole, run(name))
        for again in ("", "_again"):
            tap = 0.01 * random.uniform(0.5, 1.5, len(root)) / abs(shape[:, 0])
            shown = []
            for k, channel in enumerate(motions(whole)):
                power = 1 if channel.measurand == ACCELERATION else 0
                clean = ((tap * shape[:, k] * root**power) @ np.exp(np.outer(root, time))).real
                shown.append(clean + NOISE * quiet[channel.measurand.name] * random.standard_normal(len(time)))
            own = Run(name + again, SECONDS, RATE, conditions=run(name).conditions)
            found[own.name] = Recorded(own, ("laser", "accelerometer"), ("m/s", "m/s^2"), np.array(shown),
                                       np.ones((2, len(time)), bool), name if again else "")
    found["turned"] = _turned(whole, random)
    return found


def _turned(whole, random):
    own = Run("turned", 13.0, 20.0, conditions={"press": 10.0, "speed": 0.5})
    amplitude = order_locked(whole, own, "arm", (1,))[0]
    force = 7.0 + (amplitude * np.exp(-0.5j * own.time)).real + 0.01 * random.standard_normal(own.samples)
    return Recorded(own, ("cell",), ("N",), force[None], np.ones((1, own.samples), bool), "")
