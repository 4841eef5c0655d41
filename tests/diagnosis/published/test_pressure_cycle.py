"""A cycle of pressure: what grows in it, when, and how far, against closed forms and direct solutions."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import family
from pipeline.diagnosis.published.pressure_cycle import Cycle, cycle_fields, faded, no_cycle, swellings
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import whole_roots
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure

CYCLE = Cycle(low="1 MPa", high="3 MPa", speed="6 rad/s", phases=8, temperatures=("293 K", "493 K"))


def roots(growth, frequency=3e3):
    """One growing root in each phase with growth above 0."""
    return [np.array([g + 2j * np.pi * frequency]) if g > 0 else np.empty(0, complex) for g in growth]


@pytest.mark.exact
def test_a_mode_that_grows_over_half_a_sine_rises_by_its_integral():
    """int max(0, s sin wt) dt over a period T is s T / pi."""
    time = (np.arange(400) + 0.5) / 400 * 2.0
    swell, = swellings(roots(30 * np.sin(np.pi * time)), 2.0, 0.01)
    assert swell.rise == pytest.approx(60 / np.pi, rel=1e-4) and swell.phases == 200 and swell.first == 0
    assert swell.frequency == pytest.approx(3e3) and swell.growth == pytest.approx(30, rel=1e-4)


@pytest.mark.exact
def test_a_stretch_runs_on_from_the_end_of_a_cycle_to_its_begin():
    swell, = swellings(roots([5, 5, 0, 0, 0, 0, 7, 7]), 0.8, 0.01)
    assert (swell.first, swell.phases) == (6, 4) and swell.rise == pytest.approx(2.4)
    always, = swellings(roots([2.0] * 8), 0.8, 0.01)
    assert (always.first, always.phases) == (0, 8) and always.rise == pytest.approx(1.6)


def test_modes_at_other_frequencies_and_after_a_break_swell_by_themselves():
    low, high = roots([5, 0, 5, 5, 0, 0]), roots([0, 9, 0, 0, 0, 0], 9e3)
    made = swellings([np.append(a, b) for a, b in zip(low, high, strict=True)], 0.6, 0.01)
    assert [s.phases for s in made] == [2, 1, 1] and sorted(s.frequency for s in made) == pytest.approx([3e3, 3e3, 9e3])
    assert not swellings(roots([0.0] * 4), 1.0, 0.01)


@pytest.mark.exact
def test_pressure_is_a_sine_and_friction_fades_with_temperature():
    assert CYCLE.pressure.mean() == pytest.approx(2e6) and 2.9e6 < CYCLE.pressure.max() < 3e6
    np.testing.assert_allclose(CYCLE.time[[0, -1]], [0.125, 1.875])
    assert CYCLE.share(293.0) == 1 and CYCLE.share(493.0) == pytest.approx(1 / 1.1)


@pytest.fixture(scope="module")
def brake():
    model = reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))
    law = small_friction_map(0.6)
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("8 rad/s",), frequency_max="8 kHz"))
    return model, family(model, -1, law, StabilitySettings.of(modes))


def test_a_phase_has_the_roots_of_its_pressure_and_speed(brake):
    model, case = brake
    made = cycle_fields(CYCLE, case, model.input_area, [(1, -1, NOMINAL)], (np.array([1e6]), np.array([8.0])), 8e3,
                        0.01, lambda function, tasks, label: list(map(function, tasks)))
    assert set(made) == set(no_cycle()) and made["cycle_friction"] == [1.0, pytest.approx(1 / 1.1)]
    first, phase = made["cycle_root_cycle"] == 0, made["cycle_root_phase"][0]
    own = first & (made["cycle_root_phase"] == phase)
    pressure, speed = CYCLE.pressure[phase], CYCLE.speed * 3e6 / CYCLE.pressure[phase]
    direct = whole_roots(replace(case, input_force=pressure * model.input_area), NOMINAL, speed, 8e3)
    np.testing.assert_allclose(made["cycle_root"][own], direct[direct.real > 0], rtol=1e-9)
    assert own.any()
    still = made["still_root"][made["still_root_cycle"] == 0]
    direct = whole_roots(replace(case, input_force=1e6 * model.input_area), NOMINAL, 8.0, 8e3)
    np.testing.assert_allclose(still, direct[direct.real > 0], rtol=1e-9)


@pytest.mark.exact
def test_a_share_of_friction_is_a_share_of_its_slopes_too(brake):
    model, case = brake
    pressure, speed = np.full(3, 1.5e6), np.full(3, 1.0)
    whole, half = case.friction(pressure, speed), faded(case, case.input_force, 0.5).friction(pressure, speed)
    for name in ("coefficient", "pressure_slope", "speed_slope"):
        np.testing.assert_allclose(getattr(half, name), 0.5 * getattr(whole, name))
