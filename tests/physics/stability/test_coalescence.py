"""Friction over frequency: modes, coalescences and their closed form."""

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.physics.closed_form.two_mode_flutter import onset_friction
from pipeline.physics.stability.coalescence import ContactModes, coalescences, friction_over_frequency
from pipeline.physics.stability.constrained_modes import hard_sliding
from tests.physics.stability.test_constrained_modes import SPRINGS, plane, roots


def contact_modes(model):
    squared, shape = eigh(model.stiffness, model.mass)
    return ContactModes(squared, (model.contacts.normal @ shape)[0], (model.contacts.tangent @ shape)[0])


FREQUENCY = np.linspace(1.0, 2.5, 3001)


@pytest.mark.exact
@pytest.mark.parametrize("friction", [0.5, 2.0, 4.0])
def test_curve_passes_through_the_modes(friction):
    """Every mode of the constrained system lies on the curve at its friction."""
    found = roots(hard_sliding(plane(), friction))
    real = np.unique(found.imag[(found.imag > 0) & (abs(found.real) < 1e-9)].round(9)) / (2 * np.pi)
    curve = friction_over_frequency(contact_modes(plane()), real, 1.0)[1]
    np.testing.assert_allclose(curve, friction, rtol=1e-5)


@pytest.mark.exact
def test_coalescence_of_two_modes():
    """Unit masses and K of ``SPRINGS``: both squared frequencies meet at their mean."""
    found = coalescences(contact_modes(plane()), FREQUENCY, 1.0, most=10.0)
    (k11, k12, _), (_, k22, kzy) = SPRINGS[0], SPRINGS[1]
    assert found.onset_friction == pytest.approx([onset_friction(k11, k22, k12, kzy)], abs=1e-6)
    assert found.onset_frequency == pytest.approx([np.sqrt((k11 + k22) / 2) / (2 * np.pi)], rel=1e-5)
    still = np.sqrt(np.linalg.eigvalsh(SPRINGS[:2, :2])) / (2 * np.pi)
    np.testing.assert_allclose(found.frictionless, still, atol=np.diff(FREQUENCY)[0] / 5)
    assert not len(found.end_frequency)


def test_sliding_the_other_way_does_not_flutter():
    found = coalescences(contact_modes(plane()), FREQUENCY, -1.0, most=10.0)
    assert not len(found.onset_frequency)


def test_friction_beyond_the_limit_is_not_told():
    assert not len(coalescences(contact_modes(plane()), FREQUENCY, 1.0, most=0.1).onset_frequency)
