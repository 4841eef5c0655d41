"""Settings of the joints of a brake."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.bodies.brake_bodies import Bracket, Caliper, Disc, Pad, Piston
from pipeline.case_models.bodies.brake_joints import Joints, PressedPads
from pipeline.systems import disc_brake
from pipeline.systems.disc_brake_joints import joints

#: joints that a floating caliper and one that is fixed do not have
WITHOUT = {False: {"bolt_stiffness"},
             True: {"finger_stiffness", "finger_shear_stiffness", "guide_pin_stiffness", "guide_pin_axial_stiffness",
                    "mount_stiffness"}}


@pytest.mark.slow
@pytest.mark.parametrize(("fixed", "without"), WITHOUT.items())
def test_every_stiffness_moves_springs_of_its_own(fixed, without):
    """With every body a caliper may have: each spring is in proportion to one stiffness, and each has springs."""
    parts = {"disc": Disc(web_cells=2, ring_cells=2, angular_cells=12), "pad": Pad(), "sensors": (),
             "caliper": Caliper(inner_radius="92 mm", fixed=fixed), "piston": Piston(diameter="38 mm"),
             "bracket": SimpleNamespace(kind="ground") if fixed else Bracket()}
    meshes = [b.mesh for b in disc_brake.build(SimpleNamespace(**parts, joints=Joints())).bodies]

    def springs(**changes):
        return joints(meshes, SimpleNamespace(**parts, joints=Joints(**changes))).stiffness

    names = {name for name in Joints.model_fields if name.endswith("stiffness")} - without
    names, before = sorted(names), springs()
    ratio = np.array([springs(**{name: f"{2 * getattr(Joints(), name)} N/m"}) / before for name in names])
    assert set(np.unique(ratio.round(9))) == {1.0, 2.0}
    np.testing.assert_array_equal((ratio > 1.5).sum(axis=0), 1)
    assert (ratio > 1.5).any(axis=1).all()


def test_pads_are_lifted_unless_a_force_presses_them():
    assert PressedPads().force == 0 and PressedPads().stiffness == pytest.approx(1e12)
