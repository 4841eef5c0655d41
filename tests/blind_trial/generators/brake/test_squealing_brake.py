"""The squealing bench: pads that flutter by a closed form, nulls, and what its lists hold."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake, brake_parts, squealing_brake
from pipeline.blind_trial.generators.brake.squealing_brake import (
    BAND,
    DRAWN,
    FOREIGN,
    INCLINED,
    ONE_WAY,
    RESOLUTION,
    TWO_WAY,
    campaign,
    drawn,
    growing,
    heard,
    held,
    inclined,
)
from tests.blind_trial.generators.imported import imported

SHAPE = brake_parts.SHAPES[0]


def test_it_uses_nothing_of_the_tool():
    here = "pipeline.blind_trial.generators"
    assert not [m for m in imported(f"{here}.brake.squealing_brake") if not m.startswith(here) and (
        m.startswith("pipeline") and not m.startswith("pipeline.contract.errors"))]


@pytest.mark.exact
def test_an_inner_pad_on_a_disc_that_does_not_move_flutters_as_three_coordinates_do(monkeypatch):
    """(x, u, f) of a pad that no seal holds, without damping, written out: lining, abutment and clip."""
    monkeypatch.setattr(brake_parts, "ABUTMENT_LOSS", 0.0)
    for joint in ("SEAL", "CLIP"):
        monkeypatch.setattr(brake_parts, joint, (getattr(brake_parts, joint)[0] * (joint == "CLIP"), 0.0))
    whole = held(inclined(brake_parts.built(DRAWN, SHAPE), DRAWN))
    run = brake.Run("", 700.0, 4.0, 0.0)
    half, k, mu, c, s = len(whole.share) // 2, DRAWN["contact"], DRAWN["friction"], np.cos(INCLINED), np.sin(INCLINED)
    arm = whole.normal[half:, 5]
    share, height = whole.share[half:], brake_parts.HEIGHT
    lean = DRAWN["abutment_inner"]
    stiffness = np.array([
        [lean * c * c, lean * c * s + mu * k, mu * k * (share @ arm)],
        [lean * c * s, lean * s * s + k, k * (share @ arm)],
        [0.0, k * (share @ arm) + mu * height * k,
         k * (share @ arm**2) + mu * height * k * (share @ arm) + brake_parts.CLIP[0]]])
    mass = np.array([brake_parts.PAD, brake_parts.PAD, brake_parts.PITCH])
    expected = np.linalg.eigvals(stiffness / mass[:, None]) ** 0.5
    found = np.linalg.eigvals(brake.small_motion(whole, run))
    for rate in expected:
        assert abs(found - 1j * rate).min() < 1e-6 * abs(rate)
    assert abs(expected.imag).max() > 300


@pytest.mark.exact
def test_upright_abutments_are_those_of_the_brake(monkeypatch):
    monkeypatch.setattr(squealing_brake, "INCLINED", 0.0)
    plain = brake_parts.built(DRAWN, SHAPE)
    np.testing.assert_allclose(inclined(plain, DRAWN).stiffness, plain.stiffness)


@pytest.mark.exact
def test_a_disc_that_cannot_bend_is_a_disc_that_does_not_move():
    stiff = inclined(brake_parts.built({**DRAWN, "young": 1e6 * DRAWN["young"]}, SHAPE), DRAWN)
    plain = inclined(brake_parts.built(DRAWN, SHAPE), DRAWN)
    np.testing.assert_allclose(growing(stiff, 700.0, 4.0), growing(held(plain), 700.0, 4.0), rtol=1e-3)


def test_without_friction_nothing_squeals():
    still = inclined(brake_parts.built({**DRAWN, "friction": 0.0}, SHAPE), DRAWN)
    assert not len(growing(still, 700.0, 4.0)) and not len(growing(held(still), 700.0, 4.0))


def test_lines_are_growing_modes_or_their_second_harmonics():
    bench = drawn(3, TWO_WAY, SHAPE)
    roots = np.concatenate([growing(bench.brake, load, speed).imag / (2 * np.pi) for _, load, speed in campaign()])
    known = np.append(roots, 2 * roots)
    lists = heard(bench, 3)
    lines = np.concatenate(list(lists.values()))
    assert len(lists) == 6 and len(lines) > 3
    assert np.mean([abs(known - f).min() <= 2 * RESOLUTION for f in lines]) > 0.8
    assert all(np.all(np.diff(of) > 0) and ((of > BAND[0]) & (of < BAND[1])).all() for of in lists.values())


def test_each_kind_is_what_it_says():
    two, one, other = (drawn(5, kind, SHAPE) for kind in (TWO_WAY, ONE_WAY, FOREIGN))
    assert two.brake.disc > 0 == one.brake.disc and other.brake is None and two.values == one.values
    assert any(len(lines) for lines in heard(other, 5).values())
    np.testing.assert_array_equal(np.concatenate(list(heard(two, 5).values())),
                                  np.concatenate(list(heard(two, 5).values())))
