"""The study of the paper's friction: its patch, its mean over pairs with the error, and what it prints."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.validation.published_facts import load
from tests.studies.paper_micro import FACTS, averaged, computed, rows, sections, table

SMALL = {"patch": 0.25, "cycles": 4, "recorded_distances": ["0 mm", "2.5 mm", "10 mm"]}


@pytest.fixture(scope="module")
def pairs():
    return [computed(SMALL, seed) for seed in range(3)]


def test_the_case_is_the_default_one_at_the_papers_points():
    rough, micro = sections(2.0, pad={"hardness": "40 MPa"})
    assert rough["nodes"] == 256 and len(micro["pressures"]) == len(micro["disc_speeds"]) == 3
    assert micro["pad"]["hardness"] == "40 MPa" and micro["pad"]["poisson_ratio"] == 0.25


def test_pairs_are_of_different_surfaces(pairs):
    first, second, _ = pairs
    assert first.friction.shape == (3, 3, 3) and not np.allclose(first.friction, second.friction, rtol=1e-3)


def test_numbers_are_of_the_mean_with_the_error_of_the_pairs(pairs):
    told = {fact.key: (value, error) for fact, value, error in rows(pairs, load(FACTS))}
    lowest = np.array([p.friction.min() for p in pairs])
    assert told["friction_lowest"][0] == pytest.approx(averaged(pairs).friction.min())
    assert told["friction_lowest"][1] == pytest.approx(lowest.std(ddof=1) / np.sqrt(3))
    assert told["real_area_start"][0] == pytest.approx(100 * np.mean([p.real_area[0, 1, 0] for p in pairs]))
    assert "micro_pressures" not in told


def test_the_table_says_what_is_met(pairs):
    facts = [f for f in load(FACTS) if f.key in ("friction_lowest", "friction_rises_with_distance")]
    lines = table(rows([replace(p, friction=np.linspace(0.41, 0.6, 27).reshape(3, 3, 3)) for p in pairs], facts))
    assert len(lines) == 3 and all(line.endswith(" met") for line in lines[1:])
    assert "+- 0 " in lines[1] and "0.41" in lines[1]
