"""Joints under rigid motions: what must not stretch does not, and only mounts hold a brake with a bracket."""

import numpy as np
import pytest

from pipeline.systems.disc_brake import build
from stages.structure import Settings
from tests.systems.test_disc_brake import COARSE
from tests.systems.test_disc_brake_bracket import BODIES

pytestmark = pytest.mark.exact
#: distance of the spots that a guide pin, or the seal, ties together
LEVER = 3e-3


@pytest.fixture(scope="module")
def brake():
    return build(Settings(**BODIES))


def rigid(brake, move):
    return np.concatenate([move(b.mesh.node).ravel() for b in brake.bodies])


def alone(brake, name, move):
    """Motion of the body ``name``, the others at rest."""
    return np.concatenate([(move(b.mesh.node) if n == name else 0 * b.mesh.node).ravel()
                           for n, b in zip(brake.names, brake.bodies, strict=True)])


def test_bodies_that_only_some_brakes_have(brake):
    assert brake.names == ("disc", "pad_outer", "pad_inner", "caliper", "bracket", "piston")
    assert build(Settings(**COARSE)).names == brake.names[:4] and build(Settings(**COARSE)).fluid is None


def test_only_the_mounts_hold_against_the_ground(brake):
    stretch = brake.joints.rows.matrix @ rigid(brake, lambda x: np.broadcast_to([1e-3, 2e-3, -3e-3], x.shape))
    expected = {"radial": 1e-3, "tangential": 2e-3, "axial": -3e-3}
    for name, value in zip(brake.joints.name, stretch, strict=True):
        kind = next(k for k in (*expected, "normal") if k in name)
        assert value == pytest.approx(expected[kind] if name.startswith("mount") else 0, abs=1e-12), name
    assert brake.piston.matrix @ rigid(brake, np.ones_like) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("axis", np.eye(3), ids="xyz")
def test_a_common_turn_stretches_nothing_but_gaps_and_mounts(brake, axis):
    """The ends of a spring are read at one place, or at most a gap apart."""
    stretch = brake.joints.rows.matrix @ rigid(brake, lambda x: np.cross(axis, x))
    for name, value in zip(brake.joints.name, stretch, strict=True):
        gap = LEVER if name.startswith(("guide_pin", "seal")) else 1e-9
        assert name.startswith("mount") or abs(value) < gap, name
    assert brake.piston.matrix @ rigid(brake, lambda x: np.cross(axis, x)) == pytest.approx(0, abs=1e-9)


def test_the_line_pressure_pushes_piston_and_floor_apart(brake):
    """A force pair of the whole force on both; it turns the piston about no axis."""
    for name, expected in (("piston", 1.0), ("caliper", -1.0), ("pad_inner", 0.0)):
        lifted = alone(brake, name, lambda x: np.broadcast_to([0, 0, 1.0], x.shape))
        assert (brake.piston.matrix @ lifted)[0] == pytest.approx(expected, abs=1e-12)
    middle = [Settings().joints.clamping_radius, 0, 0]
    for axis in np.eye(3):
        tilted = alone(brake, "piston", lambda x, axis=axis: np.cross(axis, x - middle))
        assert (brake.piston.matrix @ tilted)[0] == pytest.approx(0, abs=1e-9)


def test_springs_of_a_part_add_up_to_what_is_declared(brake):
    """Stiffness of the piston's rim, seal and of the mounts, each moved alone."""
    j = Settings(**BODIES).joints
    stiffness = dict(zip(brake.joints.name, brake.joints.stiffness, strict=True))

    def total(*parts):
        return sum(k for name, k in stiffness.items() if all(part in name for part in parts))

    assert total("piston", "normal") == pytest.approx(j.shim_stiffness)
    assert total("piston", "radial") == pytest.approx(j.piston_shear_stiffness)
    assert total("seal", "axial") == pytest.approx(j.piston_stiffness)
    assert total("seal", "radial") == pytest.approx(j.seal_stiffness)
    assert total("mount", "leading", "axial") == pytest.approx(j.mount_stiffness)
    assert total("guide_pin", "leading", "tangential") == pytest.approx(j.guide_pin_stiffness)


