"""Recorded runs in the form of a bench, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.corrections import corrected
from pipeline.case_models.runs import check_units, recorded
from pipeline.case_models.virtual_rig import built
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.effects import named
from pipeline.physics.virtual_rig.inputs import run_inputs
from pipeline.physics.virtual_rig.response import respond
from pipeline.products import Condition
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis import pin_rig
from tests.diagnosis.small_rig import LUMPED, RATE, SAMPLES, force, laid_out, recording


def test_inputs_samples_and_conditions_arrive():
    one = recorded(recording(), laid_out())["level_2"]
    assert one.run.samples == SAMPLES and one.run.sample_rate == RATE and one.channels == ("x",)
    np.testing.assert_allclose(one.run.inputs["shaker"], force(5.0, 1))
    assert one.run.conditions == {"level": 5.0} and one.valid.all()


def test_missing_samples_are_masked():
    found = recording()
    run = found.runs["level_1"]
    gap = replace(run.channels["x"], missing=np.array([[3, 5]]))
    runs = {"level_1": replace(run, channels={**run.channels, "x": gap})}
    one = recorded(replace(found, runs=runs), laid_out())["level_1"]
    assert np.flatnonzero(~one.valid[0]).tolist() == [3, 4]


def test_channels_that_begin_apart_are_refused():
    found = recording()
    run = found.runs["level_1"]
    late = replace(run.channels["x"], begin=np.array(float(run.channels["x"].begin) + 3.0))
    with pytest.raises(ConfigError, match="run level_1: expected channels that begin at one instant, found 0 s to 3 s"):
        recorded(replace(found, runs={"level_1": replace(run, channels={**run.channels, "x": late})}), laid_out())


@pytest.mark.parametrize("more, said", [
    ({"channels": {"y": {"quantity": "displacement", "source": "block"}}}, "bench.channels"),
    ({"inputs": {"shaker": {"channel": "forc"}}}, "bench.inputs.shaker.channel")])
def test_channels_that_were_not_recorded_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        recorded(recording(), laid_out(**more))


def test_units_must_fit_what_a_channel_shows():
    settings = laid_out(channels={"x": {"quantity": "velocity", "source": "block"}})
    with pytest.raises(ConfigError, match="m/s"):
        check_units(recorded(recording(), settings), settings)


def test_a_stated_gain_of_one_is_a_gain():
    with pytest.raises(ConfigError, match="m/s, because it shows velocity"):
        recorded(recording(), laid_out(channels={"x": {"quantity": "velocity", "source": "block"}}))
    stated = {"quantity": "velocity", "source": "block", "gain": 1.0}
    assert recorded(recording(), laid_out(channels={"x": stated}))["level_1"].channels == ("x",)


def test_an_angle_shows_a_rotation_at_one_metre():
    """Metres at a radius of 1 m are radians; at 30 mm, or along x, an angle is refused."""
    found = recording(levels=(2.0,))
    run = found.runs["level_1"]
    turned = replace(found, runs={"level_1": replace(run, channels={
        **run.channels, "x": replace(run.channels["x"], unit="rad")})})
    for along, fits in (({"rotor.rotation": "1 m"}, True), ({"rotor.rotation": "30 mm"}, False),
                        ({"rotor.x": 1}, False)):
        parts = {"masses": {"rotor": {"mass": "1 kg", "inertia": "1 kg m^2", "moves": ["x", "rotation"]}},
                 "inputs": {"shaker": {"along": {"rotor.x": 1}, "force": "1 N"}}, "springs": {},
                 "sensors": {"block": {"along": along}}}
        reduced = reduced_model(lumped(settings=fill(LumpedSettings, parts, "lumped")), settings=ReductionSettings())
        if fits:
            assert recorded(turned, laid_out(), reduced)["level_1"].unit == ("rad",)
        else:
            with pytest.raises(ConfigError, match="a recorded unit of m, because it shows displacement"):
                recorded(turned, laid_out(), reduced)


@pytest.mark.parametrize("name, unit, said", [("speed", "Hz", "rad/s or m/s"), ("normal_load", "Pa", "in N")])
def test_units_of_conditions_are_those_of_what_they_set(name, unit, said):
    found = recording(levels=(2.0,))
    run = found.runs["level_1"]
    given = replace(run, conditions={name: Condition(value=[1.0], time=[0.0], unit=unit)})
    with pytest.raises(ConfigError, match=said):
        recorded(replace(found, runs={"level_1": given}), laid_out())


def fed(given, unit="N", **more):
    """Run of the rig with another input, fed with its force channel in another unit."""
    lumps = fill(LumpedSettings, {**LUMPED, "inputs": {"shaker": given}}, "lumped")
    reduced = reduced_model(lumped(settings=lumps), settings=ReductionSettings())
    found = recording(levels=(2.0,))
    run = found.runs["level_1"]
    changed = replace(run, channels={**run.channels, "force": replace(run.channels["force"], unit=unit)})
    settings = laid_out(inputs={"shaker": {"channel": "force", **more}})
    runs = recorded(replace(found, runs={"level_1": changed}), settings, reduced)
    return built(reduced, settings), runs["level_1"].run


@pytest.mark.exact
@pytest.mark.parametrize("unit, gain", [("N", {}), ("1", {}), ("V", {"gain": 1.0})])
def test_a_channel_counts_times_the_force_that_the_case_states(unit, gain):
    """10 N per unit of the channel, and not 1 N."""
    bench, run = fed({"along": {"block.x": 1}, "force": "10 N"}, unit=unit, **gain)
    np.testing.assert_allclose(run_inputs(bench, run)[0], 10 * force(2.0, 0))


@pytest.mark.exact
def test_a_recorded_torque_turns_an_arm_and_an_angle_its_far_end():
    """J t'' + c t' + k t = T, or c u' + k u, steady: torque recorded in N m, angles in rad."""
    angular, arm = 2 * np.pi * 2.0, (0.5, 3.0, 90.0)
    share = 1 / (arm[2] - arm[0] * angular**2 + 1j * arm[1] * angular)
    for given, unit, push in (({"along": {"arm.rotation": 1}, "torque": "1 N m"}, "N m", 1.0),
                              ({"displaces": "bar", "angle": "1 rad"}, "rad", arm[2] + 1j * arm[1] * angular)):
        bench, run = turned(given, unit)
        time = np.arange(8001) / 400
        run = replace(run, duration=time[-1], sample_rate=400.0, inputs={"motor": 0.2 * np.sin(angular * time)})
        late, exact = time > 18, 0.2 * np.imag(push * share * np.exp(1j * angular * time))
        assert abs(respond(bench, run)["x"] - exact)[late].max() < 2e-3 * abs(exact).max()
        with pytest.raises(ConfigError, match=f"{unit} or 1, because it feeds"):
            turned(given, "N" if unit == "N m" else "m")


def turned(given, unit):
    """(Bench, Run) of an arm whose torque or far end is a recorded channel, and whose angle is recorded in rad."""
    parts = {"masses": {"arm": {"moves": ["rotation"], "inertia": "0.5 kg m^2"}},
             "springs": {"bar": {"between": ["arm.rotation", "ground"], "torsional_stiffness": "90 N m/rad",
                                 "torsional_damping": "3 N m s/rad"}},
             "inputs": {"motor": given}, "sensors": {"arm": {"along": {"arm.rotation": 1}}}}
    reduced = reduced_model(lumped(settings=fill(LumpedSettings, parts, "lumped")), settings=ReductionSettings())
    run = recording(levels=(2.0,)).runs["level_1"]
    channels = {"x": replace(run.channels["x"], unit="rad"), "force": replace(run.channels["force"], unit=unit)}
    settings = laid_out(inputs={"motor": {"channel": "force"}},
                        channels={"x": {"quantity": "displacement", "source": "arm"}})
    runs = recorded(replace(recording(), runs={"level_1": replace(run, channels=channels)}), settings, reduced)
    return built(reduced, settings), runs["level_1"].run


@pytest.mark.parametrize("given, unit, said", [
    ({"along": {"block.x": 1}, "force": "1 N"}, "V", "N or 1, because it feeds a force"),
    ({"displaces": "mount", "displacement": "1 m"}, "N", "m or 1, because it feeds a displacement")])
def test_units_must_fit_what_a_channel_feeds(given, unit, said):
    with pytest.raises(ConfigError, match=said):
        fed(given, unit=unit)


@pytest.mark.exact
def test_a_measured_base_motion_moves_the_oscillator():
    """m x'' + c x' + k x = c u' + k u to u = U sin(w t), steady: error of order 2 over the samples, also after k has
    been corrected."""
    angular, errors = 2 * np.pi * 2.5, []
    for stiffness in (400.0, 500.0):
        gain = (stiffness + 1.2j * angular) / (stiffness - angular**2 + 1.2j * angular)
        for rate in (100.0, 200.0):
            time = np.arange(round(40 * rate) + 1) / rate
            bench, run = fed({"displaces": "mount", "displacement": "2 mm"}, unit="1")
            run = replace(run, duration=time[-1], sample_rate=rate, inputs={"shaker": 2e-3 * np.sin(angular * time)})
            bench = corrected(bench, {"joints.mount.stiffness": stiffness})
            late = time > 35
            exact = 2e-3 * np.imag(gain * np.exp(1j * angular * time[late]))
            errors.append(abs(respond(bench, run)["x"][late] - exact).max() / abs(exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1) and errors[1] < 1e-3
    assert errors[2] / errors[3] == pytest.approx(4, rel=0.1) and errors[3] < 1e-3


def test_a_channel_that_moves_an_end_counts_in_metres_times_the_stated_displacement():
    bench, run = fed({"displaces": "mount", "displacement": "2 m"}, unit="m")
    np.testing.assert_allclose(run.inputs["shaker"], 2 * force(2.0, 0))
    with pytest.raises(ConfigError, match="linear or band_limited, because its joint has a damper"):
        run_inputs(bench, replace(run, held=("shaker",)))
    with pytest.raises(ConfigError, match="a joint whose far end stands still"):
        named("coulomb").on(bench, "mount", {"force": 1.0})
    undamped = corrected(bench, {"joints.mount.damping": 0.0})
    np.testing.assert_allclose(run_inputs(undamped, replace(run, held=("shaker",)))[0], 800 * force(2.0, 0))


def test_the_begin_of_a_run_may_be_left_out():
    one = recorded(recording(), laid_out(settle="0.1 s"))["level_1"]
    assert np.flatnonzero(~one.valid[0]).tolist() == list(range(int(0.1 * RATE)))


def test_held_inputs_keep_their_samples_and_a_held_drive_is_refused():
    run = recorded(recording(), laid_out(inputs={"shaker": {"channel": "force", "hold": "step"}}))["level_2"].run
    assert run.held == ("shaker",)
    np.testing.assert_array_equal(run.inputs["shaker"], force(5.0, 1))
    with pytest.raises(ConfigError, match="bench.drive.hold"):
        recorded(recording(), laid_out(drive={"channel": "force", "hold": "step", "gain": 1.0}))


def test_band_limited_inputs_keep_their_samples_until_they_are_run():
    wired = {"shaker": {"channel": "force", "hold": "band_limited"}}
    run = recorded(recording(), laid_out(inputs=wired))["level_2"].run
    assert run.band_limited == ("shaker",) and run.held == ()
    np.testing.assert_array_equal(run.inputs["shaker"], force(5.0, 1))


def test_a_recorded_position_drives_by_its_rate_of_change():
    found = pin_rig.recording((5.0,), (4e-4,))
    run = found.runs["run_1"]
    moved = run.channels["position"]
    lost = replace(moved, missing=np.array([[60, 61]]), samples=np.where(np.arange(pin_rig.SAMPLES) == 60, 0.0,
                                                                         moved.samples))
    gappy = replace(found, runs={"run_1": replace(run, channels={**run.channels, "position": lost})})
    time = np.arange(pin_rig.SAMPLES) / pin_rig.RATE
    whole, patched = (recorded(r, pin_rig.laid_out())["run_1"].run.drive for r in (found, gappy))
    speed = 4e-4 * np.pi * pin_rig.FREQUENCY * np.cos(2 * np.pi * pin_rig.FREQUENCY * time)
    np.testing.assert_allclose(whole[1:-1], speed[1:-1], atol=2e-3 * speed.max())
    np.testing.assert_allclose(patched[1:-1], speed[1:-1], atol=0.03 * speed.max())


SPRING = {**LUMPED, "springs": {"mount": {"between": ["block.x", "ground"], "stiffness": "400 N/m"}},
          "inputs": {"shaker": {"displaces": "mount", "displacement": "1 m"}}}
SLIDE_HOLD_SLIDE = {"at": ["0.5 s", "2 s", "3 s"], "speed": ["2 mm/s", "0 mm/s", "10 mm/s"]}


def led_rig(courses, lumps=SPRING, **more):
    """(Bench, {name: Recorded}) of a block whose mount is led through ``courses`` {run: section}."""
    reduced = reduced_model(lumped(settings=fill(LumpedSettings, lumps, "lumped")), settings=ReductionSettings())
    settings = laid_out(**{"inputs": {}, "courses": {"shaker": courses}, "channels": {
        "x": {"quantity": "displacement", "source": "block"}, "force": {"quantity": "joint_force", "source": "mount"}}
    } | more)
    return built(reduced, settings), recorded(recording(), settings, reduced)


@pytest.mark.exact
def test_speeds_lead_the_end_of_a_spring():
    """Slide, hold, slide: m x'' + k (x - u) = 0, u = V t in pieces; the spring draws with k (x - u)."""
    bench, runs = led_rig({"level_1": SLIDE_HOLD_SLIDE})
    run, angular = runs["level_1"].run, np.sqrt(400.0)
    since = np.maximum(run.time[:, None] - [0.5, 2.0, 3.0], 0.0)
    speeds = np.array([2e-3, -2e-3, 1e-2])
    np.testing.assert_allclose(run.inputs["shaker"], since @ speeds, atol=1e-15)
    exact = (since - np.sin(angular * since) / angular) @ speeds
    shown = respond(bench, run)
    np.testing.assert_allclose(shown["x"], exact, atol=1e-10)
    np.testing.assert_allclose(shown["force"], 400.0 * (exact - since @ speeds), atol=1e-7)
    assert "shaker" not in runs["level_2"].run.inputs


FORCED = {**LUMPED, "inputs": {"shaker": {"along": {"block.x": 1}, "force": "1 N"}}}
SLACK = {**SPRING, "springs": {"mount": {"between": ["block.x", "ground"], "damping": "1 N s/m"}}}


@pytest.mark.parametrize("courses, more, said", [
    ({"level_1": SLIDE_HOLD_SLIDE}, {"lumps": FORCED}, "shaker: expected an input that displaces a spring.*a force"),
    ({"level_1": SLIDE_HOLD_SLIDE}, {"lumps": SLACK}, "stiffness of the machine.*found no stiffness of mount"),
    ({"level_9": SLIDE_HOLD_SLIDE}, {}, "of the runs level_1, .*found level_9"),
    ({"level_1": {"at": ["1 s", "0 s"], "speed": ["0 m/s", "1 m/s"]}}, {}, r"shaker.level_1: expected rising instants"),
    ({"level_1": {"at": ["1 s"], "speed": ["0 m/s", "1 m/s"]}}, {}, "found 1 and 2"),
    ({"level_1": SLIDE_HOLD_SLIDE}, {"inputs": {"shaker": {"channel": "force", "gain": 1.0}}}, "no recorded channel")])
def test_courses_that_cannot_be_are_refused(courses, more, said):
    with pytest.raises(ConfigError, match=said):
        led_rig(courses, **more)
