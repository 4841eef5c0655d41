"""What a diagnosis says at other levels of noise."""

from math import sin, tanh
from types import SimpleNamespace

import pytest

from pipeline.inference.diagnosis import Settings, over_noise, reaches_noise
from pipeline.inference.fitting.noise import budget
from pipeline.inference.procedure import Asked
from pipeline.inference.rules import DEFAULTS
from tests.inference.oscillator import CATALOGUE, bench


def test_a_verdict_that_hangs_on_the_level_of_noise_says_so():
    """Friction beside a spring that pulsates is named only where noise would hide the rest."""
    problem = bench(5, 0.02, stiffness=430.0,
                    extra=lambda t, x, v: 0.6 * tanh(v / 0.005) + 8.0 * sin(9.0 * t) * x)
    settings = Settings()
    told = Asked(problem, budget(problem), CATALOGUE, settings, map).told()
    same, louder = over_noise(told, settings, (1.0, 4.0))
    assert (same.verdict, same.named) == (told.decision.verdict, tuple(c.name for c in told.decision.named))
    assert (told.decision.verdict, told.decision.leading.name) == ("unknown", "coulomb")
    assert (louder.verdict, louder.named) == ("missing", ("coulomb",))


@pytest.mark.parametrize("left, reaches", [(None, True), (0.05, True), (0.5, False)])
def test_runs_that_were_not_fitted_have_a_say_where_they_can_tell(left, reaches):
    weighed = SimpleNamespace(statistics=SimpleNamespace(unexplained=0.0, held_out_left=left),
                              fit=SimpleNamespace(reaches_noise=lambda uncertainty: True))
    told = SimpleNamespace(decision=SimpleNamespace(verdict="unknown"), weighed=[weighed])
    assert reaches_noise(told, DEFAULTS) == reaches
