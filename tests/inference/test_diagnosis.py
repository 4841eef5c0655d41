"""What a diagnosis says at other levels of noise."""

from math import sin, tanh

from pipeline.inference.diagnosis import Settings, over_noise
from pipeline.inference.fitting.noise import budget
from pipeline.inference.procedure import Asked
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
