"""Recalibration: the linear motion is that of the integrator; other values leave nothing, another law leaves itself."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import drive, joint_laws
from pipeline.blind_trial.generators.switching.event_motion import Mechanism, moved
from pipeline.blind_trial.generators.switching.instruments import PARTS, Sensor
from pipeline.blind_trial.generators.switching.recalibration import Beginning, Recalibration, linear
from pipeline.blind_trial.generators.switching.rig import LAYOUTS, Rig

RIG = Rig((1.0, 1.5), LAYOUTS["row"], (4000.0, 3000.0), (2.0, 1.0))
RATE = 200.0
TIME = np.arange(301) / RATE
FINE = np.arange(PARTS * 300 + 1) / (RATE * PARTS)
SENSORS = (Sensor("ch1", 0, "displacement", "mm", 1e-3), Sensor("ch2", 1, "velocity", "mm/s", 1e-3))


def shaken():
    shape = drive.course(np.random.default_rng(1), "multisine", 4.0, 15.0, TIME[-1], RATE)
    return Beginning(FINE, TIME, drive.shaker(np.array([0.0, 1.0]), 1.0, shape), np.zeros(4))


def released():
    return Beginning(FINE, TIME, drive.still(np.array([1.0, 0.0])), np.array([1e-3, -5e-4, 0.02, 0.03]), "start")


def struck():
    return Beginning(FINE, TIME, drive.blow(np.array([1.0, 0.0]), 0.02, 0.1, 0.006), np.zeros(4), "blow")


@pytest.mark.exact
@pytest.mark.parametrize("begin", [shaken, released])
def test_the_motion_by_modes_is_that_of_the_integrator(begin):
    run = begin()
    exact = moved(Mechanism(*RIG.matrices(), (), 1e-3, 0.05), run.drive.pushing(FINE), FINE, run.start)
    shown = linear(RIG, run)
    for field in ("displacement", "velocity", "acceleration"):
        wanted = getattr(exact, field)
        np.testing.assert_allclose(getattr(shown, field), wanted, atol=3e-4 * abs(wanted).max())


def test_a_blow_of_another_width_is_not_told_from_what_is_unknown_of_it():
    run, wider = struck(), drive.blow(np.array([1.0, 0.0]), 0.022, 0.1, 0.009)
    base = [np.array([s.shown(linear(RIG, run), FINE, TIME) for s in SENSORS])]
    seen = [np.array([s.shown(linear(RIG, replace(run, drive=wider)), FINE, TIME) for s in SENSORS])]
    noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    assert Recalibration(RIG, SENSORS, (run,), (), base).left(seen, noise) < 2.0


def test_what_accelerations_and_velocities_show_of_a_blow_itself_tells_nothing():
    run = struck()
    sensors = (replace(SENSORS[0], quantity="acceleration"), SENSORS[1], SENSORS[0])
    base = [np.array([s.shown(linear(RIG, run), FINE, TIME) for s in sensors])]
    noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    fit, during = Recalibration(RIG, sensors, (run,), (), base), (TIME > 0.1) & (TIME < 0.106)
    for k, told in ((0, False), (1, False), (2, True)):
        seen = base[0].copy()
        seen[k, during] *= 3
        assert (fit.left([seen], noise) > 1) == told


@pytest.mark.exact
@pytest.mark.parametrize("width", [1e-4, 0.006])
def test_a_sampled_blow_has_its_impulse_however_short_it_is(width):
    run = Beginning(FINE, TIME, drive.blow(np.array([1.0, 0.0]), 0.02, 0.1, width), np.zeros(4), "blow")
    shown = linear(RIG, run)
    undamped = np.linalg.eigvalsh(RIG.matrices()[2]).max()
    at = np.searchsorted(FINE, 0.1 + width + 2 * (FINE[1] - FINE[0]))
    momentum = RIG.matrices()[0] @ shown.velocity[:, at]
    late = FINE[at] - 0.1 - width / 2
    assert momentum.sum() == pytest.approx(0.02, rel=undamped * late**2 + 2e-3)


def test_a_mass_on_a_single_spring_is_not_visible_behind_a_blow():
    """Other values of spring, damper and blow make the same motion, turns of phase away."""
    alone = Rig((1.0,), LAYOUTS["single"], (4000.0,), (2.0,))
    run = Beginning(FINE, TIME, drive.blow(np.array([1.0]), 0.02, 0.1, 0.006), np.zeros(2), "blow")
    seen = Sensor("ch1", 0, "velocity", "mm/s", 1e-3)
    base, heavier = ([np.array([seen.shown(linear(rig, run), FINE, TIME)])]
                     for rig in (alone, alone.with_values({"mass.0": 1.4})))
    noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    off = np.hypot(np.log(1.4) / 0.2, np.log(1.4) / 0.2)
    assert Recalibration(alone, (seen,), (run,), ("mass.0",), base).left(heavier, noise) == pytest.approx(off, abs=0.5)


def test_of_a_decay_more_of_the_damper_that_is_known_is_less_of_all_the_others():
    """Masses, springs and the other damper times 1 / 2.15: five values off, and nothing else."""
    run = released()
    damped = RIG.with_values({"damping.1": 2.15 * RIG.damping[1]})
    base, seen = ([np.array([s.shown(linear(rig, run), FINE, TIME) for s in SENSORS])] for rig in (RIG, damped))
    noise = 0.001 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    off = np.log(2.15) / 0.2 * np.sqrt(5)
    left = Recalibration(RIG, SENSORS, (run,), ("damping.1",), base).left(seen, noise)
    assert left == pytest.approx(off, rel=0.02)


def test_so_it_is_where_a_wall_is_moved():
    """Its displacement is what is known: it pulls by the spring that a refit tries."""
    shape = drive.course(np.random.default_rng(1), "multisine", 4.0, 15.0, TIME[-1], RATE)
    run = Beginning(FINE, TIME, drive.wall(RIG, 0, 1e-3, shape), np.zeros(4))
    damped = RIG.with_values({"damping.1": 2.15 * RIG.damping[1]})
    base, seen = ([np.array([s.shown(linear(rig, run), FINE, TIME) for s in SENSORS])] for rig in (RIG, damped))
    noise = 0.001 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    left = Recalibration(RIG, SENSORS, (run,), ("damping.1",), base).left(seen, noise)
    assert left == pytest.approx(np.log(2.15) / 0.2 * np.sqrt(5), rel=0.02)


@pytest.mark.parametrize("begin", [shaken, released, struck])
def test_other_values_leave_their_prior_alone_and_friction_more(begin):
    run = begin()
    base = [np.array([s.shown(linear(RIG, run), FINE, TIME) for s in SENSORS])]
    noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    fit = Recalibration(RIG, SENSORS, (run,), (), base)
    assert fit.left(base, noise) < 1e-6
    other = RIG.with_values({"stiffness.0": 4000.0 * np.exp(0.1), "mass.1": 1.5 * np.exp(-0.1)})
    off = [np.array([s.shown(linear(other, run), FINE, TIME) for s in SENSORS])]
    assert fit.left(off, noise) < 1.0
    length = np.sqrt(np.mean(linear(RIG, run).displacement[0] ** 2))
    spot = joint_laws.Spot(RIG.rows[0], length, 20 * length, 4000.0, (0.5,) * 3)
    rubbed = moved(Mechanism(*RIG.matrices(), joint_laws.coulomb(spot, 0.1), 1e-3, 0.05), run.drive.pushing(FINE), FINE,
                   run.start, run.drive.breaks)
    assert fit.left([np.array([s.shown(rubbed, FINE, TIME) for s in SENSORS])], noise) > 12
    assert fit.left([np.full_like(base[0], np.nan)], noise) == np.inf


def test_a_start_and_a_blow_are_free():
    for run, off in ((released(), np.array([2e-4, 1e-4, 0.0, 0.01])), (struck(), np.array([0.2, 0.004, 0.3]))):
        base = [np.array([s.shown(linear(RIG, run), FINE, TIME) for s in SENSORS])]
        noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
        moved_on = [np.array([s.shown(linear(RIG, run, off), FINE, TIME) for s in SENSORS])]
        assert Recalibration(RIG, SENSORS, (run,), (), base).left(moved_on, noise) < 1.0
        assert Recalibration(RIG, SENSORS, (replace(run, free=""),), (), base).left(moved_on, noise) > 10


def test_multiples_of_a_law_that_is_known_leave_nothing_of_it():
    run, random = shaken(), np.random.default_rng(3)
    base = [np.array([s.shown(linear(RIG, run), FINE, TIME) for s in SENSORS])]
    noise = 0.01 * np.sqrt(np.mean(base[0] ** 2, axis=1))
    law, other = (5 * noise[:, None] * random.standard_normal(base[0].shape) for _ in range(2))
    fit = Recalibration(RIG, SENSORS, (run,), (), base)
    assert fit.left([base[0] + 3 * law], noise, [[law]]) < 1.0
    both = fit.left([base[0] + 3 * law + other], noise, [[law], [2 * law]])
    assert both == pytest.approx(fit.left([base[0] + other], noise), rel=0.05)
