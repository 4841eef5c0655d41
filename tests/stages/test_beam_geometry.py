"""Stage beam_geometry: a tiny search goes through all its parts and repeats itself."""

import numpy as np
import pytest

from pipeline.systems.beam_geometry import GEOMETRY, LOWER, UPPER
from stages.beam_geometry import Settings, beam_geometry

TINY = {"tilts": ["-5 deg"], "rigid_generations": 1, "generations": 1, "population": 1, "joint_population": 5,
        "joint_generations": 1, "sweeps": 2, "motion_seeds": [1], "duration": "60 ms", "damping_factors": [0.0, 1.0],
        "highest_frequency": "30 kHz",
        "start": [106.6383, 6.9718, -0.3607, 406.766, 25.0489, -0.0277, 3.6919, 7.8838,
                  4.5862, 7.7593, 1.8907, 5.9626, -18.5381]}


@pytest.fixture(scope="module")
def found():
    return beam_geometry(settings=Settings(**TINY))


def test_known_start_is_never_lost(found):
    assert found.linear_cost < 1.0 and len(found.onset_frequency) >= 3
    assert np.all(found.best >= LOWER) and np.all(found.best <= UPPER)
    assert found.cost <= found.linear_cost + 60.0 * len(found.quantity_name)


def test_every_part_is_told(found):
    assert found.samples.shape == (28, GEOMETRY) and found.rigid_best.shape == (1, 6)
    assert found.motion.shape == (1, len(found.quantity_name))
    assert found.evaluations > 8


def test_same_seeds_same_bits(found):
    again = beam_geometry(settings=Settings(**TINY))
    np.testing.assert_array_equal(again.samples, found.samples)
    np.testing.assert_array_equal(again.motion, found.motion)


@pytest.mark.exact
def test_damping_per_mass_lowers_growth_by_half_of_it(found):
    """Rayleigh damping per mass a moves every slow root by -a / 2."""
    change = (found.damping[1] - found.damping[0]) / 2
    for growth in (found.low_growth, found.middle_growth):
        assert growth[0] - growth[1] == pytest.approx(change, rel=0.1)
