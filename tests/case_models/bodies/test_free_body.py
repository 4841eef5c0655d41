"""A freely hung part of the brake as a model of its values."""

import numpy as np
import pytest

from pipeline.case_models.bodies.free_body import FreeBody
from stages.model_update import Settings


@pytest.mark.parametrize(("body", "given", "values", "slope"), [
    ("caliper", {"radial_cells": 1, "angular_cells": 2, "housing_cells": 1, "bridge_cells": 1}, ("young",), 0.5),
    ("caliper", {"radial_cells": 1, "angular_cells": 2, "housing_cells": 1, "bridge_cells": 1}, ("density",), -0.5),
    ("pad", {"patches_angular": 2, "patches_radial": 1}, ("lining_density", "backplate_density"), -0.5)])
def test_other_bodies_follow_their_moduli_and_densities(body, given, values, slope):
    """f goes with the root of modulus over density, of all materials together."""
    settings = Settings(body=body, values={name: {"spread": 0.1} for name in values}, **{body: given})
    modes = FreeBody(settings, "superlu", 6e3)(np.zeros(len(values)))
    assert len(modes.frequency) > 2
    np.testing.assert_allclose(modes.slope.sum(axis=1) / 0.1, slope, rtol=1e-5)


def test_values_of_other_parts_are_left_for_their_own_tests():
    settings = Settings(body="disc", values={"young": {"spread": 0.1}, "joints.finger_stiffness": {"spread": 0.3}})
    assert FreeBody(settings, "superlu", 1e3).declared.names == ("disc.young",)
