"""From recordings of friction and faces to what a diagnosis compares."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.features.worn_faces import observed, rubbed, shown
from tests.diagnosis.small_pad import CYCLES, PRESSURES, STD, TRANSFER, recording


def changed(recorded, name="drag_1", **values):
    """The recording with other parts of one run."""
    return replace(recorded, runs={**recorded.runs, name: replace(recorded.runs[name], **values)})


def table(recorded, **values):
    """The recording with other columns of friction in drag_1."""
    told = recorded.runs["drag_1"].friction["load_cell"]
    return changed(recorded, friction={"load_cell": replace(told, **values)})


@pytest.mark.exact
def test_runs_tell_their_drag_and_what_was_worn_off():
    """Depths within four standard errors of k P s, the disc grown by what sticks to it."""
    found = rubbed(recording(TRANSFER), 5e-5)
    assert set(found) == {f"drag_{k}" for k in range(4)}
    for one, pressure in zip(found.values(), PRESSURES, strict=True):
        assert one.drag.pressure == pytest.approx(pressure) and len(one.friction) == 3 * len(CYCLES)
        for channel, coefficient in (("pad wear", 4e-12), ("disc wear", 4e-13 - 0.6 * 4e-12)):
            depth, error = one.wear[channel]
            assert depth == pytest.approx(coefficient * pressure * 10e-3, abs=4 * error + 1e-9)


def test_observed_lays_out_friction_point_by_point_and_wear_at_the_end():
    one = rubbed(recording(), 5e-5)["drag_0"]
    seen = observed(one, False, 0.02)
    assert seen.channels == ("friction", "pad wear", "disc wear") and seen.valid.sum(axis=1).tolist() == [12, 1, 1]
    shared = np.hypot(STD, np.sqrt(3) * 0.02 * one.friction)    # three speeds share the spots of a way
    np.testing.assert_allclose(seen.noise_std[0], shared)
    again = shown(one.friction, {c: depth for c, (depth, _) in one.wear.items()}, seen.channels)
    np.testing.assert_array_equal(again, seen.samples)


def test_points_come_in_the_order_of_the_way():
    recorded = recording(faces=False)
    told = recorded.runs["drag_1"].friction["load_cell"]
    back = {name: getattr(told, name)[::-1] for name in ("friction", "friction_std", "speed", "distance")}
    found = rubbed(table(recorded, **back), 5e-5)["drag_1"]
    assert np.all(np.diff(found.drag.distance) >= 0) and not found.wear
    assert sorted(found.friction) == sorted(told.friction)


@pytest.mark.parametrize("wrong, said", [
    (lambda r: replace(r, runs={"faces": r.runs["faces"]}), "recordings of friction"),
    (lambda r: table(r, pressure=np.linspace(1e6, 2e6, 12)), "one nominal pressure"),
    (lambda r: table(r, speed=np.zeros(12)), "speeds above 0"),
    (lambda r: table(r, friction_std=np.zeros(12)), "diagnosis.noise.std.friction"),
    (lambda r: changed(r, friction=dict.fromkeys("ab", r.runs["drag_1"].friction["load_cell"])), "one table"),
    (lambda r: changed(r, "faces", topography={}), "a new face of the pad beside the worn one")])
def test_recordings_that_cannot_be_used_are_refused(wrong, said):
    with pytest.raises(ConfigError, match=said):
        rubbed(wrong(recording()), 5e-5)


def test_a_stated_scatter_stands_in():
    recorded = table(recording(faces=False), friction_std=np.zeros(12))
    np.testing.assert_array_equal(rubbed(recorded, 5e-5, 0.01)["drag_1"].std, 0.01)


def test_worn_faces_of_other_pixels_are_refused():
    recorded = recording()
    faces = recorded.runs["drag_1"].topography
    stretched = {name: replace(face, x=2 * face.x) if face.state == "worn" else face for name, face in faces.items()}
    with pytest.raises(ConfigError, match=r"run drag_1: topography: expected the worn face .* on the pixels"):
        rubbed(changed(recorded, topography=stretched), 5e-5)
