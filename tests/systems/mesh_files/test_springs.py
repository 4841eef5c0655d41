"""Springs of a deck as joints: elongations, units, springs to the ground, and those that end nowhere."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.systems.disc_brake import build
from pipeline.systems.mesh_files.bodies import notes
from pipeline.systems.mesh_files.springs import deck_springs, unread_springs
from stages.structure import Joints, Settings
from tests.stages.brake_deck import SETS, deck, meshes
from tests.stages.test_whole_brake import BRAKE, NATIVE

pytestmark = pytest.mark.exact
BODIES = {name: mesh.node for name, mesh in meshes(NATIVE).items()}
FIRST = dict(zip(BODIES, 1 + np.cumsum([0, *map(len, BODIES.values())]), strict=False))
#: a node of the outer backplate and one of the caliper
PLATE, HOUSING = 7, 11
ENDS = f"{FIRST['OUTER_PLATE'] + PLATE}, {FIRST['CALIPER'] + HOUSING}"


def case(path, springs, **joints):
    path.write_text(deck(NATIVE) + springs)
    return Settings(**{**BRAKE, "mesh_file": path, "mesh_units": "mm-t-s", "mesh_sets": SETS,
                       "joints": Joints(**joints)})


def written(kind, ends, freedoms="", name="S"):
    return f"*ELEMENT, TYPE={kind}, ELSET={name}\n90001, {ends}\n*SPRING, ELSET={name}\n{freedoms}250.,\n"


def test_a_spring_along_the_line_of_its_ends(tmp_path):
    """250 N/mm; stretching the line by d along itself lengthens the spring by d, other motions do not."""
    brake = build(case(tmp_path / "a.inp", written("SPRINGA", ENDS)))
    assert brake.joints.name[-1] == "spring_s_90001" and brake.joints.stiffness[-1] == pytest.approx(250e3)
    assert brake.joints.loss_factor[-1] == 0 and brake.joints.damping[-1] > 0
    line = BODIES["CALIPER"][HOUSING] - BODIES["OUTER_PLATE"][PLATE]
    row = [part.toarray()[-1].reshape(-1, 3) for part in brake.joints.rows.parts]
    assert not np.any(row[0]) and not np.any(row[2])
    unit = line / np.linalg.norm(line)
    assert row[3].sum(axis=0) == pytest.approx(unit) and row[1].sum(axis=0) == pytest.approx(-unit)


@pytest.mark.parametrize("kind, ends, freedoms, axes", [
    ("SPRING2", ENDS, "3, 1\n", (2, 0)), ("SPRING2", ENDS, "2\n", (1, 1)),
    ("SPRING1", ENDS.split(",")[0], "2\n", (1, None))])
def test_springs_along_axes(tmp_path, kind, ends, freedoms, axes):
    brake = build(case(tmp_path / "a.inp", written(kind, ends, freedoms)))
    plate, housing = (brake.joints.rows.parts[k].toarray()[-1].reshape(-1, 3).sum(axis=0) for k in (1, 3))
    assert plate == pytest.approx(np.eye(3)[axes[0]])
    assert housing == pytest.approx(np.zeros(3) if axes[1] is None else -np.eye(3)[axes[1]])


def test_springs_stand_for_kinds_of_joints(tmp_path):
    settings = case(tmp_path / "a.inp", written("SPRINGA", ENDS), left_out=("guide_pin", "finger"))
    names = build(settings).joints.name
    assert not any(name.startswith(("guide_pin", "finger")) for name in names) and names[-1].startswith("spring")
    bare = case(tmp_path / "b.inp", written("SPRINGA", ENDS),
                left_out=("abutment", "finger", "piston", "guide_pin", "seal", "mount"))
    assert build(bare).joints.name == ("spring_s_90001",)
    with pytest.raises(ValueError, match="left_out"):
        Joints(left_out=("hinge",))


def test_what_is_not_taken_is_said(tmp_path):
    """A spring to a node of no body, springs without stiffness, nonlinear ones."""
    more = "*NODE\n99999, 0, 0, 0\n" + written("SPRINGA", f"{FIRST['CALIPER']}, 99999") \
        + "*ELEMENT, TYPE=SPRINGA, ELSET=T\n90002, 1, 2\n*ELEMENT, TYPE=SPRINGA, ELSET=U\n90003, 1, 2\n" \
        + "*SPRING, ELSET=U, NONLINEAR\n0., 0.\n1., 2.\n"
    settings = case(tmp_path / "a.inp", more)
    assert unread_springs(settings) == ("a.inp: not read: springs that end outside the bodies: s_90001",)
    note = notes(settings)[0]
    assert "*SPRING that is nonlinear" in note and "*ELEMENT of type SPRINGA (2 times)" in note
    names, _, rows = deck_springs(settings, ("disc", "pad_outer", "pad_inner", "caliper"),
                                  [body.mesh for body in build(settings).bodies])
    assert names == [] and rows.parts[0].shape[0] == 0


@pytest.mark.parametrize("springs, message", [
    (written("SPRINGA", f"{ENDS.split(',')[0]}, {ENDS.split(',')[0]}"), "spring s_90001: expected a line between its"),
    (written("SPRINGA", "1"), "2 nodes of an element of type SPRINGA, found 1"),
    (written("SPRING2", ENDS, "4, 4\n"), "degrees of freedom 1, 2 or 3"),
    (written("SPRING1", "1", "x\n"), "a whole number, found 'x'")])
def test_faults_of_springs(tmp_path, springs, message):
    with pytest.raises(ConfigError, match=message):
        build(case(tmp_path / "a.inp", springs))
