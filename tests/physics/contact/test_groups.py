"""Contacts with laws of their own against benches that hold one of them each."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped, alike, changed, parts, read, with_field
from pipeline.physics.friction.dry_friction import constant, falling, tabulated
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Table
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.roots import roots
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor
from tests.physics.lumps import lumps

LAWS = Penalty(1e4, 3.0), Table(np.array([0.0, 1e-3, 1e-2]), np.array([0.0, 8.0, 200.0]), 2.0)
FRICTIONS = falling(0.5, 0.3, 0.2, static_factor=1.2), constant(0.2, backward=2.0)
RATE = 2000.0


def bench(law, friction, blocks=1):
    """Masses on springs along a belt, each pressed onto it by a coordinate of its own."""
    eye = np.eye(2 * blocks)
    model = lumps(np.ones(2 * blocks), eye[::2], [400.0] * blocks, [0.5] * blocks, eye[1::2], eye[::2], 0.2)
    channels = tuple(Sensor(str(k), DISPLACEMENT, f"sensor_{k}") for k in range(2 * blocks))
    groups = {"one": (0,), "other": (1,)} if blocks == 2 else {}
    return Bench(model, law, friction, 1e-4, channels, groups, settled=True)


def run(blocks=1):
    told = Run("pressed", 0.4, RATE)
    load = -20 + 6 * np.sin(60 * told.time)
    inputs = {f"input_{2 * k}": 3 * np.sin(25 * told.time) for k in range(blocks)}
    drive = 0.2 - 0.9 * told.time       # it turns round on the way
    return replace(told, inputs=inputs | {f"input_{2 * k + 1}": load for k in range(blocks)}, drive=drive)


def grouped():
    return bench(Grouped(LAWS, (0, 1)), Grouped(FRICTIONS, (0, 1)), 2)


@pytest.mark.exact
def test_two_contacts_of_different_laws_move_as_two_benches():
    found = respond(grouped(), run(2))
    for k in range(2):
        alone = respond(bench(LAWS[k], FRICTIONS[k]), run())
        for name in ("0", "1"):
            np.testing.assert_allclose(found[str(2 * k + int(name))], alone[name], atol=1e-9 * abs(alone["0"]).max())


@pytest.mark.exact
def test_roots_are_those_of_both():
    found = roots(grouped(), run(2))
    apart = np.concatenate([roots(bench(law, friction), run()) for law, friction in zip(LAWS, FRICTIONS, strict=True)])
    key = [np.lexsort((r.imag, r.real, abs(r.imag))) for r in (found, apart)]
    np.testing.assert_allclose(found[key[0]], apart[key[1]], rtol=1e-9)


@pytest.mark.exact
def test_residuals_are_those_of_both():
    measured = respond(grouped(), run(2))
    found = equation_residual(grouped(), run(2), measured)
    for k in range(2):
        alone = equation_residual(bench(LAWS[k], FRICTIONS[k]), run(),
                                  {"0": measured[str(2 * k)], "1": measured[str(2 * k + 1)]})
        np.testing.assert_allclose(found[2 * k:2 * k + 2], alone, atol=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.2, -0.2])
def test_friction_of_each_direction(speed):
    steady = Run("steady", 0.1, RATE, {"input_1": -20.0}, drive=speed)
    found = respond(bench(LAWS[0], FRICTIONS[1]), steady)["0"]
    np.testing.assert_allclose(found, 20 * (0.2 if speed > 0 else -0.4) / 400, rtol=1e-9)


def test_laws_are_split_joined_and_read():
    first, second = Penalty(1e4), Penalty([2e4, 3e4, 4e4])
    split = changed(first, 3, (1, 2), lambda law: second)
    assert [own.tolist() for _, own in parts(split, 3)] == [[0], [1, 2]]
    np.testing.assert_array_equal(read(split, "stiffness", 3), [1e4, 3e4, 4e4])
    assert changed(split, 3, (0,), lambda law: second) is second
    assert changed(first, 3, (0,), lambda law: law) is first
    np.testing.assert_array_equal(read(with_field(split, gap=1e-3), "gap", 3), np.full(3, 1e-3))
    np.testing.assert_array_equal(read(Hard(), "stiffness", 2, 0.0), np.zeros(2))


@pytest.mark.parametrize("law, friction, said", [
    (Grouped((Hard(), LAWS[0]), (0, 1)), constant(0.3), "Hard, Penalty"),
    (Grouped((Hard(0.1), Hard(0.2)), (0, 1)), constant(0.3), "one restitution"),
    (LAWS[0], Grouped((constant(0.3), constant(0.3, description="elastic", stiffness=1e3)), (0, 1)), "one description"),
    (Grouped(LAWS, (0, 1, 1)), constant(0.3), "each of 2 contacts")])
def test_mixtures_that_cannot_be_are_refused(law, friction, said):
    with pytest.raises(ConfigError, match=said):
        respond(bench(law, friction, 2), run(2))


def test_a_law_that_nothing_obeys_is_refused():
    with pytest.raises(ConfigError, match="every one of 2"):
        Grouped((constant(0.1), tabulated([0.0], [0.2])), (0, 0))


def test_laws_are_alike_where_they_say_the_same_of_every_contact():
    penalty, table = LAWS
    assert alike(penalty, Grouped((Penalty(1e4, 3.0), Penalty(1e4, 3.0)), (0, 1)), 2)
    assert not alike(penalty, with_field(penalty, gap=np.array([0.0, 1e-6])), 2)
    assert not alike(penalty, Grouped((penalty, table), (0, 1)), 2)
    assert alike(table, Table(*(np.array(v) for v in (table.closure, table.pressure)), table.damping_speed), 2)
