"""Records to make next on a self-excited bench: points nobody recorded, and the one that separates a tie."""

from functools import cache

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.experiment_design.next_features import planned_records
from pipeline.diagnosis.features.poles import features
from pipeline.diagnosis.self_excited import pole_problem
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.small_bench import bench, laid_out, recorded
from tests.diagnosis.solving import diagnosis_product
from tests.diagnosis.test_self_excited import ASKED


@pytest.fixture(scope="module")
def seen():
    return features(bench(), recorded(bench()), laid_out().poles)


def names(seen, **given):
    return [record.name for record in planned_records(bench(), seen, given)]


def test_recorded_loads_meet_recorded_speeds(seen):
    """Recorded: at rest under 10 N, sliding under 5 and 10 N at 0.5 rad/s, 10 N at 2 rad/s, a turn under 10 N."""
    found = {name for name in names(seen) if "turn" not in name}
    assert found == {"hammer at rest, press = 5 N", "growth phase, press = 5 N, speed = 2 rad/s"}


def test_beside_one_load_and_one_speed_half_and_twice(seen):
    found = names({"slow_10": seen["slow_10"]})
    assert found == [f"growth phase, press = {load} N, speed = {speed} rad/s" for speed in (0.25, 0.5, 1)
                     for load in (5, 10, 20) if (load, speed) != (10, 0.5)]


def test_a_section_changes_one_thing_of_each_kind_that_has_it(seen):
    assert names(seen, press=["20 N"], speed=[3.0]) == [
        "hammer at rest, press = 20 N", "growth phase, press = 20 N", "slow turn, press = 20 N",
        "growth phase, speed x 3", "slow turn, speed x 3"]
    heavy, = planned_records(bench(), {"slow_10": seen["slow_10"]}, {"press": ["20 N"]})
    assert heavy.shown.run.inputs == {"press": 20.0} and heavy.like == "slow_10" and not heavy.altered
    stiff, = planned_records(bench(), {"slow_10": seen["slow_10"]}, {"joints.arm.stiffness": [2.0]})
    assert stiff.altered == {"joints.arm.stiffness": (2.0, True)}
    with pytest.raises(ConfigError, match="diagnosis.next.colour"):
        names(seen, colour=[1.0])


@cache
def told(*runs):
    """Product Diagnosis of growth with falling friction in ``runs`` alone."""
    made = recorded(bench({"falling_friction": {"contact": {"rise": 0.8, "decay_speed": "0.1 m/s"}}}))
    kept = {name: one for name, one in made.items() if name.removesuffix("_again") in runs}
    given = fill(Settings, {**ASKED, "effects": ["falling_friction", "joint_damping", "pressure_dependent_friction"]},
                 "d")
    asked = pole_problem(bench(), kept, given, laid_out().poles)
    return diagnosis_product(asked, kept=3, draws=2000, starts=(-1.0, 1.0))


def test_growth_at_one_point_asks_for_another_speed_and_load():
    """One growth phase explains, and names nothing: at another speed falling friction grows otherwise."""
    found = told("slow_10")
    assert found.verdict == "tie" and [str(found.effect[k]) for k in found.named] == ["falling_friction"]
    condition, = found.next_condition
    assert condition.startswith("growth phase, press = ") and not condition.endswith("speed = 0.5 rad/s")
    assert "falling_friction at contact" in found.next_separates and found.next_value > 0


def test_where_nothing_is_tied_nothing_is_asked():
    found = told("lifted", "rest", "slow_10")
    assert found.verdict == "missing" and not len(found.next_condition) and found.next_value == 0
