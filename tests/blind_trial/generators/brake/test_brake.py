"""The practice brake: steady states and small motions against its forces, nulls of what it hides, its recorder."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from pipeline.blind_trial.generators.brake import brake, brake_parts
from pipeline.blind_trial.generators.brake.brake_parts import NOMINAL, SHAPES, built
from pipeline.contract.errors import ConvergenceError
from tests.blind_trial.generators.imported import imported

SLIDING = brake.Run("sliding", 700.0, 0.5, 0.5)
REST = replace(SLIDING, name="rest", speed=0.0)
LIFTED = replace(REST, name="lifted", load=0.0)
#: each at its null
NULLS = {"contact_stiffness_law": {"exponent": 0.0}, "contact_damping": {"damping": 0.0},
         "falling_friction": {"rise": 0.0, "decay_speed": 0.1}, "contact_memory": {"length": 1e-12},
         "pressure_dependent_friction": {"exponent": 0.0},
         "doublet_split": {"share": 0.0, "angle": 0.5, "order": 2}, "attached_mass": {"mass": 0.0, "sensor": 1},
         "added_stiffness": {"stiffness": 0.0, "sensor": 1},
         "moving_base": {"compliance": 1e-16, "frequency": 1e6, "pad": 0}, "heated_disc": {"drop": 0.0},
         "slack_abutment": {"exponent": 0.0}, "resonant_clip": {"mass": 1e-12, "frequency": 50.0, "sensor": 3}}


def made(**hidden):
    return built(NOMINAL, SHAPES[0], hidden=hidden)


def roots(bench, run=SLIDING):
    """Those within the band of the poles, by frequency."""
    found = np.linalg.eigvals(brake.small_motion(bench, run))
    found = found[(found.imag > 2 * np.pi * 350) & (found.imag < 2 * np.pi * 3600)]
    return found[np.argsort(found.imag)]


def test_it_uses_nothing_of_the_diagnosis():
    here = "pipeline.blind_trial.generators"
    assert imported(f"{here}.brake.brake") == {f"{here}.brake.brake", f"{here}.brake.brake_parts",
                                               f"{here}.brake.pad_joints", f"{here}.brake.annulus",
                                               f"{here}.spring_mass.sensors", "pipeline.contract.errors"}


@pytest.mark.exact
@pytest.mark.parametrize("name", NULLS)
def test_at_its_null_nothing_is_hidden(name):
    for run in (SLIDING, REST):
        np.testing.assert_allclose(roots(made(**{name: NULLS[name]}), run), roots(made(), run), rtol=1e-6)


def test_every_piece_has_a_null_and_moves_the_roots():
    assert set(NULLS) == {*brake.HIDDEN, *brake.FOREIGN}
    for name, ends in {**brake.HIDDEN, **brake.FOREIGN}.items():
        where = {key: value for key, value in NULLS[name].items() if key in ("order", "sensor", "pad")}
        told = {key: high for key, (_, high) in ends.items()}
        run = replace(SLIDING, load=1500.0)
        one, other = roots(made(), run), roots(made(**{name: {**told, **where}}), run)
        moved = len(one) != len(other) or np.max(abs(one - other) / abs(one)) > 1e-4
        assert moved, name


@pytest.mark.exact
def test_a_lifted_pad_swings_on_its_abutment():
    """x'' m + c x' + k x = 0."""
    wanted = np.roots((brake_parts.PAD, brake_parts.ABUTMENT_LOSS, NOMINAL["abutment_outer"]))[0]
    assert np.min(abs(roots(made(), LIFTED) - wanted)) < 1e-6 * abs(wanted)


