"""Recorded stops find their condition by measured or stated pressure and speed, and their bands by what they squeal."""

from types import SimpleNamespace

import numpy as np

from pipeline.case_models.noise_matrix.recorded_stops import recorded_stops
from pipeline.case_models.noise_matrix.sampling import Bands
from pipeline.case_models.noise_matrix.schedule import Condition
from pipeline.physics.stability.draws.draw_statistics import third_octaves
from pipeline.products import Channel, NoiseEvents, Recording, Run
from pipeline.products import Condition as Stated
from tests.views.products_for_views import filled

BANDS = Bands(third_octaves(2e3, 16e3), 2e3, 16e3, 0.0, 1e-6)
SETTINGS = SimpleNamespace(within=0.2, wheel_radius=0.3)
CONDITIONS = (Condition("drag", 5e5, 3 / 3.6, 3 / 3.6), Condition("drag", 1e6, 3 / 3.6, 3 / 3.6),
              Condition("drag", 5e5, -3 / 3.6, -3 / 3.6), Condition("stop", 1e6, 50 / 3.6, 0.0))
SLOW, FAST = 3 / 3.6 / 0.3, 50 / 3.6 / 0.3


def stated(pressure=None, speed=None, **channels):
    """A Run of stated conditions and measured channels {name: (samples, unit)}."""
    given = {"pressure": (pressure, "Pa"), "speed": (speed, "rad/s")}
    conditions = {name: Stated(value=[value], time=[0.0], unit=unit) for name, (value, unit) in given.items()
                  if value is not None}
    return Run(description="", repeat_of="", conditions=conditions, channels={
        name: filled(Channel, samples=samples, unit=unit, measures=measures, rate=100.0, begin=0.0, place="",
                     position=[], direction=[], role="response", missing=np.empty((0, 2), int))
        for name, (samples, unit, measures) in channels.items()})


def found(runs, squeal):
    """Stops of {name: Run}; ``squeal`` {name: frequency}."""
    names = list(runs)
    rows = [(names.index(name), f) for name, f in squeal.items()]
    events = filled(NoiseEvents, record_run=names, record_channel=["mic"] * len(names),
                    record_kind=["sound"] * len(names), event_record=[r for r, _ in rows],
                    event_frequency=[f for _, f in rows], event_kind=["squeal"] * len(rows))
    return recorded_stops(Recording(source=["a"], runs=runs), events, CONDITIONS, BANDS, SETTINGS)


def test_stated_and_measured_stops_find_their_condition():
    ramp, braked = np.linspace(FAST, 0.0, 500), np.where(np.arange(500) < 60, 0.0, 1.05e6)
    made = found({
        "stated": stated(5.4e5, SLOW), "reverse": stated(5e5, -SLOW),
        "measured": stated(pressure=None, p=(braked, "Pa", "pressure"),
                           w=(np.full(500, SLOW), "rad/s", "angular_velocity")),
        "stop": stated(1e6, None, w=(ramp, "rad/s", "speed")), "far": stated(2.5e6, SLOW),
        "fast": stated(5e5, FAST), "unknown": stated(5e5)}, {"stop": 4e3, "stated": 1.9e3})
    assert made.run == ("stated", "reverse", "measured", "stop", "far", "fast", "unknown")
    np.testing.assert_array_equal(made.condition, [0, 2, 1, 3, -1, -1, -1])
    assert made.reason[4] == "no condition is near a drag at 3 km/h and 25 bar"
    assert made.reason[5] == "no condition is near a drag at 50 km/h and 5 bar"
    assert made.reason[6] == "its speed is neither measured nor stated"
    np.testing.assert_array_equal(made.noisy.any(axis=1), [False, False, False, True, False, False, False])
    assert BANDS.middle[made.noisy[3]].round() == [3981]


def test_a_speed_in_metres_a_second_is_that_of_the_vehicle():
    slow, ramp = stated(5e5), np.linspace(50 / 3.6, 0.0, 500)
    slow.conditions["speed"] = Stated(value=[3 / 3.6], time=[0.0], unit="m/s")
    made = found({"stated": slow, "stop": stated(1e6, None, v=(ramp, "m/s", "speed")),
                  "vibration": stated(1e6, None, v=(ramp, "m/s", "velocity"))}, {})
    np.testing.assert_array_equal(made.condition, [0, 3, -1])


def test_the_nearest_of_two_conditions_counts():
    made = found({"low": stated(5.9e5, SLOW), "between": stated(7.1e5, SLOW), "high": stated(8.5e5, SLOW)}, {})
    np.testing.assert_array_equal(made.condition, [0, -1, 1])
