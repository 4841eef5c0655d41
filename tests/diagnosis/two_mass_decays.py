"""Free decays of two masses in a row, integrated by SciPy from the equations alone, whose starts nobody states."""

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.start_states import started
from pipeline.products import Channel, Recording
from pipeline.products import Run as RunProduct
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis.two_masses import SYSTEM


def decays(stiffness, damping, friction, starts, rate, samples, noise=0.01, seed=1):
    """(Recording of {run: (x1, x2, v1, v2) at its begin}, standard deviation of the noise); 1 and 0.6 kg."""
    def slope(_, s):
        joint = np.array([stiffness[0] * s[0] + damping[0] * s[2] + friction * np.tanh(s[2] / 1e-3),
                          stiffness[1] * (s[1] - s[0]) + damping[1] * (s[3] - s[2])])
        return [s[2], s[3], joint[1] - joint[0], -joint[1] / 0.6]

    time, random, runs = np.arange(samples) / rate, np.random.default_rng(seed), {}
    motions = {name: solve_ivp(slope, (0, time[-1]), start, t_eval=time, rtol=1e-8, atol=1e-11).y[:2]
               for name, start in starts.items()}
    std = float(noise * max(abs(m).max() for m in motions.values()))
    for name, motion in motions.items():
        runs[name] = RunProduct(description="", repeat_of="", channels={
            key: Channel(samples=x + std * random.standard_normal(samples), missing=np.empty((0, 2), int), unit="m",
                         measures="displacement", rate=rate, begin=0.0, place="", position=[], direction=[],
                         role="response") for key, x in zip(("left", "right"), motion, strict=True)})
    return Recording(source=["made for a test"], runs=runs), std


def problem(given, std, effects=("coulomb",), channels=("left", "right"), spread=0.2, held_out=()):
    """DiagnosisProblem of such decays about the nominal 900 and 500 N/m, 2 and 1 N s/m."""
    laid = fill(benches.Settings, {"step": "2.5 ms", "channels": {
        name: {"quantity": "displacement", "source": name} for name in channels}}, "bench")
    system = {key: part for key, part in SYSTEM.items() if key != "inputs"}
    bench = benches.built(reduced_model(lumped(settings=fill(LumpedSettings, system, "lumped")),
                                        settings=ReductionSettings()), laid)
    asked = {"parameters": {f"joints.{name}.{what}": {"spread": size} for name in ("mount", "coupling")
                            for what, size in (("stiffness", spread), ("damping", 0.5))},
             "noise": {"std": dict.fromkeys(channels, f"{std!r} m")}, "effects": list(effects), "solver": False,
             "held_out": list(held_out)}
    return forced_problem(bench, started(bench, recorded(given, laid), laid), fill(Settings, asked, "diagnosis"))
