"""The surface under a group of contacts."""

import numpy as np
import pytest

from pipeline.effects.contact.contact_surface import sliding_angle, with_wave, with_wear
from tests.effects.benches import at_angles, rubbing


@pytest.mark.exact
@pytest.mark.parametrize("middle", [0.0, 1.0, np.pi, -2.0])
def test_angles_count_from_the_middle_of_the_group_wherever_it_is(middle):
    contacts = at_angles(rubbing().model, middle - 0.2, middle + 0.2).contacts
    np.testing.assert_allclose(sliding_angle(contacts, np.arange(2)), [-0.2, 0.2], atol=1e-12)
    assert sliding_angle(contacts, np.array([1])) == pytest.approx(0.0)


@pytest.mark.exact
def test_waves_and_wear_add_up():
    both = with_wave(with_wave(rubbing(), "contact", 1e-4, 2.0, 0.1), "right", 3e-4, 1.0, 0.0, 0.5)
    assert [(w.contact, w.amplitude, w.growth) for w in both.model.contacts.waviness] == [
        (0, 1e-4, 0.0), (1, 1e-4, 0.0), (1, 3e-4, 0.5)]
    worn = with_wear(with_wear(rubbing(), "contact", 2e-9), "left", 1e-9).model.contacts
    np.testing.assert_allclose(worn.wear * worn.area, [3e-9, 2e-9])
