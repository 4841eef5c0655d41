"""From recorded lists to the product of all diagnoses."""

import json

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.case import CaseText
from pipeline.contract.settings import fill
from pipeline.diagnosis.output.files import companions
from pipeline.diagnosis.published_lists import Models, published_problem
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.published import test_mode_table as tables
from tests.diagnosis.published import test_squeal_frequencies as squeal
from tests.diagnosis.solving import diagnosis_product

MODES = {"kind": "modes", "measured": "test", "computed": "model"}
SQUEAL = {"kind": "squeal", "run": "bench", "list": "laser", "low": "15.6 kHz", "high": "18.8 kHz",
          "model_error": 0.001}


def told(recording, lines, **models):
    settings = fill(Settings, {"forward": "lines", "lines": lines, "draws": 2000}, "diagnosis")
    return diagnosis_product(published_problem(recording, Models(**models), settings))


def test_a_wrong_pair_is_at_most_a_tie_with_what_would_decide():
    pairs = {f"row_{n}": [n] for n in tables.COMPUTED if n != "f"} | {"row_e": ["f"]}
    found = told(tables.recording(tables.scattered(f=None)), {**MODES, "pairs": pairs})
    names = [str(found.hypothesis[k]) for k in found.named]
    assert found.verdict.item() == "tie" and names[0] == "mis_paired at row_e as e"
    assert found.location["run"].item[found.location["run"].member == 1].tolist() == ["row_e"]
    assert set(names) <= set(found.next_separates) and len(found.next_separates) > 1
    assert len(found.next_condition) and found.next_value >= 0


def test_a_table_that_agrees_is_consistent():
    found = told(tables.recording(tables.scattered()), MODES)
    assert found.verdict.item() == "consistent" and not len(found.named) and not len(found.next_condition)


def test_lines_that_any_list_meets_are_a_tie():
    found = told(squeal.recording(), SQUEAL, modes=squeal.modes(np.arange(15000.0, 19400.0, 45.0)))
    assert found.verdict.item() == "tie" and {str(e) for e in found.effect[found.named]} == {
        "flexible_disc", "falling_friction", "changing_load"}
    assert float(found.next_value) == pytest.approx(np.log(3))


def test_the_verdict_is_written_without_a_completed_case():
    found = told(squeal.recording(), SQUEAL, modes=squeal.modes(np.arange(15000.0, 19400.0, 45.0)))
    written = companions(found, CaseText("brake", {"diagnosis": {"forward": "lines"}}))
    assert list(written) == ["diagnosis.json"] and json.loads(written["diagnosis.json"])["verdict"] == "tie"


def test_what_is_missing_is_refused():
    with pytest.raises(ConfigError, match="a chain with complex_modes before it"):
        told(squeal.recording(), SQUEAL)
    with pytest.raises(ConfigError, match="which lists are compared"):
        told(squeal.recording(), None)
