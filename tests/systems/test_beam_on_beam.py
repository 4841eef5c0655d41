"""The two beams: masses, rows, both kinds of elements, supports that yield, and what cannot be built."""

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.contract.errors import ConfigError
from pipeline.systems.beam_on_beam import build, joined, touching, upwards
from stages.beam_on_beam import Contact, ReadingPoint, Settings, Slider, Track

SETTINGS = Settings()


def changed(**parts):
    return SETTINGS.model_copy(update=parts)


def frequencies(body, count=5):
    squared = eigh(body.stiffness.toarray(), body.mass.toarray(), eigvals_only=True, subset_by_index=(0, count - 1))
    return np.sqrt(np.maximum(squared, 0)) / (2 * np.pi)


@pytest.mark.exact
def test_plane_elements_agree_with_timoshenko_beams():
    """Bending below 10 kHz within 1 %: the clamp of plane elements also holds the contraction across."""
    for plane, thin, start in zip(build(SETTINGS, "plane"), build(SETTINGS, "timoshenko"), (1, 0), strict=True):
        wanted = frequencies(thin, 9)[start:]
        wanted = wanted[wanted < 10e3]
        assert len(wanted) >= 3
        np.testing.assert_allclose(frequencies(plane, 9)[start:start + len(wanted)], wanted, rtol=0.01)


@pytest.mark.exact
@pytest.mark.parametrize("element", ["plane", "timoshenko"])
def test_slider_moves_freely_along_y_with_all_its_mass(element):
    slider, _ = build(SETTINGS, element)
    squared, shape = eigh(slider.stiffness.toarray(), slider.mass.toarray(), subset_by_index=(0, 1))
    assert abs(squared[0]) < 1e-6 * squared[1]
    p = SETTINGS.slider
    weight = SETTINGS.material.density * p.length * p.thickness * p.width + SETTINGS.contact.mass
    move = shape[:, 0] * np.sqrt(weight)
    np.testing.assert_allclose(abs(slider.contact @ move), [0, 1], atol=1e-4)
    np.testing.assert_allclose(abs(slider.load @ move), [1], rtol=1e-4)
    assert (slider.load @ move)[0] * (slider.contact[1] @ move) < 0, "the force presses towards the track"


@pytest.mark.exact
@pytest.mark.parametrize("element", ["plane", "timoshenko"])
def test_friction_bends_the_track_by_its_lever(element):
    """A unit force along x on the face: the face rises by F (h / 2) a^2 / (2 E I) at the distance a from the clamp."""
    _, track = build(SETTINGS, element)
    p, a = SETTINGS.track, SETTINGS.contact.distance
    bending = SETTINGS.material.young * p.width * p.thickness**3 / 12
    moved = track.contact @ np.linalg.solve(track.stiffness.toarray(), track.contact[0])
    assert moved[1] == pytest.approx(-p.thickness / 2 * a**2 / (2 * bending), rel=0.03)


@pytest.mark.exact
def test_support_that_yields_turns_the_track_as_a_whole():
    """With a soft spring in rotation, the lowest mode is that of a rigid bar on a hinge: w^2 = 3 k / (m L^2)."""
    spring, p = 50.0, SETTINGS.track
    soft = changed(track=p.model_copy(update={"clamp_rotation_stiffness": spring}))
    weight = SETTINGS.material.density * p.length * p.thickness * p.width
    wanted = np.sqrt(3 * spring / (weight * p.length**2)) / (2 * np.pi)
    for element in ("plane", "timoshenko"):
        assert frequencies(build(soft, element)[1])[0] == pytest.approx(wanted, rel=0.01)
    guided = changed(slider=SETTINGS.slider.model_copy(update={"guide_stiffness": 1e12,
                                                               "guide_rotation_stiffness": 1e9}))
    np.testing.assert_allclose(frequencies(build(guided, "timoshenko")[0])[1:],
                               frequencies(build(SETTINGS, "timoshenko")[0])[1:], rtol=1e-4)


def test_pictures_show_both_faces_and_the_tip_on_the_track():
    slider, track = build(changed(contact=Contact(offset=0.0)), "timoshenko")
    middle = slider.position[:2].mean(axis=0)
    np.testing.assert_allclose(middle, [SETTINGS.contact.distance, SETTINGS.track.thickness / 2], atol=1e-12)
    assert slider.position[-1, 0] < middle[0], "a negative tilt leans towards the clamp"
    assert track.face.max() == len(track.position) - 1
    np.testing.assert_allclose(np.ptp(track.position[:, 1]), SETTINGS.track.thickness)


@pytest.mark.parametrize("parts, said", [
    ({"contact": Contact(distance="400 mm")}, "never touch"), ({"sensor": ReadingPoint(height="1 m")}, "sensor.height"),
    ({"slider": Slider(tilt="70 deg")}, "stands"), ({"contact": Contact(patch="200 mm")}, "patch"),
    ({"track": Track(length="79 mm")}, "contact.distance")])
def test_systems_that_cannot_be_built_are_refused(parts, said):
    with pytest.raises(ConfigError, match=said):
        build(changed(**parts), "timoshenko")


def test_unknown_element_is_refused():
    with pytest.raises(ConfigError, match="element"):
        build(SETTINGS, "solid")


@pytest.mark.exact
def test_rows_of_the_pair_are_slider_less_track():
    """Seen in the free coordinates themselves; only the slider is loaded and carries the sensor."""
    bodies = build(SETTINGS, "timoshenko")
    modes, sensor, load = joined(bodies, [np.zeros(len(b.load[0])) for b in bodies],
                                 [np.eye(len(b.load[0])) for b in bodies])
    slider, track = np.split(modes.normal, [len(bodies[0].load[0])])
    assert np.array_equal(slider, bodies[0].contact[1]) and np.array_equal(track, -bodies[1].contact[1])
    assert np.array_equal(modes.tangent, np.r_[bodies[0].contact[0], -bodies[1].contact[0]])
    assert not sensor[len(slider):].any() and not load[len(slider):].any() and load[:len(slider)].any()


@pytest.mark.exact
def test_the_slider_stands_where_it_touches_and_leans_by_its_tilt():
    assert touching(SETTINGS) == pytest.approx([SETTINGS.contact.distance, SETTINGS.track.thickness / 2])
    along = upwards(changed(slider=Slider(tilt="30 deg")))
    assert along == pytest.approx([0.5, np.sqrt(0.75)])
