"""Friction between a few runs: exact at the runs, exact scalings, and close to full runs anywhere between."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.rough.pair import Settings, rubbing
from pipeline.physics.friction.state_variables import Film
from pipeline.physics.rough.layered_solid import graded_depth, layered_compliance
from pipeline.physics.rough.sliding_pair import Drag, slide
from pipeline.physics.rough.spot_table import RATIOS, friction, mean_wear, spot_table
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface
from tests.effects.rough_pair import CYCLES, LENGTH, NODES, PAD
from tests.effects.rough_pair import rubbing as small

SPEEDS, STEPS = np.array([1.0, 1.3, 1.6]), (0, 1, 2, 4)
PRESSURES = np.geomspace(1e6, 4e6, 4)


@pytest.fixture(scope="module")
def table():
    return spot_table([small()], PRESSURES, STEPS, SPEEDS, map)


def drag(pressure, cycles=STEPS, step=2e-3):
    """A Drag that visits every speed after each of the cycles."""
    return Drag(pressure, np.tile(SPEEDS, len(cycles)), np.repeat(np.array(cycles) * step, len(SPEEDS)))


def full(pair, pressure, cycles=STEPS):
    """Friction (cycles x speeds,) of a full run."""
    return slide(pair, pressure, SPEEDS, list(cycles)).friction.T.ravel()


def disc(pair, coefficient):
    return replace(pair, wearing=replace(pair.wearing, disc_coefficient=coefficient))


@pytest.mark.exact
@pytest.mark.parametrize("pressure", PRESSURES[[0, 2]])
@pytest.mark.parametrize("ratio", RATIOS)
def test_at_its_runs_the_table_is_the_run(table, pressure, ratio):
    """But that the table takes the mean heating of a pass before the softening, the run after it."""
    pair = disc(small(), ratio * PAD)
    np.testing.assert_allclose(friction(table, pair, drag(pressure)), full(pair, pressure), rtol=1e-4)


@pytest.mark.exact
def test_a_softer_pair_is_one_under_more_pressure():
    """Both moduli over 1.3: spots as at 1.3 P, pressed 1 / 1.3 as hard, so that they wear as much slower."""
    base = small()
    spacing = (LENGTH / NODES,) * 2
    solids = [layered_compliance((NODES, NODES), spacing, graded_depth(spacing[0], LENGTH, 1.5), modulus / 1.3, nu)
              for modulus, nu in ((0.3e9, 0.25), (110e9, 0.26))]
    softer = replace(base, pair=replace(base.pair, compliance=solids[0] + solids[1]))
    stiff = replace(base, wearing=replace(base.wearing, distance=base.wearing.distance / 1.3))
    one, other = slide(softer, 2e6, SPEEDS, [0, CYCLES]), slide(stiff, 2.6e6, SPEEDS, [0, CYCLES])
    np.testing.assert_allclose(one.real_area, other.real_area, rtol=1e-9)
    np.testing.assert_allclose(one.friction, 1.3 * other.friction, rtol=1e-4)


@pytest.mark.exact
def test_mean_wear_is_that_of_the_run():
    record = slide(disc(small(), -0.6 * PAD), 2e6, SPEEDS, [0, CYCLES])
    pad, gained = mean_wear(disc(small(), -0.6 * PAD), drag(2e6))
    assert record.maps.pad_wear[-1].mean() == pytest.approx(pad, rel=1e-12)
    assert record.maps.disc_wear[-1].mean() == pytest.approx(gained, rel=1e-9)


def test_laws_of_the_limit_need_no_new_contact(table):
    changed = replace(small().shearing, film=Film(0.4, 3e-3, 2e6), pressure_coefficient=0.1)
    pair = replace(disc(small(), RATIOS[1] * PAD), shearing=changed)
    np.testing.assert_allclose(friction(table, pair, drag(PRESSURES[1])), full(pair, PRESSURES[1]), rtol=2e-4)


def test_between_speeds_and_beyond_the_runs_it_goes_on(table):
    first, last = (Drag(p, np.array([1.15]), np.array([s])) for p, s in ((0.9e6, 1e-3), (4.5e6, 9e-3)))
    assert 0 < friction(table, small(), first)[0] < 2 and 0 < friction(table, small(), last)[0] < 2
    ends = friction(table, small(), replace(first, speed=np.array([1.0, 1.3]), distance=np.full(2, 1e-3)))
    assert min(ends) < friction(table, small(), first)[0] < max(ends)


def test_realisations_tell_what_values_cannot_take_up():
    shifted = [replace(small(), pair=replace(small().pair, pad_height=np.roll(small().pair.pad_height, k, 1)))
               for k in (0, 7, 13)]
    several = spot_table(shifted, PRESSURES, STEPS, SPEEDS[:1], map)
    spread = np.log([spot_table([one], PRESSURES, STEPS, SPEEDS[:1], map).area for one in shifted])
    assert 0 < several.scatter < spread.std(axis=0, ddof=1).max() / np.sqrt(3)
    assert spot_table(shifted[:1], PRESSURES, STEPS, SPEEDS[:1], map).scatter == 0.0


@pytest.mark.slow
def test_full_runs_of_a_case_are_met_within_half_the_stated_model_error():
    """64 nodes, 60 cycles, eight pressures: other values and effects of wear, root mean square over all points."""
    rough, section = surface(settings=SurfaceSettings(nodes=64)), Settings(cycles=60, realisations=1)
    base, cycles, off = rubbing(rough, section), (0, 10, 30, 60), []
    table = spot_table([base], np.geomspace(0.45e6, 5.5e6, 8), (0, 3, 8, 15, 25, 40, 60, 80, 100), SPEEDS, map)
    stiffer = section.model_copy(update={"pad": section.pad.model_copy(update={"youngs_modulus": 1.3 * 0.235e9})})
    changes = [(rubbing(rough, stiffer), 1 / 1.3), (disc(base, -0.5 * 4e-12), 1.0),
               (replace(base, wearing=replace(base.wearing, exponent=0.5, pad_coefficient=5e-12)), 1.0)]
    for pair, softer in changes:
        for pressure in (1e6, 2.2e6, 3.4e6):
            found = friction(table, pair, drag(pressure, cycles, base.wearing.distance), softer)
            off.append(found / full(pair, pressure, cycles) - 1)
    assert np.sqrt(np.mean(np.square(off))) < 0.01
