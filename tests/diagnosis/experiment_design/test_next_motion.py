"""Motions to measure next: forces that scale as their laws say, and the one that separates a tie of them."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.experiment_design.next_motion import planned_motions
from pipeline.diagnosis.experiment_design.next_run import altered
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.small_rig import effects, laid_out, model, recording
from tests.diagnosis.solving import diagnosis_product

PLAIN = {"forward": "equation", "equation": {"corner": "20 Hz"}}
TIED = {"noise": {"std": {"force on block": "14 N"}}, "parameters": {"joints.mount.stiffness": {"spread": 0.1}},
        "places": ["mount"], "effects": ["joint_damping", "quadratic_damping", "coulomb", "cubic_stiffness"]}


def rig():
    """(Bench, {name: Recorded}, section ``equation``), one run about the origin."""
    settings = laid_out(**PLAIN)
    runs = recorded(recording(noise=0.0, levels=(5.0,)), settings)
    return benches.built(model(), settings), runs, settings.equation


def planned(**given):
    """({name of what is changed: Planned}, Bench)."""
    bench, runs, equation = rig()
    return {p.name.partition(", as ")[0]: p for p in planned_motions(bench, runs, equation, given)}, bench


def added(one, bench, **hidden):
    """Force (n, m) that an effect at the mount adds to what a planned motion needs."""
    whole = with_effects(bench, effects({name: {"mount": values} for name, values in hidden.items()}))
    return one.shown.predicted(whole) - one.shown.predicted(bench)


@pytest.mark.exact
@pytest.mark.parametrize("hidden, size, pace", [
    ({"joint_damping": {"damping": "2 N s/m"}}, 1, 1), ({"quadratic_damping": {"coefficient": "3 N s^2/m^2"}}, 2, 2),
    ({"coulomb": {"force": "1 N"}}, 0, 0)])
def test_forces_scale_with_size_and_pace_as_their_laws_say(hidden, size, pace):
    motions, bench = planned(motion=[1, 0.5], pace=[0.5, 2])
    same = added(motions["motion x 1"], bench, **hidden)
    assert abs(same).max() > 0.1
    for name, factor in (("motion x 0.5", 0.5**size), ("pace x 0.5", 0.5**pace), ("pace x 2", 2.0**pace)):
        moved = added(motions[name], bench, **hidden)
        close = abs(moved - factor * same) < 1e-6 * abs(same).max()
        assert close.mean() > (0.95 if "coulomb" in hidden else 0.999), "dry friction is smoothed about rest"


@pytest.mark.exact
def test_the_nominal_bench_needs_what_the_inputs_give_and_another_mass_more():
    motions, bench = planned(pace=[0.5], **{"masses.block": [3.0]})
    slow, heavy = motions["pace x 0.5"], motions["masses.block x 3"]
    inner = slice(100, -100)    # beyond the ends of the filter, which cases trim
    np.testing.assert_allclose(slow.shown.predicted(bench)[:, inner], slow.shown.seen.samples[:, inner], atol=1e-9)
    inertia = heavy.shown.motion(bench)[1].acceleration
    more = heavy.shown.predicted(altered(bench, heavy.altered)) - heavy.shown.seen.samples
    np.testing.assert_allclose(more[:, inner], 2.0 * inertia[:, inner], rtol=1e-6, atol=1e-9)


def test_without_a_section_motions_stay_within_the_recorded_ones():
    bench, runs, equation = rig()
    names = [p.name for p in planned_motions(bench, runs, equation, {})]
    assert names == [f"{what} x {f:g}, as level_1" for what in ("motion", "pace") for f in (0.5, 0.25)]


@pytest.mark.parametrize("given, said", [
    ({"pace": ["2 m/s"]}, "diagnosis.next.pace: expected factors above 0"),
    ({"motion": [-1.0]}, "diagnosis.next.motion"), ({"shaker": ["2 N"]}, "inputs are what the motion takes"),
    ({"colour": [2.0]}, "diagnosis.next.colour")])
def test_what_no_motion_has_is_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        planned(**given)


def told(**more):
    """Product Diagnosis of a mount of quadratic damping, under so much noise of force that linear damping does."""
    settings = laid_out(forward="equation", equation={"corner": "20 Hz", "decimation": 4, "trim": 60})
    hidden = {"quadratic_damping": {"mount": {"coefficient": "4 N s^2/m^2"}}}
    runs = recorded(recording(hidden, noise=1e-5, levels=(5.0, 5.0, 5.0)), settings)
    section = fill(Settings, {**TIED, **more}, "d")
    return diagnosis_product(force_balance_problem(benches.built(model(), settings), runs, section, settings.equation))


def test_a_tie_of_two_dampings_asks_for_another_motion():
    """Both are the larger the faster it moves: half the pace of what was recorded tells less than twice its size."""
    within, beyond = told(), told(next={"motion": [0.5, 2.0]})
    for found in (within, beyond):
        assert found.verdict == "tie" and set(found.next_separates) == {"quadratic_damping at mount",
                                                                       "joint_damping at mount"}
    assert within.next_condition[0].startswith("pace x 0.5, as level_")
    assert beyond.next_condition[0].startswith("motion x 2, as level_") and beyond.next_value > within.next_value > 0