@pytest.mark.exact
@pytest.mark.parametrize("run", [REST, SLIDING], ids=lambda r: r.name)
def test_forces_balance(run):
    """Each lining carries the piston; the abutments, or what holds on at rest, carry the friction."""
    bench, half = made(), len(made().share) // 2
    place, press, _ = brake.pressed(bench, run)
    assert press[half:].sum() == pytest.approx(run.load + brake_parts.SEAL[0] * place[
        [bench.disc + 4, bench.disc + 6]].sum())
    if run.speed:
        x = place[[bench.disc, bench.disc + 3]]
        drawn = 0.35 * np.array((press[:half].sum(), press[half:].sum()))
        np.testing.assert_allclose(x * (NOMINAL["abutment_outer"], NOMINAL["abutment_inner"]), drawn, rtol=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("hidden", [{}, {"contact_stiffness_law": {"exponent": 0.5}},
                                    {"pressure_dependent_friction": {"exponent": -0.3}}], ids=lambda h: "".join(h))
def test_small_motions_are_the_slope_of_the_steady_states(hidden):
    """A slow push moves the brake as the stiffness of its small motions says: d q / d load = K^-1 press."""
    bench, step = made(**hidden), 0.1
    for run in (REST, SLIDING):
        more, less = (brake.pressed(bench, replace(run, load=run.load + s))[0] for s in (step, -step))
        size = len(bench.mass)
        stiffness = -bench.mass @ brake.small_motion(bench, run)[size:2 * size, :size]
        np.testing.assert_allclose(stiffness @ (more - less) / (2 * step), bench.press, atol=2e-5)


@pytest.mark.exact
def test_friction_has_the_slopes_that_it_tells():
    bench = made(falling_friction={"rise": 0.1, "decay_speed": 0.08}, pressure_dependent_friction={"exponent": -0.3})
    press, step = 700.0 * bench.share, 1e-6
    _, gain, drag = brake.friction(bench, SLIDING, press)

    def drawn(factor, faster):
        run = replace(SLIDING, speed=SLIDING.speed * faster)
        return brake.friction(bench, run, factor * press)[0] * factor * press

    np.testing.assert_allclose(gain, (drawn(1 + step, 1) - drawn(1 - step, 1)) / (2 * step * press), rtol=1e-6)
    slip = SLIDING.speed * bench.radius
    np.testing.assert_allclose(drag, (drawn(1, 1 + step) - drawn(1, 1 - step)) / (2 * step * slip), rtol=1e-5)


@pytest.mark.exact
def test_a_steeper_law_stiffens_with_the_load():
    """dN/da ~ N^(e / (1 + e)), and k where the piston has its reference force."""
    bench = made(contact_stiffness_law={"exponent": 0.5})
    _, press, slope = brake.pressed(bench, REST)
    np.testing.assert_allclose(slope, bench.share * NOMINAL["contact"] * (press / (700 * bench.share)) ** (1 / 3))
    assert slope.sum() / 2 == pytest.approx(NOMINAL["contact"], rel=0.02)


@pytest.mark.exact
def test_friction_that_lags_a_little_is_friction_at_a_later_place():
    """Roots move in proportion to a short memory."""
    base = roots(made())
    moved = [roots(made(contact_memory={"length": length})) - base for length in (1e-9, 2e-9)]
    np.testing.assert_allclose(moved[1], 2 * moved[0], atol=1e-3 * abs(moved[1]).max())


@pytest.mark.exact
def test_taps_are_the_exponential_of_the_small_motion(monkeypatch):
    """Velocities of the sensors by all modes against exp(A t) of the state after the blow."""
    monkeypatch.setattr(brake, "HIGHEST", 1e6)
    bench, blow, time = made(contact_memory={"length": 5e-6}), np.array((1e-3, 0.0, 2e-3)), 3e-3
    matrix, size = brake.small_motion(bench, SLIDING), len(bench.mass)
    state = np.zeros(len(matrix))
    state[size:2 * size] = np.linalg.solve(bench.mass, bench.taps.T @ blow)
    wanted = bench.sensors @ (expm(matrix * time) @ state)[size:2 * size]
    root, shape, kick = brake.vibrations(bench, SLIDING)
    shown = ((shape * (kick @ blow)[:, None]).T @ np.exp(root * time)).real
    np.testing.assert_allclose(shown, wanted, atol=1e-9 * abs(wanted).max())


def test_warm_discs_are_softer_run_by_run():
    warmth = [run.warmth for run in brake.campaign()]
    assert warmth[0] == 0 and warmth[-1] == 1 and len(warmth) == 9 and warmth == sorted(warmth)
    bench, last = made(heated_disc={"drop": 0.02}), replace(LIFTED, warmth=1.0)
    assert np.min(abs(roots(bench, last).imag / (np.sqrt(0.98) * roots(made(), LIFTED).imag[0]) - 1)) < 1e-3


def test_a_brake_that_squeals_or_lifts_off_is_no_case():
    steep = made(falling_friction={"rise": 2.0, "decay_speed": 0.05})
    with pytest.raises(ConvergenceError, match="does not squeal"):
        brake.record(steep, 1)
    with pytest.raises(ConvergenceError, match="touch all over"):
        brake.pressed(built({**NOMINAL, "friction": 1.5}, SHAPES[0]), SLIDING)


def test_a_campaign_is_recorded_twice_with_sensors_that_may_be_wrong(monkeypatch):
    monkeypatch.setattr(brake, "DURATION", 0.01)
    plain = brake.record(made(), 3)
    wrong = brake.record(made(sensor_gain={"error": 0.5, "channel": "accelerometer"},
                              sensor_delay={"delay": 1e-4, "channel": "laser_outer"}), 3)
    assert len(plain) == 18 and plain["rest_700N_2"]["repeat_of"] == "rest_700N_1"
    shown, other = (runs["lifted_1"]["channels"] for runs in (plain, wrong))
    assert set(shown) == set(brake.CHANNELS) and len(shown["laser_a"][0]) == 256
    np.testing.assert_array_equal(shown["laser_a"][0], other["laser_a"][0])
    loud = [np.std(runs["accelerometer"][0]) for runs in (shown, other)]
    assert loud[1] / loud[0] == pytest.approx(1.5, rel=0.01)
    assert np.corrcoef(shown["laser_outer"][0], other["laser_outer"][0])[0, 1] < 0.99
