"""Nothing is decoration: what goes in at the micro scale comes out as another squeal."""

import pytest

from tests.chain.conftest import QUICK, brakechain, contents

CHANGES = {
    "scan": "surface.pad.seed=4711",
    "pad modulus": "structure.pad.lining_young_normal=1.4 GPa",
    "caliper stiffness": "structure.joints.guide_pin_stiffness=18 MN/m",
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_changed_input_changes_the_squeal(copy, finished, change):
    brakechain("run", QUICK, "--run", copy, "--set", change, "--until", "squeal")
    assert contents(copy)["squeal"] != contents(finished)["squeal"]
