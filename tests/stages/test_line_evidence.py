"""Stage line_evidence on a brake of a few elements: whose tones were heard, and who heard none."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError, store
from pipeline.products import Condition, Lines, Recording, Run
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.line_evidence import Settings, line_evidence
from stages.probability import Settings as Draws
from stages.probability import probability
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure
from tests.stages.two_processes import TwoProcesses
from tests.views.products_for_views import filled, noise_events

SOURCES = ({"kind": "joint_stiffness", "variation": 0.3}, {"kind": "friction", "variation": 0.1})
GIVEN = {"low": "500 Hz", "high": "8 kHz", "silent_up_to": "1.5 MPa", "constant_speed": "8 rad/s",
         "cycle_speed": "8 rad/s", "draws": 30, "sources": SOURCES}


def recording(*lines):
    """A Recording of a list of lines, read to 50 Hz."""
    listed = filled(Lines, label=[""] * len(lines), frequency=list(lines), frequency_tolerance=[50.0] * len(lines),
                    place="ring")
    return Recording(source=["a paper"],
                     runs={"bench": Run(description="squeal", repeat_of="", lines={"laser": listed})})


@pytest.fixture(scope="module")
def brake():
    model = reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))
    law = small_friction_map(0.5)
    settings = Modes(friction_steps=2, speeds=("8 rad/s",), frequency_max="8 kHz")
    return model, law, complex_modes(model, law, settings=settings)


def independent(count, sources, seed):
    """Scores of draws as the evidence takes them, each independent of the others."""
    random = np.random.default_rng(seed)
    return np.array([random.standard_normal(count) for _ in range(sources)]).T


@pytest.fixture(scope="module")
def drawn(brake):
    """The same draws of the whole brake."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("stages.probability.even_scores", independent)
        return probability(*brake, settings=Draws(draws=30, checked=0, sources=SOURCES))


@pytest.fixture(scope="module")
def tone(drawn):
    """Frequency, Hz, of the mode of the whole brake that most draws let grow."""
    frequency = drawn.root[drawn.pressure[drawn.root_operating] == 2e6].imag / (2 * np.pi)
    near = abs(frequency / frequency[:, None] - 1) < 0.01
    return float(frequency[np.argmax(near.sum(axis=1))])


@pytest.fixture(scope="module")
def made(brake, tone):
    return line_evidence(*brake, recording(tone), settings=Settings(**GIVEN))


def test_tones_are_the_unstable_modes_of_the_draws(drawn, made):
    """Those of stage probability at the loaded point, given the same values."""
    cycle = drawn.root[(drawn.pressure[drawn.root_operating] == 2e6)]
    tones = made.tone[made.tone_hypothesis == 1]
    assert len(tones) and all(abs(cycle.imag / (2 * np.pi) - f).min() < 0.01 * f for f in tones)
    np.testing.assert_array_equal(made.value[1][:, :2], drawn.value)


def test_a_line_at_a_tone_of_the_flexible_brake_is_evidence_for_it(made, tone):
    assert list(map(str, made.hypothesis)) == ["one_way", "flexible_disc", "unexplained"]
    np.testing.assert_allclose(made.line, tone)
    assert made.near[1, 0] > made.near[0, 0] and made.lines_alone[1] > made.lines_alone[0]
    np.testing.assert_allclose(made.weight.sum(axis=1), 1.0)


def test_the_cycle_is_run_at_constant_power(brake):
    model, law, modes = brake
    points = Settings(**{**GIVEN, "silent_up_to": "1.5 MPa", "cycle_speed": "6 rad/s", "draws": 20})
    made = line_evidence(model, law, modes, recording(3e3), settings=points)
    np.testing.assert_allclose(made.speed, [8.0, 6.0])
    assert [str(made.test[k]) for k in made.operating_test] == ["constant load", "cycle"]


#: settings for two recorded runs
OF_RUNS = Settings(**{**GIVEN, "draws": 20, "runs": ("low", "high")})


@pytest.fixture(scope="module")
def recorded(tone):
    """A Recording of a silent run at the low pressure and one with a line at the high one."""
    runs = {}
    for name, pressure, lines in (("low", 1e6, ()), ("high", 2e6, (tone,))):
        given = {"pressure": (pressure, "Pa"), "speed": (8.0, "rad/s")}
        runs[name] = replace(recording(*lines).runs["bench"], conditions={
            key: Condition(value=[value], time=[0.0], unit=unit) for key, (value, unit) in given.items()})
    return Recording(source=[], runs=runs)


@pytest.fixture(scope="module")
def listed(brake, recorded):
    return line_evidence(*brake, recorded, settings=OF_RUNS)


def test_recorded_runs_are_tests_at_their_own_operating_points(listed):
    assert [str(t) for t in listed.test] == ["low", "high"] and not len(listed.cycle_time)
    np.testing.assert_array_equal(listed.heard_in, [[0, 1]])
    np.testing.assert_allclose(listed.pressure, [1e6, 2e6])
    assert listed.lines_alone[1] > listed.lines_alone[0] and listed.near[1, 0] > listed.near[0, 0]


def test_squeal_found_in_records_weighs_as_a_list_of_it(brake, tone, recorded, listed):
    every = noise_events()
    events = replace(every, band=[500.0, 16e3], record_run=["low", "low", "high"], **{
        name: getattr(every, name)[2:3] for name in vars(every) if name.startswith("event_")})
    events = replace(events, event_frequency=[tone], event_lowest=[tone - 50.0], event_highest=[tone + 50.0])
    found = line_evidence(*brake, recorded, events, settings=OF_RUNS)
    np.testing.assert_array_equal(found.evidence, listed.evidence)
    np.testing.assert_array_equal(found.heard_in, [[0, 1]])


def test_the_number_of_workers_changes_no_bit(brake, made, tone):
    again = line_evidence(*brake, recording(tone), settings=Settings(**GIVEN), context=TwoProcesses())
    assert store.content_hash(again) == store.content_hash(made)


@pytest.mark.parametrize(("changed", "where"), [
    ({"high": "9 kHz"}, "line_evidence.high"), ({"low": "5 kHz"}, "line_evidence.low"),
    ({"silent_up_to": "3 MPa"}, "structure.pressures"), ({"list": "other"}, "line_evidence.list"),
    ({"disc": ("rotor",)}, "line_evidence.disc")])
def test_settings_that_do_not_fit_are_refused(brake, changed, where):
    with pytest.raises(ConfigError, match=where):
        line_evidence(*brake, recording(4e3), settings=Settings(**{**GIVEN, **changed}))


CHANGING = {"one_way": {"disc": "rigid"}, "other": {"disc": "flexible", "load_rate": "1 Hz"}}


@pytest.mark.parametrize(("changed", "where"), [
    ({"runs": ("bench",), "hypotheses": CHANGING}, "hypotheses"),
    ({"cycle": {"low": "3 MPa", "high": "1 MPa"}}, "cycle.high"),
    ({"sources": ({"kind": "friction_over_pressure", "variation": 0.01},)}, "sources"),
    ({"reference": "other"}, "reference"), ({"hypotheses": {"one_way": {"disc": "rigid"}}}, "hypotheses"),
    ({"heard": (0.5, 1.0)}, "heard"), ({"low": "9 kHz"}, "high")])
def test_contradictions_are_refused_before_anything_runs(changed, where):
    with pytest.raises(ConfigError, match=f"line_evidence.{where}"):
        line_evidence.check({"line_evidence": Settings(**{**GIVEN, **changed})})
