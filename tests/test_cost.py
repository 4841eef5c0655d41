"""What tests cost: a folder that takes more than its share is named."""

from types import SimpleNamespace

from tests.cost import of, over_budget


def test_a_folder_over_its_budget_is_named_whatever_the_processor():
    costs = {"tests/stages/test_a.py::one": 100.0, "tests/decks/test_b.py::two": 29.0, "tests/test_c.py::three": 1.0}
    assert over_budget(costs) == []
    costs["tests/decks/test_b.py::other[a/b.c::d]"] = 2.0
    assert over_budget(costs) == ["over its budget: tests/decks, 31 CPU seconds, 30 allowed"]
    slow = {test: 20 * seconds for test, seconds in costs.items()}
    assert [line.split(",")[0] for line in over_budget(slow)] == [
        f"over its budget: tests/{folder}" for folder in ("decks", "stages")]


def test_phases_of_a_test_are_added():
    report = SimpleNamespace(nodeid="tests/a.py::b", cpu_seconds=1.5)
    assert of([report, report, SimpleNamespace(nodeid="tests/c.py::d")]) == {"tests/a.py::b": 3.0}
