"""Static forces of unilateral contacts against statics by hand."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.static_forces import static_forces

NONE = np.zeros(1)


@pytest.mark.exact
@pytest.mark.parametrize(("gap", "compliance"), [(0.0, 0.0), (1e-3, 0.0), (1e-3, 1e-5), (-2e-3, 1e-5)])
def test_spring_and_contact_share_a_load(gap, compliance):
    """k q = N - F and q + gap + N / kc = 0: N = (F - k gap) / (1 + k / kc)."""
    force = static_forces(np.array([[2e4]]), np.array([-50.0]), np.ones((1, 1)), np.array([gap]),
                          np.array([compliance]))
    assert force[0] == pytest.approx((50.0 - 2e4 * gap) / (1 + 2e4 * compliance), rel=1e-12)


@pytest.mark.exact
def test_contacts_beyond_the_load_open():
    """The load bends the spring by 2.5 mm: 3 mm away nothing touches; a load that pulls opens the contact."""
    for load, gap in ((-50.0, 3e-3), (50.0, 0.0)):
        assert static_forces(np.array([[2e4]]), np.array([load]), np.ones((1, 1)), np.array([gap]), NONE)[0] == 0


@pytest.mark.exact
def test_a_free_beam_on_two_hard_contacts_is_a_lever():
    """Lift and rotation without springs, contacts at -0.1 and 0.3 m, 40 N in the middle; sliding is free."""
    normal = np.array([[0.0, 1.0, -0.1], [0.0, 1.0, 0.3]])
    force = static_forces(np.zeros((3, 3)), np.array([0.0, -40.0, 0.0]), normal, np.zeros(2), np.zeros(2))
    np.testing.assert_allclose(force, [30.0, 10.0], rtol=1e-12)


@pytest.mark.parametrize(("load", "gap", "said"), [
    ([7.0, -1.0], [0.0, 0.0], "7 N that nothing holds"), ([0.0, -1.0], [0.0, 1e-3], "close together")])
def test_what_has_no_equilibrium_is_refused(load, gap, said):
    with pytest.raises(ConfigError, match=said):
        static_forces(np.zeros((2, 2)), np.array(load), np.array([[0.0, 1.0]] * 2), np.array(gap), np.zeros(2))
