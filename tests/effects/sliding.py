"""A free mass that is pushed until it slides steadily, or slowly pulled against its joint."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.effects import named
from pipeline.physics.friction.joint_friction import REFERENCE_SPEED
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.response import Run, respond
from tests.effects.benches import RATE, sprung

#: values of both laws of rate-and-state friction
RATE_STATE = {"force": 1.0, "direct": 0.03, "evolution": 0.02, "length": 5e-3}


def steady_force(speed):
    """Force in N that keeps a mass with a drag of 3 N s/m and RATE_STATE friction at a ``speed``, its contact settled.
    """
    return 3.0 * speed + 1 + 0.01 * np.log(speed / REFERENCE_SPEED)


def steady_speed(effect, values, force, near, drag=3.0):
    """Speed in m/s at which a mass of 1 kg with a drag (N s/m) ends under a ``force``, begun at ``near`` m/s."""
    bench = named(effect).on(sprung(stiffness=0.0, damping=drag), "joint_0", values)
    run = Run("pushed", 6.0, RATE, {"input_0": force}, start=Start(np.zeros(1), np.array([near])))
    return respond(bench, run)["v"][-1]


def pulled(effect, values, top=3.0, duration=20.0):
    """(elongation, force of the spring and the effect) of a joint of 400 N/m that is slowly pulled up to ``top`` N."""
    bench = named(effect).on(sprung(damping=40.0), "joint_0", values)
    run = Run("pull", duration, RATE)
    pull = top * run.time / duration
    e = respond(bench, replace(run, inputs={"input_0": pull}))["x"]
    return e, pull - 40 * np.gradient(e, run.time)


def sliding_error(effect, values, law, states, step, push=2.0):
    """Largest error over largest speed of a mass that never comes to rest, against SciPy; ``law(x, v, z)`` -> (F, z').
    """
    run = Run("driven", 1.5, 250.0, start=Start(np.zeros(1), np.array([0.1])))
    push = push + np.sin(9 * run.time)

    def slope(t, state):
        force, change = law(state[0], state[1], state[2:])
        return [state[1], np.interp(t, run.time, push) - 3.0 * state[1] - force, *change]

    whole = solve_ivp(slope, (0, 1.5), [0.0, 0.1, *states], t_eval=run.time, rtol=1e-10, atol=1e-13, max_step=2e-3)
    bench = named(effect).on(sprung(stiffness=0.0, damping=3.0, step=step), "joint_0", values)
    shown = respond(bench, replace(run, inputs={"input_0": push}))["v"]
    return abs(shown - whole.y[1]).max() / abs(whole.y[1]).max()
