"""A pin on a force arm over a table that goes to and fro: a tribometer whose hidden physics is known."""

import numpy as np

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.contract.settings import fill
from pipeline.physics.virtual_rig.response import Run, respond
from pipeline.products import Channel, Condition, Recording
from pipeline.products import Run as RunProduct
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis.small_rig import effects

RATE, SAMPLES, NOISE = 25.0, 100, 0.05
#: so slow that inertia and damping of the pin do not tell what gives way
FREQUENCY = 0.25
LUMPED = {"masses": {"pin": {"mass": "0.3 kg", "moves": ["x"]}},
          "springs": {"arm": {"between": ["pin.x", "ground"], "stiffness": "100 N/mm", "damping": "20 N s/m"}},
          "contacts": {"tip": {"tangent": {"pin.x": 1}, "normal_force": "5 N"}}}
BENCH = {"step": "1.6 ms", "settled": True, "friction": 0.45, "description": "elastic",
         "tangential_stiffness": "50 N/mm", "drive": {"channel": "position", "derivative": True},
         "channels": {"friction": {"quantity": "joint_force", "source": "arm"}}}
MICRO_SLIP = {"micro_slip": {"contact": {"compliance": "15 um/N"}}}


def laid_out():
    """The section ``bench`` of the rig."""
    return fill(benches.Settings, BENCH, "bench")


def bench():
    """The nominal Bench of the rig."""
    model = reduced_model(lumped(settings=fill(LumpedSettings, LUMPED, "lumped")), settings=ReductionSettings())
    return benches.built(model, laid_out())


def position(stroke):
    """Samples (m) of a table that swings, from the middle of a stroke of this length (m) on."""
    return 0.5 * stroke * np.sin(2 * np.pi * FREQUENCY * np.arange(SAMPLES) / RATE)


def recording(loads, strokes, hidden=None, noise=NOISE, seed=1):
    """Product Recording: runs ``run_1`` ... of the rig under ``loads`` N with the block ``hidden`` of effects."""
    whole, random, runs = with_effects(bench(), effects(hidden or {})), np.random.default_rng(seed), {}
    for k, (load, stroke) in enumerate(zip(loads, strokes, strict=True)):
        moved = position(stroke)
        run = Run(f"run_{k + 1}", (SAMPLES - 1) / RATE, RATE, drive=np.gradient(moved, 1 / RATE),
                  conditions={"normal_load": load})
        shown = respond(whole, run)["friction"] + noise * random.standard_normal(SAMPLES)
        runs[run.name] = RunProduct(
            description="", repeat_of="", conditions={"normal_load": Condition(value=[load], time=[0.0], unit="N")},
            channels={"friction": _channel(shown, "N", "force"), "position": _channel(moved, "m", "displacement")})
    return Recording(source=["made for a test"], runs=runs)


def _channel(samples, unit, measures):
    return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures=measures, rate=RATE, begin=0.0,
                   place="", position=[], direction=[], role="response")
