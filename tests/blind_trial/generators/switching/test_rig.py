"""Rigs: the drawn frequency is met, layouts have the stiffness of their springs, beliefs are off as stated."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching.rig import LAYOUTS, Rig, believed, drawn


@pytest.mark.exact
def test_two_equal_bodies_in_a_row_have_the_frequencies_of_the_golden_ratio():
    rig = Rig((1.0, 1.0), LAYOUTS["row"], (100.0, 100.0), (0.0, 0.0))
    golden = (1 + np.sqrt(5)) / 2
    np.testing.assert_allclose(2 * np.pi * rig.frequencies, 10 * np.array([1 / golden, golden]), rtol=1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_drawn_rig_has_its_first_frequency_in_range_and_values_by_name(layout):
    rig = drawn(np.random.default_rng(1), layout)
    assert 8 <= rig.frequencies[0] <= 60 and len(rig.names) == len(rig.mass) + 2 * len(rig.ends)
    changed = rig.with_values({"stiffness.0": 7.0})
    assert changed.value("stiffness.0") == 7.0 and replace(changed, stiffness=rig.stiffness) == rig


def test_beliefs_are_10_to_30_percent_off_but_those_that_are_known():
    rig = drawn(np.random.default_rng(2), "bridge")
    belief = believed(np.random.default_rng(3), rig, ("mass.0",), "stiffness.1")
    off = {name: abs(np.log(belief.value(name) / rig.value(name))) for name in rig.names}
    assert off["mass.0"] == 0 and np.log(1.6) <= off["stiffness.1"] <= np.log(2.2)
    rest = [o for name, o in off.items() if name not in ("mass.0", "stiffness.1")]
    assert min(rest) >= np.log(1.1) - 1e-12 and max(rest) <= np.log(1.3) + 1e-12
