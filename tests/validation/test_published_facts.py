"""The published facts are well formed, and the paper's table agrees with itself where no doubt is raised."""

from pathlib import Path

import pytest

from pipeline.contract import ConfigError
from pipeline.validation.published_facts import Published, load

FILE = Path(__file__).parents[2] / "data" / "reference" / "disc_brake.yaml"
FACTS = {fact.key: fact for fact in load(FILE)}
GOOD = {"key": "a", "part": "modes", "role": "test", "quantity": "q", "value": 2.0, "tolerance": 1.0, "why": "w",
        "source": "s"}
TABLE = ["01_02", "03", "04_05", "09_10", "13", "16_17", "18"]


@pytest.mark.published
@pytest.mark.parametrize("row", TABLE)
def test_deviations_of_table_1(row):
    """The printed deviation is that of one of the two simulated frequencies, or the row says that it is not."""
    test, deviation = FACTS[f"mode_{row}_test"], FACTS[f"mode_{row}_deviation"]
    simulated = [FACTS[f"mode_{number}_simulation"] for number in row.split("_")]
    off = [abs(s.value / test.value - 1) * 100 for s in simulated]
    agrees = min(abs(o - deviation.value) for o in off) <= deviation.tolerance * 1.0001
    assert agrees or deviation.doubt
    read = [abs(s.read_as / test.value - 1) * 100 for s in simulated if s.read_as]
    assert all(abs(r - deviation.value) <= deviation.tolerance for r in read)


@pytest.mark.published
def test_table_1_rises_where_it_is_not_doubted():
    values = [fact.value if fact.read_as is None else fact.read_as for key, fact in FACTS.items()
              if key.startswith("mode_") and fact.role == "simulation"]
    assert len(values) == 18 and values == sorted(values)


@pytest.mark.published
def test_wear_of_the_first_iteration_is_doubted():
    first, last, cycles = (FACTS[key].value for key in ("largest_wear_first", "largest_wear_last", "wear_iterations"))
    assert last / cycles > 4 * first and FACTS["largest_wear_first"].doubt


def test_every_number_of_a_result_has_a_reason_for_its_tolerance():
    assert all(fact.why for fact in FACTS.values() if fact.comparable)


def test_met_by_value_bounds_and_reading():
    assert Published(**GOOD).met_by(2.9) and not Published(**GOOD).met_by(3.1)
    read = Published(**GOOD, doubt="d", read_as=10.0)
    assert read.met_by(10.5) and not read.met_by(2.0)
    bounds = {**GOOD, "value": None, "tolerance": None, "statement": "it falls", "lower": -1.0, "upper": 0.0}
    assert Published(**bounds).met_by(-0.5)
    assert not Published(**bounds).met_by(0.1) and not Published(**bounds).met_by(-1.1)


@pytest.mark.parametrize("change, said", [
    ({"value": None, "tolerance": None}, "value or a statement"), ({"tolerance": None}, "value and tolerance"),
    ({"why": ""}, "why"), ({"lower": 1.0}, "found both"), ({"read_as": 3.0}, "doubt"), ({"part": ""}, "part"),
    ({"tolerance": -1}, "tolerance"), ({"colour": 1}, "unknown key"), ({"source": ""}, "source")])
def test_malformed_facts(tmp_path, change, said):
    path = tmp_path / "facts.yaml"
    record = {key: value for key, value in {**GOOD, **change}.items() if value is not None}
    path.write_text("- {" + ", ".join(f'{key}: "{value}"' if isinstance(value, str) else f"{key}: {value}"
                                      for key, value in record.items()) + "}\n")
    with pytest.raises(ConfigError, match=said) as error:
        load(path)
    assert "fact 1 (a)" in str(error.value)


def test_file_level_errors(tmp_path):
    path = tmp_path / "facts.yaml"
    path.write_text("key: value\n")
    with pytest.raises(ConfigError, match="list of facts"):
        load(path)
    fact = "- {key: a, part: modes, role: test, quantity: q, statement: s, source: s}\n"
    path.write_text(2 * fact)
    with pytest.raises(ConfigError, match="'a' again"):
        load(path)
