"""Stage noise_matrix on a brake whose squeal is known in closed form, and on one of a few elements."""

import csv
from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError, store
from pipeline.contract.settings import fill
from pipeline.products import Condition, FrictionOverTemperature, NoiseEvents, Recording, Run
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.noise_matrix import Settings, companions, noise_matrix
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.flutter_rig import ONSET, flutter_rig
from tests.stages.small_structure import small_friction_map, small_structure
from tests.stages.two_processes import TwoProcesses
from tests.views.products_for_views import filled

MODULES = [{"module": "drags", "kind": "drag", "direction": "both", "speeds": ["3 km/h"], "pressures": ["1 Pa"],
            "temperatures": ["50 degC", "100 degC"]},
           {"module": "stops", "kind": "stop", "speeds": ["50 km/h"], "pressures": ["2 Pa"]}]
SPEED = 3 / 3.6 / 0.31


def settings(**more):
    """Settings of the flutter rig: friction alone scatters, from stop to stop."""
    given = {"modules": MODULES, "draws": 40, "repeats": 1, "points": 1, "training": 1, "checked": 2,
             "sources": [{"kind": "friction", "variation": 0.1}]}
    return fill(Settings, {**given, **more}, "case.yaml: noise_matrix")


def bench(noisy, silent):
    """(Recording, NoiseEvents) of drags at 1 Pa and 3 km/h, the first ``noisy`` of which squeal at 5.4 kHz."""
    names = [f"stop_{k}" for k in range(noisy + silent)]
    conditions = {"pressure": Condition(value=[1.0], time=[0.0], unit="Pa"),
                  "speed": Condition(value=[SPEED], time=[0.0], unit="rad/s")}
    events = filled(NoiseEvents, record_run=names, record_channel=["mic"] * len(names), event_kind=["squeal"] * noisy,
                    record_kind=["sound"] * len(names), event_record=np.arange(noisy),
                    event_frequency=np.full(noisy, 5.4e3), event_level=np.full(noisy, 80.0))
    return Recording(source=["a"], runs={name: Run(description="", repeat_of="", conditions=conditions)
                                         for name in names}), events


@pytest.fixture(scope="module")
def rig():
    return flutter_rig(0.4)


@pytest.mark.exact
def test_the_probability_is_that_of_the_friction_above_the_onset(rig):
    """Normal friction of mean 0.4 and deviation 0.1 squeals above the onset in forward direction, in reverse never."""
    model, modes = rig
    made = noise_matrix(model, None, modes, settings=settings(draws=150, checked=0))
    exact = scipy.stats.norm.cdf((0.4 - ONSET) / 0.1)
    for k, speed in enumerate(made.speed):
        low, high = made.interval[k]
        assert low < exact < high if speed > 0 else made.probability[k] == 0
    assert made.module_occurrence[0] == pytest.approx(made.probability[made.speed > 0][0] / 2)
    tone = made.band[np.argmax(made.band_occurrence)]
    assert tone == pytest.approx(abs(modes.unstable_root[0]) / (2 * np.pi), rel=0.12)
    np.testing.assert_array_equal(made.noisy.mean(axis=0), made.probability)


@pytest.mark.exact
@pytest.mark.parametrize("friction, certain", [(0.9 * ONSET, 0.0), (1.1 * ONSET, 1.0)])
def test_without_scatter_every_stop_is_noisy_or_none(friction, certain):
    model, modes = flutter_rig(friction)
    still = [{"kind": "friction", "variation": 1e-9}]
    made = noise_matrix(model, None, modes, settings=settings(draws=3, sources=still))
    np.testing.assert_array_equal(made.probability, np.where(made.speed > 0, certain, 0.0))
    assert made.missed == 0 and made.refined_changed == 0 and made.refined_stops == 2


