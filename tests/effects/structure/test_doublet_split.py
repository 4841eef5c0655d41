"""Two equal modes that part."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import round_disc, struck

SPLIT = named("doublet_split")


@pytest.mark.exact
@pytest.mark.parametrize("along, across", [(0.05, 0.0), (0.0, -0.05), (0.03, 0.04)])
def test_frequencies_and_directions(along, across):
    """w sqrt(1 -+ s), s^2 = a^2 + b^2; the stiffer mode lies at half the angle of (a, b)."""
    bench = SPLIT.on(round_disc(), "disc", {"along": along, "across": across})
    size = np.hypot(along, across)
    np.testing.assert_allclose(roots(bench, struck()).imag[[1, 3]], 20 * np.sqrt([1 - size, 1 + size]), rtol=1e-9)
    stiffer = np.linalg.eigh(bench.model.supported()[2])[1][:, 1]
    assert np.tan(np.arctan2(across, along) / 2) == pytest.approx(stiffer[1] / stiffer[0])


@pytest.mark.exact
def test_a_blow_between_the_modes_beats():
    """Halves of both modes: x = v (sin w1 t / w1 + sin w2 t / w2) / 2."""
    bench = SPLIT.on(round_disc(), "disc", {"along": 0.0, "across": 0.05})
    run, (slow, fast) = struck(), 20 * np.sqrt([0.95, 1.05])
    exact = 0.1 * (np.sin(slow * run.time) / slow + np.sin(fast * run.time) / fast) / 2
    np.testing.assert_allclose(respond(bench, run)["x"], exact, atol=1e-9)


def test_a_bench_without_doublets_has_no_place():
    with pytest.raises(ConfigError, match="none here"):
        SPLIT.on(round_disc(doublets={}), "disc", {"along": 0.0, "across": 0.0})
    with pytest.raises(ConfigError, match="along"):
        SPLIT.on(round_disc(), "disc", {"along": 0.8, "across": 0.8})
