"""A pad that relaxes."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Run, respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import RATE, let_go, sprung, swung

PAD = named("viscoelastic_pad")


@pytest.mark.exact
@pytest.mark.parametrize("turn", [0.2, 1.0, 5.0])
def test_swings_as_the_complex_stiffness_says(turn):
    """k (1 + s i w tau / (1 + i w tau)) + i c w - m w^2, w tau = ``turn``; the first seconds ring down."""
    w, share = 15.0, 0.5
    bench = PAD.on(sprung(damping=4.0), "joint_0", {"share": share, "time": turn / w})
    gain = 1 / (400 * (1 + share * 1j * turn / (1 + 1j * turn)) + 4j * w - w**2)
    run, late, x = swung(bench, w)
    np.testing.assert_allclose(x[late], np.real(gain * np.exp(1j * w * run.time[late])), atol=1e-5 * abs(gain))


@pytest.mark.exact
def test_the_roots_are_those_of_a_cubic():
    """(m z^2 + c z + k) (1 + z tau) + s k z tau = 0."""
    share, time = 0.7, 0.03
    bench = PAD.on(sprung(), "joint_0", {"share": share, "time": time})
    exact = np.roots(np.polyadd(np.polymul([1.0, 0.4, 400.0], [time, 1.0]), [share * 400 * time, 0.0]))
    np.testing.assert_allclose(roots(bench, let_go(0.01)), sorted(exact, key=lambda z: (abs(z.imag), z.imag)),
                               rtol=1e-9)
    assert exact.real.max() < -0.2       # the pad takes energy: faster than the joint alone rings down


def test_its_own_motion_leaves_nothing_and_that_of_the_pad_is_missed_without_it():
    base, run = sprung(), let_go(0.01)
    bench = PAD.on(base, "joint_0", {"share": 0.7, "time": 0.03})
    left, missed = (abs(equation_residual(b, run, respond(bench, run))).max() for b in (bench, base))
    assert left < 0.01 * missed


def test_a_pad_that_gives_energy_is_refused():
    with pytest.raises(ConfigError, match="share"):
        PAD.on(sprung(), "joint_0", {"share": -0.1, "time": 0.03})


@pytest.mark.exact
def test_a_steady_load_leaves_it_relaxed():
    bench = PAD.on(sprung(), "joint_0", {"share": 0.7, "time": 0.03})
    x = respond(bench, Run("held", 3.0, RATE, {"input_0": 4.0}))["x"]
    assert x[-1] == pytest.approx(4.0 / 400, rel=1e-3)
