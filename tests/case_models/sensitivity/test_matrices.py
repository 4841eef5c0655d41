"""Matrices of a case about its sliding state."""

import numpy as np

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.matrices import Case, mean_friction, system_of
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure


def test_roots_of_complex_modes_are_those_of_the_matrices():
    """Of a case as it stands: s^2 M + s C + K is singular at its unstable roots."""
    model, law = reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz")), small_friction_map(0.6)
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("12 rad/s",), frequency_max="8 kHz",
                                                     followed=0))
    points, root = StabilitySettings.of(modes), modes.unstable_reduced[0]
    case = Case(model, int(modes.unstable_operating[0]), 12.0)
    mass, damping, stiffness = system_of(case, law, points).matrices()
    size = np.linalg.svd(root**2 * mass + root * damping + stiffness, compute_uv=False)
    assert size[-1] < 1e-6 * size[-2]
    assert abs(mean_friction(case, law, points) - 0.6) < 1e-6
