"""Nothing is decoration: what goes in at the micro scale comes out as another squeal."""

import pytest

from tests.chain.conftest import QUICK, brakechain, contents

CHANGES = {
    "scan": "surface.pad.seed=4711",
    "pad modulus": "structure.pad.young_normal=2.1 GPa",
    "caliper stiffness": "structure.joints.guide_pin_axial=7e6 N/m",
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_changed_input_changes_the_squeal(copy, finished, change):
    brakechain("run", QUICK, "--run", copy, "--set", change, "--until", "squeal")
    assert contents(copy)["squeal"] != contents(finished)["squeal"]
