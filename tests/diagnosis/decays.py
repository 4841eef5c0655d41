"""Free decays of a mass on a spring, integrated by SciPy from the equations alone, as a bench records them.

The engine that is tested takes no part: true laws, unknown starts, displacement, velocity or acceleration alone, about
20 samples a period and noise of 1 % of the largest sample.
"""

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
from tests.diagnosis.small_rig import laid_out, model

MASS, STIFFNESS, DAMPING = 1.0, 412.0, 1.1          # the nominal rig: 1 kg, 400 N/m, 1.2 N s/m
RATE = 64.0
UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2"}


def decay(law, start, duration, memory=(), rate=RATE):
    """(displacement, velocity, acceleration) (n,) from ``start`` (x, v) under ``law(x, v, z)`` -> (force, dz/dt)."""
    def slope(_, state):
        force, change = law(state[0], state[1], state[2:])
        return [state[1], -(STIFFNESS * state[0] + DAMPING * state[1] + force) / MASS, *change]

    time = np.arange(round(duration * rate) + 1) / rate
    whole = solve_ivp(slope, (0, time[-1]), [*start, *memory], t_eval=time, rtol=1e-9, atol=1e-12,
                      max_step=1 / (8 * rate))
    return whole.y[0], whole.y[1], np.array([slope(0, state)[1] for state in whole.y.T])


def linear(x, v, z):
    return 0.0, ()


def duffing(x, v, z):
    return 15000.0 * x**3, ()


def jenkins(stiffness, limit):
    """Jenkins elements in parallel of ``stiffness`` (s,) N/m, each held up to ``limit`` (s,) N; z: their forces."""
    def law(x, v, z):
        slides = ((z >= limit) & (v > 0)) | ((z <= -limit) & (v < 0))
        return float(np.minimum(np.maximum(z, -limit), limit).sum()), np.where(slides, 0.0, stiffness * v)

    return law


def recording(motions, quantity="displacement", noise=0.01, seed=1, rate=RATE):
    """Product Recording of {run: (displacement, velocity, acceleration)}, and the noise (SI) of its channel x."""
    kind = list(UNITS).index(quantity)
    std = float(noise * max(abs(m[kind]).max() for m in motions.values()))
    random, runs = np.random.default_rng(seed), {}
    for name, motion in motions.items():
        samples = motion[kind] + std * random.standard_normal(len(motion[kind]))
        channel = Channel(samples=samples, missing=np.empty((0, 2), int), unit=UNITS[quantity], measures=quantity,
                          rate=rate, begin=0.0, place="", position=[], direction=[], role="response")
        runs[name] = RunProduct(description="", repeat_of="", channels={"x": channel})
    return Recording(source=["made for a test"], runs=runs), std


def problem(motions, quantity="displacement", held_out=("last",), noise=0.01, seed=1, rate=RATE, weighed=(), **bench):
    """DiagnosisProblem of free decays whose starts nobody states."""
    given, std = recording(motions, quantity, noise, seed, rate)
    section = laid_out(channels={"x": {"quantity": quantity, "source": "block"}}, inputs={}, **bench)
    whole = benches.built(model(), section)
    asked = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
             "held_out": list(held_out), "noise": {"std": {"x": f"{std!r} {UNITS[quantity]}"}},
             "effects": list(weighed)}
    return forced_problem(whole, started(whole, recorded(given, section), section), fill(Settings, asked, "diagnosis"))