def test_the_bench_is_compared_with_the_draws(rig):
    model, modes = rig
    agrees = noise_matrix(model, None, modes, *bench(8, 2), settings=settings(repeats=2))
    assert agrees.condition_stops.sum() == 10 and agrees.condition_noisy.sum() == 8
    assert not agrees.condition_difference.any() and agrees.all_difference == 0 and agrees.tests == 3
    silent = noise_matrix(model, None, modes, *bench(0, 10), settings=settings(repeats=2))
    assert silent.condition_difference.max() == 1 and silent.all_difference == 1
    assert silent.condition_expected[silent.condition_stops > 0] == pytest.approx(10 * silent.probability[0])


def test_the_table_has_a_row_for_every_condition(rig):
    model, modes = rig
    made = noise_matrix(model, None, modes, *bench(0, 10), settings=settings())
    head, *rows = csv.reader(companions(made)["noise_matrix.csv"].splitlines())
    assert len(rows) == 3 and {len(row) for row in rows} == {len(head)} == {16 + len(made.band)}
    forward = dict(zip(head, rows[0], strict=True))
    assert forward["recorded stops"] == "10" and forward["noisy"] == "0" and forward["applications"] == "2"
    assert float(forward["probability"]) == pytest.approx(made.probability[0])


SOURCES = [{"kind": "joint_stiffness", "variation": 0.3}, {"kind": "damping_speed", "range": [0.3, 3]},
           {"kind": "friction", "variation": 0.2}]
BRAKE = {"modules": [{**MODULES[0], "pressures": ["15 bar"], "temperatures": ["50 degC"]},
                     {**MODULES[1], "pressures": ["15 bar"]}],
         "draws": 4, "repeats": 2, "points": 1, "checked": 2, "training": 2, "sources": SOURCES}


@pytest.fixture(scope="module")
def brake():
    model, law = reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz")), small_friction_map(0.45)
    return model, law, complex_modes(model, law, settings=Modes(friction_steps=2, frequency_max="8 kHz"))


@pytest.mark.slow
def test_the_number_of_workers_changes_no_bit_and_draws_agree_with_the_whole_model(brake):
    one = noise_matrix(*brake, settings=settings(**BRAKE))
    two = noise_matrix(*brake, settings=settings(**BRAKE), context=TwoProcesses())
    assert store.content_hash(one) == store.content_hash(two)
    assert one.checked_draws == 2 and one.missed == 0 and one.limits[1] == 8e3
    np.testing.assert_allclose(one.checked_root.imag, one.whole_root.imag, rtol=5e-3)
    assert 0 < one.occurrence < 1 and one.value.shape == (8, 3)
    np.testing.assert_array_equal(one.source_varies, [0, 1, 1])


def test_where_friction_softens_a_warm_disc_squeals_less(brake):
    """Friction of the map at 20 degC is 0.6, and nothing is left of it 100 K above that."""
    model, law, modes = brake
    soft = FrictionOverTemperature(temperature=[100.0], friction=np.full((1, 2, 2, 2), 1e-3))
    law = replace(law, friction=np.full((2, 2, 2), 0.6), over_temperature={"bodies": soft})
    drags = {**MODULES[0], "direction": "forward", "pressures": ["15 bar"], "temperatures": ["20 degC", "120 degC"]}
    made = noise_matrix(model, law, modes, settings=settings(
        modules=[drags], draws=10, checked=0, sources=SOURCES[:2], lowest_frequency="500 Hz"))
    np.testing.assert_allclose(made.temperature, [293.15, 393.15])
    assert made.probability[0] > 0.3 and made.probability[1] == 0


@pytest.mark.parametrize("given, said", [
    ({"varying": ["frction"]}, "noise_matrix.varying"),
    ({"lowest_frequency": "20 kHz"}, "noise_matrix.lowest_frequency"),
    ({"sources": [{"kind": "friction"}, {"kind": "friction"}]}, "noise_matrix.sources"),
    ({"modules": [{**MODULES[1], "ends": "60 km/h"}]}, "stops.ends"),
])
def test_what_cannot_be_is_refused_before_anything_is_computed(given, said):
    with pytest.raises(ConfigError, match=said):
        noise_matrix.check({"noise_matrix": settings(**given)})
