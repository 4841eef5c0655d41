"""Stage orders on stops whose speed falls evenly."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import Recording, Run
from pipeline.recordings.samples import channel
from stages.orders import Settings, orders
from tests.physics.signals.orders.ramp import FIRST, LAST, RATE, SLOW, TURNS, T, order

NOISE = 0.05 * np.random.default_rng(1).standard_normal(len(T))


def run(speed=SLOW, unit="rad/s", measures="angular_velocity", begin=0.0, **more):
    channels = {"torque": channel(20.0 * order(2.0) + NOISE + 400.0, "N m", "torque", RATE, 2.0, "torque"),
                "line": channel(1e6 + 0 * SLOW, "Pa", "pressure", 20.0, 2.0, "line"),
                "shaft": channel(speed, unit, measures, 20.0, 2.0 + begin, "shaft")}
    return Run(description="", repeat_of="", channels=channels | more)


def found(recording, told=None, **settings):
    context = SimpleNamespace(remark=([] if told is None else told).append,
                              map=lambda f, items, _: [f(i) for i in items])
    return orders(recording, settings=Settings(**settings), context=context).spectra


@pytest.fixture(scope="module")
def result():
    told = []
    spectra = found(Recording(source=[], runs={"stop": run(), "drag": run(speed=0 * SLOW + 30.0)}), told)
    return spectra, told


@pytest.mark.exact
def test_the_torque_has_its_second_order_over_the_speed(result):
    (name, one), = result[0].items()
    assert name == "stop.torque" and str(one.shaft) == "shaft" and str(one.unit) == "N m"
    assert one.outstanding == pytest.approx([2.0], abs=0.02)
    assert one.sure.tolist() == [1]
    np.testing.assert_allclose(one.level[0][one.blocks > 0], 20.0, rtol=0.01)
    assert one.edge[0] == pytest.approx(LAST) and one.edge[-1] == pytest.approx(FIRST) and one.time[0] > 2.0
    peak = one.frequency[one.campbell.argmax(axis=1)]
    middle = (one.edge[1:] + one.edge[:-1]) / 2
    used = one.frames > 0
    np.testing.assert_allclose(peak[used], 2 * middle[used] / (2 * np.pi), atol=2.1)


def test_what_has_no_orders_says_why(result):
    told = "; ".join(result[1])
    assert "drag: the speed shaft varies by less than 0.2" in told
    assert "stop, line: no orders: its rate of 20 Hz is too low" in told
    assert not found(Recording(source=[], runs={"a": Run(description="", repeat_of="")}))
    short = channel(order(2.0)[:4000], "m", "displacement", RATE, 2.0, "x")
    late = channel(order(2.0)[:12000], "m", "displacement", RATE, 20.6, "y")
    told = []
    made = found(Recording(source=[], runs={"stop": run(x=short, y=late)}), told, channels=["x", "y"])
    assert not made and "shorter than two frames" in told[0] and "no 8 revolutions" in told[1]


def test_the_speed_may_be_named_and_given_in_revolutions_per_second():
    told = Recording(source=[], runs={"stop": run(SLOW / (2 * np.pi), "Hz", "frequency")})
    assert not found(told)
    assert found(told, shaft="shaft")["stop.torque"].outstanding == pytest.approx([2.0], abs=0.02)


def test_channels_that_are_not_there_or_do_not_turn_are_refused():
    recording = Recording(source=[], runs={"stop": run()})
    with pytest.raises(ConfigError, match="orders.shaft: expected channels of the recording: .*, found wheel"):
        found(recording, shaft="wheel")
    with pytest.raises(ConfigError, match="orders.shaft: expected a channel in rpm, rad/s or Hz, found torque in N m"):
        found(recording, shaft="torque")
    with pytest.raises(ConfigError, match="orders.channels: expected channels"):
        found(recording, channels=["pad"])


def test_a_slow_record_tells_fewer_orders():
    slow = channel(order(2.0)[::16], "m/s^2", "acceleration", RATE / 16, 2.0, "pad")
    one = found(Recording(source=[], runs={"stop": run(pad=slow)}), channels=["pad"])["stop.pad"]
    assert one.order[-1] == 4.0 and one.outstanding == pytest.approx([2.0], abs=0.02)


def test_the_speed_may_come_from_the_pulses_of_a_tacho():
    pulses = channel(5.0 * (np.sin(2 * np.pi * 6 * TURNS) > 0), "V", "voltage", RATE, 2.0, "tacho")
    bare = run(tacho=pulses).channels
    bare = {name: one for name, one in bare.items() if name != "shaft"}
    recording = Recording(source=[], runs={"stop": Run(description="", repeat_of="", channels=bare)})
    one = found(recording, shaft="tacho", pulses=6)["stop.torque"]
    assert one.outstanding == pytest.approx([2.0], abs=0.02) and one.edge[-1] == pytest.approx(FIRST, rel=0.05)
    np.testing.assert_allclose(one.level[0][one.blocks > 0], 20.0, rtol=0.01)
    with pytest.raises(ConfigError, match="orders.shaft: expected the channel of the pulses"):
        orders.check({"orders": Settings(pulses=6)})
    told = []
    assert not found(recording, told, shaft="torque", pulses=1, channels=["line"]) and told


def test_missing_teeth_are_told_on_the_terminal_and_in_the_product():
    toothed = 5.0 * ((np.sin(2 * np.pi * 12 * TURNS) > 0) & ((12 * TURNS) % 12 < 10))
    bare = run(tacho=channel(toothed, "V", "voltage", RATE, 2.0, "tacho")).channels
    bare = {name: one for name, one in bare.items() if name != "shaft"}
    told = []
    made = found(Recording(source=[], runs={"stop": Run(description="", repeat_of="", channels=bare)}), told,
                 shaft="tacho", pulses=10)
    assert "a wheel of 12 teeth of which 2 are missing" in str(made["stop.torque"].remark)
    assert any("stop, tacho: a wheel of 12 teeth" in line for line in told)
    assert made["stop.torque"].outstanding == pytest.approx([2.0], abs=0.02)


def test_orders_of_an_overloaded_channel_may_be_clipping():
    """A tone of the second order that is cut off has the sixth and the tenth, which no shaft makes."""
    cut = channel(np.clip(20.0 * order(2.0) + NOISE, -12.0, 12.0), "m/s^2", "acceleration", RATE, 2.0, "pad")
    context = SimpleNamespace(remark=[].append, map=lambda f, items, _: [f(i) for i in items])
    made = orders(Recording(source=[], runs={"stop": run(pad=cut)}), settings=Settings(), context=context)
    (told,) = (remark for remark in made.remarks if "overloaded" in remark)
    assert told.startswith("stop, pad: ") and "harmonics may come from clipping" in told
    assert sorted(made.spectra["stop.pad"].outstanding)[:3] == pytest.approx([2.0, 6.0, 10.0], abs=0.05)
