"""A damping shim at a joint."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import let_go, sprung, swung

SHIM, LOSS, BAND = named("shim_damping"), 0.2, 3.0


def shimmed(damping=4.0):
    return SHIM.on(sprung(damping=damping), "joint_0", {"loss_factor": LOSS, "frequency": BAND})


def complex_stiffness(frequency):
    """Of joint and shim, from the branches of the element."""
    law = shimmed().model.elements[0].law
    turn = 2j * np.pi * frequency * law.time
    return 400.0 + law.linear + np.sum(law.stiffness * turn / (1 + turn))


@pytest.mark.exact
def test_at_its_frequency_the_joint_is_structurally_damped():
    assert complex_stiffness(BAND) == pytest.approx(400 * (1 + 1j * LOSS), rel=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("ratio, less", [(10**0.5, 0.05), (10.0, 0.27)])
def test_the_loss_stays_alike_within_the_band(ratio, less):
    for frequency in (BAND / ratio, BAND * ratio):
        assert complex_stiffness(frequency).imag == pytest.approx((1 - less) * 400 * LOSS, rel=0.005)


@pytest.mark.exact
def test_swings_as_the_complex_stiffness_says():
    w = 2 * np.pi * BAND
    gain = 1 / (400 * (1 + 1j * LOSS) + 4j * w - w**2)
    run, late, x = swung(shimmed(), w)
    np.testing.assert_allclose(x[late], np.real(gain * np.exp(1j * w * run.time[late])), atol=1e-5 * abs(gain))


@pytest.mark.exact
def test_ringing_decays_by_the_loss_factor():
    """m z^2 + K(z) = 0 to first order in the loss: growth rate -h w / 2 at w = sqrt(k / m) = 2 pi f."""
    found = roots(SHIM.on(sprung(damping=0.0), "joint_0", {"loss_factor": 0.01, "frequency": 20 / (2 * np.pi)}),
                  let_go(0.01))
    assert found[-1] == pytest.approx(-0.01 * 20 / 2 + 20j, rel=1e-4)


def test_the_joint_still_holds_at_rest_where_the_loss_is_largest():
    law = SHIM.on(sprung(), "joint_0", {"loss_factor": 0.5, "frequency": BAND}).model.elements[0].law
    assert 400.0 + law.linear > 0
