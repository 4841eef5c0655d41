"""Balls that fall through air of a law that no model has: drag by a power of the speed, integrated by SciPy."""

from math import copysign

import numpy as np
from scipy.integrate import solve_ivp

from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import HalfNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

RATE, SAMPLES, STD = 15.0, 54, 0.05
#: m/s downwards, with which each run begins; the last is held out
BEGINS = (0.0, 4.0, 9.0, 2.0)
NOMINAL = Hypothesis("nominal", (), (Parameter("gravity", "m/s^2", 9.81, Normal(9.81, 0.1)),))
TIME = np.arange(SAMPLES) / RATE


def _law(name, unit, typical):
    return Hypothesis(name, ((name, "ball"),), (
        Parameter(name, unit, typical, HalfNormal(typical), 0.0),))


CATALOGUE = (_law("viscous", "1/s", 1.0), _law("quadratic", "1/m", 0.1), _law("constant", "m/s^2", 3.0))


def acceleration(values, speed):
    """Downwards, of speeds (m/s) downwards."""
    return (values["gravity"] - values.get("viscous", 0.0) * speed - values.get("quadratic", 0.0) * speed * abs(speed)
            - (copysign(values.get("constant", 0.0), speed) if speed else 0.0))


def predict(hypothesis, values, run):
    """Way of the ball (1, n) by Runge-Kutta's method of order 4."""
    way, speed, step = np.zeros(SAMPLES), BEGINS[int(run.name)], 1 / RATE
    values = {name: float(value) for name, value in values.items()}     # much faster than scalars of NumPy
    for i in range(1, SAMPLES):
        begin = speed
        slopes = [acceleration(values, begin)]
        for part in (0.5, 0.5, 1.0):
            slopes.append(acceleration(values, begin + part * step * slopes[-1]))
        speed = begin + step / 6 * (slopes[0] + 2 * slopes[1] + 2 * slopes[2] + slopes[3])
        way[i] = way[i - 1] + step * (begin + step / 6 * sum(slopes[:3]))
    return way[None, :run.samples.shape[1]]


def bench(drag, seed=1):
    """(Problem, {run: Noise}) of balls that ``drag(speed)`` (m/s^2) holds back."""
    noise, runs = np.random.default_rng(seed), []
    for k, begin in enumerate(BEGINS):
        fall = solve_ivp(lambda t, y: [y[1], 9.81 - drag(y[1])], (0, TIME[-1]), [0.0, begin], t_eval=TIME, rtol=1e-10,
                         atol=1e-10)
        runs.append(Observed(f"{k}", {"begin": begin}, ("way",), fall.y[:1] + STD * noise.standard_normal(SAMPLES),
                             RATE, noise_std=np.array([STD]), held_out=k == len(BEGINS) - 1))
    whole = Problem(tuple(runs), predict, NOMINAL)
    return whole, budget(whole)
