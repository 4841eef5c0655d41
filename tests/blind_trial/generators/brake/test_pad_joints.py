"""Joints of the pads: a shim that loses alike at every frequency, an abutment that stiffens under friction."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake, brake_files, brake_parts, pad_joints
from pipeline.blind_trial.generators.brake.brake_parts import NOMINAL, SHAPES, built
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical

SLIDING = brake.Run("sliding", 1500.0, 0.5, 0.5)
REST = replace(SLIDING, speed=0.0)
LIFTED = replace(REST, load=0.0)
STIFFENING = {"coefficient": 4e16, "pad": 0}


def made(**hidden):
    return built(NOMINAL, SHAPES[0], hidden=hidden)


def roots(bench, run):
    found = np.linalg.eigvals(brake.small_motion(bench, run))
    found = found[found.imag > 500]
    return found[np.argsort(found.imag)]


@pytest.mark.exact
@pytest.mark.parametrize("hidden", [{"shim_damping": {"loss_factor": 0.0}},
                                    {"cubic_stiffness": {"coefficient": 0.0, "pad": 1}}], ids=lambda h: "".join(h))
def test_at_its_null_nothing_is_hidden(hidden):
    for run in (SLIDING, REST, LIFTED):
        np.testing.assert_allclose(roots(made(**hidden), run), roots(made(), run), rtol=1e-9)


@pytest.mark.exact
def test_a_shim_loses_alike_over_the_band_and_stores_as_the_fingers_do_in_its_middle():
    """Response of the branches to e = exp(i w t): k_0 + sum g i w tau / (1 + i w tau) = k(w) (1 + i h)."""
    bench, at = made(shim_damping={"loss_factor": 0.1}), built(NOMINAL, SHAPES[0]).disc + 1
    size = len(bench.mass)
    matrix = brake.small_motion(bench, LIFTED)
    internal, fed, push = matrix[2 * size:, 2 * size:], matrix[2 * size:, size + at], matrix[size + at, 2 * size:]

    def stiffness(frequency):
        s = 2j * np.pi * frequency
        branches = push @ np.linalg.solve(s * np.eye(len(internal)) - internal, fed * s)
        return pad_joints.relaxed(bench)[at, at] - bench.mass[at, at] * branches

    middle = stiffness(1000.0)
    assert middle.real == pytest.approx(NOMINAL["fingers"]) and middle.imag == pytest.approx(0.1 * NOMINAL["fingers"])
    for frequency in (350.0, 3600.0):
        assert stiffness(frequency).imag == pytest.approx(0.1 * NOMINAL["fingers"], rel=0.03)


@pytest.mark.exact
def test_a_small_loss_moves_roots_by_its_share_of_their_energy():
    """Rayleigh: p moves by -h/2 |p| times the share of the elastic energy that the fingers have, at first order."""
    bench, small = made(), made(shim_damping={"loss_factor": 1e-4})
    plain, lossy = (replace(each, damping=0 * each.damping) for each in (bench, small))
    squared, shape = np.linalg.eigh(plain.stiffness / np.sqrt(np.outer(*[np.diag(plain.mass)] * 2)))
    shape = shape / np.sqrt(np.diag(plain.mass))[:, None]
    share = NOMINAL["fingers"] * (shape[plain.disc + 1] - shape[plain.disc + 6]) ** 2 / squared
    seen = (squared > (2 * np.pi * 350) ** 2) & (squared < (2 * np.pi * 3600) ** 2)
    wanted = -1e-4 / 2 * np.sqrt(squared[seen]) * share[seen]
    found = roots(lossy, LIFTED)
    found = found[(found.imag > 2 * np.pi * 350) & (found.imag < 2 * np.pi * 3600)]
    np.testing.assert_allclose(found.real, wanted, atol=0.03 * abs(wanted).max())


@pytest.mark.exact
def test_an_abutment_carries_the_friction_and_has_the_slope_of_its_law():
    bench = made(cubic_stiffness=STIFFENING)
    half, at = len(bench.share) // 2, bench.disc
    place, press, _ = brake.pressed(bench, SLIDING)
    law = NOMINAL["abutment_outer"] * place[at] + 4e16 * place[at] ** 3
    assert law == pytest.approx(NOMINAL["friction"] * press[:half].sum(), rel=1e-9)
    step, size = 0.1, len(bench.mass)
    more, less = (brake.pressed(bench, replace(SLIDING, load=1500 + s))[0] for s in (step, -step))
    stiffness = -bench.mass @ brake.small_motion(bench, SLIDING)[size:2 * size, :size]
    np.testing.assert_allclose(stiffness @ (more - less) / (2 * step), bench.press, atol=2e-5)


def test_lifted_an_abutment_that_stiffens_shows_nothing():
    np.testing.assert_array_equal(roots(made(cubic_stiffness=STIFFENING), LIFTED), roots(made(), LIFTED))


@pytest.mark.parametrize("name", pad_joints.FURTHER)
def test_told_names_and_values_are_those_of_the_catalogue(name):
    told = brake_files.named(name, brake_files.sizes(np.random.default_rng(1), name))
    effect = next(e for e in CATALOGUE if e.name == name)
    assert set(told["parameters"]) == set(pad_joints.FURTHER[name])
    assert set(told["parameters"]) <= {p.name for p in effect.parameters(Typical())}
    assert told["place"] in ("fingers", *(f"abutment_{pad}" for pad in brake_parts.PADS))


def test_no_trial_draws_them():
    assert not set(pad_joints.FURTHER) & {name for kind in brake_files.hides().values() for names in kind
                                          for name in names}
