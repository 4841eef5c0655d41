"""Stages by substitution: what was measured in place of what is modelled, where that is wrong and where it is right."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.case_models import corrections
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis import forced_response
from pipeline.diagnosis.problem import Nowhere
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.substitution import AXIS, MeasuredShapes, Substituted, measured_law, substituted, swaps
from pipeline.inference.fitting.fit_state import linearised
from pipeline.products import MeasuredFriction, MeasuredModes
from pipeline.products import Run as RunProduct
from tests.diagnosis import pin_rig, two_masses

LOADS = (1.5, 3.0, 5.0)
HIDDEN = {"pressure_dependent_friction": {"contact": {"exponent": 0.2, "pressure": "5 Pa"}}}


def curve(hidden):
    """MeasuredFriction of the pin rig at three pressures: 0.45 (p / 5 Pa)^-0.2, or 0.45."""
    pressure = np.array(LOADS)
    return MeasuredFriction(friction=0.45 * (pressure / 5.0) ** (-0.2 if hidden else 0.0), friction_std=np.zeros(3),
                            pressure=pressure, speed=np.full(3, 1e-3), distance=np.zeros(3),
                            temperature=np.full(3, 293.0))


def modes(bench):
    """MeasuredModes of a Bench without contacts."""
    mass, damping, stiffness = bench.model.supported()
    squared, shape = eigh(stiffness, mass)
    rate = np.sqrt(squared)
    ratio = np.array([shape[:, k] @ damping @ shape[:, k] / (2 * w) for k, w in enumerate(rate)])
    rows = np.array([bench.sensor(name) for name in bench.model.sensor_name])
    return MeasuredModes(frequency=rate / (2 * np.pi), frequency_std=0 * rate, damping_ratio=ratio,
                         damping_ratio_std=0 * rate, place=list(bench.model.sensor_name), shape=(rows @ shape).T + 0j)


def holding(recording, **kinds):
    """The Recording with one more run that holds measured friction or modes."""
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "lines", "topography", "friction")}
    own = RunProduct(description="", repeat_of="", **{**empty, **{kind: {"it": one} for kind, one in kinds.items()}})
    return replace(recording, runs={**recording.runs, "before": own})


def axis(recording, bench, runs, asked):
    """The axis ``substitution`` about the nominal values."""
    settings = fill(Settings, {"solver": False, "draws": 2000, **asked}, "d")
    question = substituted(forced_response.forced_problem(bench, runs, settings), recording, settings)
    problem, noises = question.problem, [question.budget[run.name] for run in question.problem.training]
    null = linearised(problem, noises, problem.nominal, problem.nominal.nominal, problem.training)
    return replace(question.locator, axes=Nowhere()).located(SimpleNamespace(recalibrated=null))[AXIS]


@pytest.mark.parametrize("hidden", [True, False])
def test_a_measured_curve_takes_away_what_friction_lacks_and_nothing_else(hidden):
    told = holding(pin_rig.recording(LOADS, (8e-4, 1e-3, 6e-4), HIDDEN if hidden else None),
                   friction=curve(hidden))
    location, *_ = axis(told, pin_rig.bench(), recorded(told, pin_rig.laid_out()), {
        "noise": {"std": {"friction": "50 mN"}}, "effects": ["viscous"],
        "parameters": {"friction": {"spread": 0.2}}})
    assert location.items == ("friction",) and (location.p_value[0] < 0.01) == hidden


@pytest.mark.parametrize("hidden, wrong", [({}, True), ({"cubic_stiffness": {"coupling": {"coefficient": "3e5 N/m^3"}}},
                                                       False)])
def test_measured_modes_take_away_what_the_structure_lacks(hidden, wrong):
    """A coupling 10 % stiffer that nobody took for doubtful; a cubic spring whose small motion is as modelled."""
    nominal = two_masses.built()
    bench = corrections.corrected(nominal, {"joints.coupling.stiffness": 550.0 / 1.21 if wrong else 500.0})
    told = holding(two_masses.recording(hidden), modes=modes(nominal))
    location, *_ = axis(told, bench, recorded(told, two_masses.LAID), two_masses.ASKED)
    assert location.items == ("structure",) and (location.p_value[0] < 0.01) == wrong


@pytest.mark.exact
def test_measured_modes_in_place_of_others_are_those_of_the_bench_that_has_them():
    """Modes of a bench of softer joints of all kinds alike: its stiffness, and by its ratios its damping, come back."""
    bench = two_masses.built()
    softer = replace(bench, model=replace(bench.model, joints=replace(
        bench.model.joints, stiffness=0.81 * bench.model.joints.stiffness, damping=0.5 * bench.model.joints.damping)))
    changed = MeasuredShapes((modes(softer),)).applied(bench)
    _, damping, stiffness = changed.model.supported()
    np.testing.assert_allclose(stiffness, softer.model.supported()[2], rtol=1e-9, atol=1e-9)
    shape = eigh(stiffness, changed.model.mass)[1]
    np.testing.assert_allclose(np.diag(shape.T @ damping @ shape),
                               np.diag(shape.T @ softer.model.supported()[1] @ shape), rtol=1e-9)
    same = MeasuredShapes((modes(bench),)).applied(bench)
    np.testing.assert_allclose(same.model.supported()[2], bench.model.supported()[2], rtol=1e-12)


@pytest.mark.exact
def test_a_measured_curve_is_read_where_it_was_measured_and_nearest_else():
    one = MeasuredFriction(friction=[0.4, 0.6, 0.3, 0.2], friction_std=np.zeros(4), pressure=[1e5, 1e5, 1e5, 2e5],
                           speed=[1.0, 1.0, 2.0, 1.0], distance=np.zeros(4), temperature=np.full(4, 293.0))
    law = measured_law([one])
    assert law.evaluate([1e5, 1e5, 2e5], [1.0, 2.0, 1.0], 0.0)[0] == pytest.approx([0.5, 0.3, 0.2])
    assert law.evaluate(2e5, 2.0, 0.0)[0] in (0.2, 0.3)


def test_without_measured_quantities_there_is_no_axis():
    told = two_masses.recording({})
    settings = fill(Settings, two_masses.ASKED, "d")
    asked = forced_response.forced_problem(two_masses.built(), recorded(told, two_masses.LAID), settings)
    assert substituted(asked, told, settings) is asked and not isinstance(asked.locator, Substituted)
    assert swaps(holding(told, friction=curve(False)), two_masses.built()) == {}, "nothing rubs there"
    assert swaps(holding(told, modes=modes(two_masses.built())), two_masses.built(), held_out=("before",)) == {}
