"""Steps of a least-squares fit: along a bent valley."""

import numpy as np
import pytest
from scipy import optimize as optimise

from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.priors import Normal, Parameter
from tests.inference.curves import curve_problem


@pytest.mark.parametrize("steep, slope", [(10.0, 0.1), (10.0, 0.01), (100.0, 1.0), (100.0, 0.1)])
def test_a_long_bent_valley_is_followed_to_its_end(steep, slope):
    """Rosenbrock's valley: a straight step leaves y = x^2 at once, and a damped one hardly moves along it."""
    std, prior = 0.01, Normal(0.0, 1.0)

    def bent(values, grid):
        return np.where(grid < 0.5, steep * (values["y"] - values["x"] ** 2), slope * (1 - values["x"]))

    def objective(u):
        return 25 * ((steep * (u[1] - u[0]**2) / std)**2 + (slope * (1 - u[0]) / std)**2) + u @ u

    whole, noises = curve_problem(bent, (Parameter("x", "1", 0.0, prior), Parameter("y", "1", 0.0, prior)),
                                  np.zeros_like, std)
    found = fit(whole, noises, whole.nominal, np.array([-1.0, 1.0]), whole.training)
    best = optimise.minimize(objective, [1.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-9})
    assert found.converged and found.objective == pytest.approx(best.fun, abs=0.02)
