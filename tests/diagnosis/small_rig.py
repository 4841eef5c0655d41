"""A mass on a spring, shaken at three levels: recordings of it with a hidden effect, in the form of the products."""

import numpy as np

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, with_effects
from pipeline.contract.settings import fill
from pipeline.physics.virtual_rig.response import Run, respond
from pipeline.products import Channel, Condition, Recording
from pipeline.products import Run as RunProduct
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model

RATE, SAMPLES = 200.0, 1200
LUMPED = {"masses": {"block": {"mass": "1 kg", "moves": ["x"]}},
          "springs": {"mount": {"between": ["block.x", "ground"], "stiffness": "400 N/m", "damping": "1.2 N s/m"}},
          "inputs": {"shaker": {"along": {"block.x": 1}, "force": "1 N"}},
          "sensors": {"block": {"along": {"block.x": 1}, "quantity": "displacement", "unit": "m"}}}
BENCH = {"step": "2.5 ms", "channels": {"x": {"quantity": "displacement", "source": "block"}},
         "inputs": {"shaker": {"channel": "force"}}}
HIDDEN = {"cubic_stiffness": {"mount": {"coefficient": "15000 N/m^3"}}}
NOISE = 2e-4
#: time step of the recordings
FINE = "0.3125 ms"


def model():
    """Product ReducedModel of the rig."""
    return reduced_model(lumped(settings=fill(LumpedSettings, LUMPED, "lumped")), settings=ReductionSettings())


def laid_out(**more):
    """The section ``bench`` of the rig."""
    return fill(benches.Settings, {**BENCH, **more}, "bench")


def effects(given):
    """Product Effects of a block."""
    return product(fill(EffectSettings, given, "effects"))


def force(level, seed):
    """Three tones and a sweep (N) at the samples."""
    time = np.arange(SAMPLES) / RATE
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, 3)
    tones = sum(np.sin(2 * np.pi * f * time + p) for f, p in zip((1.1, 2.9, 3.7), phases, strict=True))
    return level * (tones + np.sin(2 * np.pi * (1 + 0.25 * time) * time))


def recording(hidden=None, levels=(2.0, 5.0, 9.0, 7.0), noise=NOISE, seed=1, corrections=None):
    """Product Recording: runs ``level_1`` ... of the rig with the block ``hidden`` of effects, in FINE steps."""
    finely = laid_out(corrections=corrections or {}, step=FINE)
    whole = with_effects(benches.built(model(), finely), effects(hidden or {}))
    random, runs = np.random.default_rng(seed), {}
    for k, level in enumerate(levels):
        shaken = force(level, k)
        run = Run(f"level_{k + 1}", (SAMPLES - 1) / RATE, RATE, {"shaker": shaken})
        shown = respond(whole, run)["x"] + noise * random.standard_normal(SAMPLES)
        runs[run.name] = RunProduct(
            description="", repeat_of="", conditions={"level": Condition(value=[level], time=[0.0], unit="N")},
            channels={"x": _channel(shown, "m", "response"), "force": _channel(shaken, "N", "excitation")})
    return Recording(source=["made for a test"], runs=runs)


def _channel(samples, unit, role):
    return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures="displacement", rate=RATE,
                   begin=0.0, place="", position=[], direction=[], role=role)
