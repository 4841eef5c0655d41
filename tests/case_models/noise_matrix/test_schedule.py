"""Schedules: counts of modules, conditions, what is public of the built-in ones and where their values come from."""

import numpy as np
import pytest

from pipeline.case_models.noise_matrix import schedule as of
from pipeline.case_models.noise_matrix.schedule import Module, NamedSchedule, schedule
from pipeline.contract import ConfigError, Section, option
from pipeline.contract.documents import read_yaml, yaml_text
from pipeline.contract.settings import ORIGINS, fill


class Case(Section):
    """A case with a schedule."""

    schedule: NamedSchedule = option("j2521", "schedule")
    modules: tuple[Module, ...] = option((), "modules")


def planned(**given):
    case = fill(Case, given, "case.yaml: noise_matrix")
    return schedule(case.schedule, case.modules)


DRAGS = {"module": "drags", "kind": "drag", "direction": "both", "speeds": ["3 km/h", "10 km/h"],
         "pressures": ["5 bar", "20 bar"], "temperatures": ["50 degC", "-5 degC", "100 degC"], "count": 2}
STOPS = {"module": "stops", "kind": "stop", "speeds": ["50 km/h"], "ends": "10 km/h", "pressures": ["20 bar"]}


@pytest.mark.exact
def test_applications_are_the_products_of_what_a_module_lists():
    made = planned(modules=[DRAGS, STOPS])
    assert [m.applications for m in made.modules] == [2 * 2 * 2 * 3 * 2, 1]
    np.testing.assert_array_equal(made.applications.sum(axis=1), [48, 1])
    assert len(made.conditions) == 9 and not any(c.temperature for c in made.conditions)
    assert made.modules[0].temperatures == pytest.approx((323.15, 268.15, 373.15))
    stop = made.conditions[-1]
    np.testing.assert_allclose(3.6 * stop.speeds(4), [45, 35, 25, 15])
    np.testing.assert_allclose(3.6 * made.conditions[0].speeds(4), [3])


def test_where_temperature_acts_it_makes_conditions():
    case = fill(Case, {"modules": [DRAGS]}, "case")
    made = schedule(case.schedule, case.modules, temperature_acts=True)
    assert len(made.conditions) == 24 and made.applications.sum() == 48
    assert {c.temperature for c in made.conditions} == set(case.modules[0].temperatures)


def test_modules_that_share_a_condition_keep_their_counts():
    made = planned(modules=[{**DRAGS, "direction": "forward"}, {**DRAGS, "module": "again", "count": 1}])
    forward = [c.speed > 0 for c in made.conditions]
    np.testing.assert_array_equal(made.applications[:, forward], [[6] * 4, [3] * 4])
    assert made.applications[0, ~np.array(forward)].sum() == 0


@pytest.mark.parametrize("name", ["j2521", "j3211"])
def test_every_value_of_a_built_in_schedule_says_where_it_comes_from(name):
    document = read_yaml(of.Path(of.__file__).parent / f"{name}.yaml")
    for module in document["modules"]:
        for key, value in module.items():
            if key != "module":
                assert value["origin"] in ORIGINS and value["source"], f"{name}: {module['module']}.{key}"
                assert value["origin"] != "stated" or key in ("kind", "direction"), "no value of the standard was read"
    assert planned(schedule=name).not_available


@pytest.mark.published
def test_j2521_states_its_public_counts_and_does_not_claim_to_hold_them():
    made = planned(schedule="j2521")
    assert (made.published.sections, made.published.applications) == (25, 1917)
    assert made.applications.sum() == sum(m.applications for m in made.modules) < 1917
    assert "counts" in made.not_available and made.title.startswith("in the manner of")


def test_of_j3211_no_count_is_public():
    made = planned(schedule="j3211")
    assert not made.published.sections and not made.published.applications
    assert made.not_available.startswith("Every value")


@pytest.mark.parametrize("given, said", [
    ({"modules": [DRAGS, DRAGS]}, "modules of different names"),
    ({"modules": [{**STOPS, "ends": "60 km/h"}]}, "stops.ends"),
    ({"modules": [{**STOPS, "speeds": ["50 kmh"]}]}, "50 kmh"),
    ({"schedule": "j2512"}, "j2521, j3211 or a YAML file"),
])
def test_what_is_no_schedule_is_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        planned(**given)


def test_a_file_of_ones_own_is_read(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("title: mine\nmodules:\n  - {module: a, kind: drag, speeds: {value: [3 km/h], origin: measured},"
                    " pressures: [5 bar]}\n")
    made = planned(schedule=str(file))
    assert made.title == "mine" and made.origins == (("a", "speeds", "'3 km/h'", "measured", ""),)


@pytest.mark.parametrize("text, message", [
    ("modules: 1.5", "modules: input should be a valid tuple"), ("[1, 2]", "expected a mapping of settings"),
    ("title: a\nmodules: {a: 1}", "modules"), ("modules: [3]", "modules.0")])
def test_files_that_are_no_schedule_are_refused(tmp_path, text, message):
    (tmp_path / "s.yaml").write_text(text)
    with pytest.raises(ConfigError, match=message):
        schedule(tmp_path / "s.yaml")


def test_a_list_of_modules_with_an_origin_is_one(tmp_path):
    (tmp_path / "s.yaml").write_text(yaml_text({"title": "a", "modules": {"value": [STOPS], "origin": "stated"}}))
    assert len(schedule(tmp_path / "s.yaml").modules) == 1
