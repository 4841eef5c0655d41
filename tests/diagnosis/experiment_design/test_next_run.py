"""What to record next: feasible runs, and the one that separates a tie of micro-slip and a compliant arm."""

import numpy as np
import pytest

from pipeline.case_models import corrections
from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.experiment_design.next_run import altered, changed, feasible
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.physics.virtual_rig.half_sine import HalfSine
from pipeline.physics.virtual_rig.response import Run
from tests.diagnosis import small_rig
from tests.diagnosis.pin_rig import MICRO_SLIP, bench, laid_out, recording
from tests.diagnosis.solving import diagnosis_product

RIVALS = {"compliant_arm at arm", "micro_slip at contact"}
KNOWN = {"prior": "half_normal", "std": "20 um/N"}
ASKED = {"parameters": {"friction": {"spread": 0.2}}, "noise": {"std": {"friction": "50 mN"}}, "solver": False,
         "effects": ["compliant_arm", "micro_slip", "viscous", "directional_friction"], "kept": 2,
         "priors": {"compliant_arm.compliance": KNOWN, "micro_slip.compliance": KNOWN},
         "next": {"normal_load": ["5 N", "2 N"], "joints.arm.stiffness": [1]}, "held_out": ["run_4"]}
STROKES = (4e-4, 5e-4, 3.5e-4, 4.5e-4)


def told(loads):
    """Product Diagnosis of the rig with micro-slip under ``loads`` of its four runs."""
    runs = recorded(recording(loads, STROKES, MICRO_SLIP), laid_out())
    return diagnosis_product(forced_problem(bench(), runs, fill(Settings, ASKED, "diagnosis")))


@pytest.mark.slow
@pytest.mark.study
def test_under_one_load_micro_slip_and_a_compliant_arm_tie_and_another_load_is_next():
    found = told((5.0, 5.0, 5.0, 5.0))
    assert found.verdict == "tie" and {str(found.hypothesis[k]) for k in found.named} == RIVALS
    assert list(found.next_condition) == ["normal_load = 2 N"] and set(found.next_separates) == RIVALS
    assert found.next_value > 10


@pytest.mark.slow
@pytest.mark.study
def test_under_two_loads_micro_slip_is_named():
    found = told((5.0, 2.0, 5.0, 2.0))
    assert found.verdict == "missing" and [str(found.hypothesis[k]) for k in found.named] == ["micro_slip at contact"]
    values = dict(zip(found.parameter, found.parameter_value, strict=True))
    assert values["micro_slip@contact.compliance"] == pytest.approx(1.5e-5, rel=0.05)
    assert len(found.next_condition) == 0 and found.next_value == 0


def plain(**given):
    return feasible(bench(), given, recorded(recording((5.0,), (4e-4,)), laid_out())["run_1"])


def test_a_run_differs_by_one_thing_from_the_recorded_one():
    slow, heavy, double, stiff = plain(drive=[0.1], normal_load=["2 N", 2.0], **{"joints.arm.stiffness": [5.0]})
    recorded_drive = stiff.run.drive
    np.testing.assert_allclose(slow.run.drive, 0.1 * recorded_drive)
    assert (heavy.run.conditions, double.run.conditions) == ({"normal_load": 2.0}, {"normal_load": 10.0})
    np.testing.assert_array_equal(heavy.run.drive, recorded_drive)
    assert [f.observed.name for f in (slow, heavy, double, stiff)] == [
        "drive x 0.1", "normal_load = 2 N", "normal_load x 2", "joints.arm.stiffness x 5"]
    other = altered(bench(), stiff.altered)
    assert corrections.nominal(other, "joints.arm.stiffness") == 5e5


def test_a_value_with_a_unit_takes_the_place_of_a_number():
    stiff, = plain(**{"joints.arm.stiffness": ["20 N/mm"]})
    assert corrections.nominal(altered(bench(), stiff.altered), "joints.arm.stiffness") == 2e4


def test_a_blow_may_be_twice_as_hard():
    pulse = HalfSine(0.9, 0.5, 0.05)
    harder, _ = changed(benches.built(small_rig.model(), small_rig.laid_out(inputs={})),
                        Run("a", 2.0, 64.0, pulses={"shaker": pulse}), "shaker", 2.0, "diagnosis.next.shaker")
    np.testing.assert_array_equal(harder.inputs["shaker"], 2 * pulse.force(harder.samples, 64.0))
    assert not harder.pulses


@pytest.mark.parametrize("given, said", [
    ({"temperature": ["20 K"]}, "diagnosis.next.temperature: expected one of drive, normal_load"),
    ({"drive": ["1 rad/s"]}, "diagnosis.next.drive"), ({"normal_load": ["2 kg"]}, "diagnosis.next.normal_load")])
def test_what_a_bench_cannot_change_is_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        plain(**given)
