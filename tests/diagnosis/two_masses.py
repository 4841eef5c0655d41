"""Two masses in a row on springs, both seen, shaken at one end: places that two channels tell apart."""

import numpy as np

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.signals.forward_model import Simulated, observed
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.inference.problem import Hypothesis, Problem
from pipeline.physics.virtual_rig.response import Run, respond
from pipeline.products import Channel, Recording
from pipeline.products import Run as RunProduct
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis.small_rig import effects

RATE, SAMPLES, NOISE = 400.0, 2400, 1e-4
SYSTEM = {"masses": {"left": {"mass": "1 kg", "moves": ["x"]}, "right": {"mass": "0.6 kg", "moves": ["x"]}},
          "springs": {"mount": {"between": ["left.x", "ground"], "stiffness": "900 N/m", "damping": "2 N s/m"},
                      "coupling": {"between": ["right.x", "left.x"], "stiffness": "500 N/m",
                                   "damping": "1 N s/m"}},
          "inputs": {"shaker": {"along": {"right.x": 1}, "force": "1 N"}},
          "sensors": {name: {"along": {f"{name}.x": 1}, "quantity": "displacement", "unit": "m"}
                      for name in ("left", "right")}}
LAID = fill(benches.Settings, {
    "step": "2.5 ms", "inputs": {"shaker": {"channel": "force"}},
    "channels": {name: {"quantity": "displacement", "source": name} for name in ("left", "right")}}, "bench")
ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}},
         "noise": {"std": dict.fromkeys(("left", "right"), f"{NOISE} m")}, "effects": ["cubic_stiffness"],
         "solver": False}


def built():
    """The Bench without anything hidden."""
    return benches.built(reduced_model(lumped(settings=fill(LumpedSettings, SYSTEM, "lumped")),
                                       settings=ReductionSettings()), LAID)


def recording(hidden, noise=NOISE, levels=(1.0, 2.0)):
    """Product Recording of the masses with the block ``hidden`` of effects, shaken by band-limited noise."""
    whole, random, runs = with_effects(built(), effects(hidden)), np.random.default_rng(5), {}
    for level in levels:
        force = level * np.convolve(random.standard_normal(SAMPLES), np.hanning(36) / 4, "same")
        shown = respond(whole, Run("run", (SAMPLES - 1) / RATE, RATE, {"shaker": force}))
        channels = {"force": _channel(force, "N")} | {
            name: _channel(values + noise * random.standard_normal(SAMPLES), "m") for name, values in shown.items()}
        runs[f"level_{level:g}"] = RunProduct(description="", repeat_of="", channels=channels)
    return Recording(source=["made for a test"], runs=runs)


def fitted(hidden):
    """(Bench, {name: Run}, Fit) of the nominal model at its true values; mount and coupling may be off by 10 %."""
    bench, found = built(), recorded(recording(hidden), LAID)
    parameters = tuple(Parameter(f"joints.{name}.stiffness", "N/m", value, LogNormal(value, 0.1))
                       for name, value in (("mount", 900.0), ("coupling", 500.0)))
    runs = {name: one.run for name, one in found.items()}
    problem = Problem(tuple(observed(one, dict.fromkeys(("left", "right"), NOISE)) for one in found.values()),
                      Simulated(bench, runs), Hypothesis("nominal", (), parameters))
    noise = budget(problem)
    return bench, runs, linearised(problem, [noise[r.name] for r in problem.runs], problem.nominal,
                                   problem.nominal.nominal, problem.runs)


def _channel(samples, unit):
    return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures="", rate=RATE, begin=0.0,
                   place="", position=[], direction=[], role="")