def test_kinds_of_joints_have_their_loss_factors():
    losses = {"abutment": 0.05, "finger": 0.02, "piston": 0.06, "guide_pin": 0.1, "seal": 0.2, "mount": 0.03}
    lossy = build(Settings(**{**BODIES, "joints": {f"{kind}_loss_factor": loss for kind, loss in losses.items()}}))
    seen = {name.removeprefix("guide_").split("_")[0]: loss
            for name, loss in zip(lossy.joints.name, lossy.joints.loss_factor, strict=True)}
    assert seen == {kind.removeprefix("guide_"): loss for kind, loss in losses.items()}


FIXED = BODIES["caliper"].model_copy(update={"fixed": True})
TWINS = {"kind": "body", "count": 2, "diameter": "38 mm"}


@pytest.fixture(scope="module", params=["bodies", "seals"])
def fixed(request):
    """A brake with a fixed caliper on the ground."""
    return build(Settings(**{**COARSE, "caliper": FIXED, **({"piston": TWINS} if request.param == "bodies" else {})}))


def test_a_fixed_caliper_is_bolted_on(fixed):
    """Nothing else holds it against the ground but the abutments of the pads; no fingers, no guide pins."""
    assert not [name for name in fixed.joints.name if name.startswith(("finger", "guide_pin"))]
    moved = fixed.joints.rows.matrix @ rigid(fixed, lambda x: np.broadcast_to([1e-3, 2e-3, -3e-3], x.shape))
    expected = {"radial": 1e-3, "tangential": 2e-3, "axial": -3e-3}
    for name, value in zip(fixed.joints.name, moved, strict=True):
        kind = next(k for k in (*expected, "normal") if k in name)
        held = name.startswith(("bolt", "abutment"))
        assert value == pytest.approx(expected[kind] if held else 0, abs=1e-12), name


def inwards(x):
    """Unit motion of points (n, 3) towards the disc."""
    return -np.sign(x[:, 2:]) * [0, 0, 1.0]


def test_line_pressure_pushes_both_pads_and_not_the_caliper(fixed):
    """A row for each side, the same force on both; of twins a half on each."""
    pushed = {name: fixed.piston.matrix @ alone(fixed, name, lambda x: np.broadcast_to([0, 0, 1.0], x.shape))
              for name in fixed.names}
    assert pushed["caliper"] == pytest.approx([-1, 1], abs=1e-12)
    if "piston" in fixed.names:
        assert fixed.piston.matrix @ alone(fixed, "piston", inwards) == pytest.approx(1, abs=1e-12)
        one = alone(fixed, "piston", lambda x: inwards(x) * ((x[:, 1:2] > 0) & (x[:, 2:] < 0)))
        assert fixed.piston.matrix @ one == pytest.approx([0.5, 0], abs=1e-12)
    else:
        assert pushed["pad_inner"] == pytest.approx([1, 0], abs=1e-12)
        assert pushed["pad_outer"] == pytest.approx([0, -1], abs=1e-12)


def test_springs_of_a_fixed_caliper_add_up_piston_by_piston(fixed):
    j, stiffness = Settings().joints, dict(zip(fixed.joints.name, fixed.joints.stiffness, strict=True))

    def total(*parts):
        return sum(k for name, k in stiffness.items() if all(part in name for part in parts))

    twins = "piston" in fixed.names
    assert total("piston", "normal") == pytest.approx(4 * j.shim_stiffness if twins else 2 * j.piston_stiffness)
    assert total("piston", "normal", "outer_pad") == pytest.approx(total("piston", "normal") / 2)
    assert total("seal", "axial") == pytest.approx(4 * j.piston_stiffness if twins else 0)
    assert total("bolt", "leading", "axial") == pytest.approx(j.bolt_stiffness)
    assert len(set(fixed.joints.name)) == len(fixed.joints.name)
