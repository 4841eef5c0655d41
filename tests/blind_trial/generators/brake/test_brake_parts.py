"""Parts of the practice brake: pads on their joints, what is hidden in the parts, and what they may use."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake_parts
from pipeline.blind_trial.generators.brake.annulus import Disc, thick
from tests.blind_trial.generators.imported import imported

SHAPE = brake_parts.SHAPES[0]


def built(hidden=None, scale=None):
    return brake_parts.built(brake_parts.NOMINAL, SHAPE, scale, hidden)


def undamped(bench):
    """Natural angular frequencies of the parts alone."""
    return np.sqrt(np.linalg.eigvals(np.linalg.solve(bench.mass, bench.stiffness)).real.clip(0))


def nearest(bench, wanted):
    return min(undamped(bench), key=lambda rate: abs(rate - wanted))


def test_they_use_nothing_of_the_diagnosis():
    here = "pipeline.blind_trial.generators.brake"
    assert imported(f"{here}.brake_parts") == {f"{here}.brake_parts", f"{here}.annulus"}


@pytest.mark.exact
def test_a_disc_alone_has_the_modes_of_its_plate_and_pads_those_of_their_joints():
    plate = Disc(*SHAPE, brake_parts.NOMINAL["young"], brake_parts.POISSON, brake_parts.NOMINAL["density"])
    found = undamped(built())
    for order in (0, 3):
        wanted = np.sqrt(thick(plate, order).squared[0])
        assert np.sum(abs(found / wanted - 1) < 1e-9) == 1 + (order > 0)
    assert nearest(built(), np.sqrt(3e7 / 0.4)) == pytest.approx(np.sqrt(3e7 / 0.4), rel=1e-12)
    assert nearest(built(), np.sqrt(2.4e7 / 0.4)) == pytest.approx(np.sqrt(2.4e7 / 0.4), rel=1e-12)


@pytest.mark.exact
def test_linings_move_with_their_pads_as_rigid_bodies_and_shares_cover_a_face():
    bench, half = built(), len(built().share) // 2
    assert bench.share[:half].sum() == pytest.approx(1) and np.array_equal(bench.share[:half], bench.share[half:])
    opened = np.zeros(len(bench.mass))
    opened[bench.disc + 1] = 1.0
    np.testing.assert_allclose(bench.normal @ opened, np.repeat((1.0, 0.0), half))
    pitched = np.eye(len(opened))[bench.disc + 2]
    np.testing.assert_allclose((bench.tangent @ pitched)[:half], brake_parts.HEIGHT)
    assert bench.share[:half] @ (bench.normal @ pitched)[:half] == pytest.approx(0, abs=1e-12)
    pushed = -bench.normal[:, :bench.disc]        # the disc moves towards one pad as it moves away from the other
    np.testing.assert_allclose(pushed[:half], -pushed[half:])


@pytest.mark.exact
def test_a_split_doublet_parts_by_its_share_and_leaves_the_others():
    """w^2 (1 -+ share), whatever the angle (S. A. Tobias, R. N. Arnold 1957)."""
    split = undamped(built({"doublet_split": {"share": 0.02, "angle": 0.7, "order": 3}}))
    plate = Disc(*SHAPE, brake_parts.NOMINAL["young"], brake_parts.POISSON, brake_parts.NOMINAL["density"])
    for wanted in (thick(plate, 3).squared[0] * np.array((0.98, 1.02))):
        assert np.min(abs(split**2 / wanted - 1)) < 1e-9
    assert np.sum(abs(split / np.sqrt(thick(plate, 2).squared[0]) - 1) < 1e-9) == 2


@pytest.mark.exact
@pytest.mark.parametrize("name, what", [("attached_mass", "mass"), ("added_stiffness", "stiffness")])
def test_little_at_a_point_shifts_a_mode_as_rayleigh_says(name, what):
    """The mode without diameters, w(r): d w / w = -m w^2 / 2, or k w^2 / (2 w^2), of a modal mass of 1 kg."""
    bench, size = built(), {"mass": 1e-6, "stiffness": 1.0}[what]
    rate, seen = np.sqrt(bench.stiffness[0, 0]), bench.sensors[1, 0]
    shifted = nearest(built({name: {what: size, "sensor": 1}}), rate)
    wanted = -0.5 * size * seen**2 if what == "mass" else 0.5 * size * seen**2 / rate**2
    assert shifted / rate - 1 == pytest.approx(wanted, rel=1e-3)


@pytest.mark.exact
def test_a_base_behind_an_abutment_is_two_masses_in_series():
    """(k - m w^2) (k + k_b - m_b w^2) = k^2 (J. P. Den Hartog 1934)."""
    k, m, own, rate = 2.4e7, brake_parts.PAD, 1e8, 2 * np.pi * 1000
    bench = built({"moving_base": {"compliance": 1 / own, "frequency": 1000.0, "pad": 1}})
    b = own / rate**2
    wanted = np.roots([m * b, -(m * (k + own) + b * k), k * (k + own) - k**2])
    for squared in wanted:
        assert nearest(bench, np.sqrt(squared)) ** 2 == pytest.approx(squared, rel=1e-9)
    assert len(bench.mass) == len(built().mass) + 1
    stiff = built({"moving_base": {"compliance": 1e-15, "frequency": 1e5, "pad": 1}})
    assert nearest(stiff, np.sqrt(k / m)) == pytest.approx(np.sqrt(k / m), rel=1e-6)


@pytest.mark.exact
def test_a_clip_is_an_oscillator_on_its_point():
    """What carries no mass to speak of swings with its own frequency."""
    bench = built({"resonant_clip": {"mass": 1e-9, "frequency": 1234.0, "sensor": 3}})
    assert nearest(bench, 2 * np.pi * 1234) == pytest.approx(2 * np.pi * 1234, rel=1e-6)


@pytest.mark.exact
def test_scales_change_one_order_alone():
    bench, plain = built(scale={("frequency", 0): 1.1, ("mass", 0): 1.21, ("damping", 0): 2.0}), built()
    assert bench.stiffness[0, 0] == pytest.approx(1.21 * plain.stiffness[0, 0])
    assert bench.damping[0, 0] == pytest.approx(2.2 * plain.damping[0, 0])
    np.testing.assert_allclose(bench.sensors[:3, 0], plain.sensors[:3, 0] / 1.1)
    np.testing.assert_array_equal(bench.normal[:, 1:], plain.normal[:, 1:])
