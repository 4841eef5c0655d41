"""The estimate of memory beside peaks that were measured."""

from pathlib import Path

import pytest

import stages
from pipeline.case_models.early.memory import peak_memory
from pipeline.contract import case

CONFIGS = Path(__file__).parents[3] / "configs"


def test_the_default_takes_what_was_measured():
    """5.7 GB, for a finer model of 146,000 degrees of freedom; without that one 62,000 are left."""
    brake = case.load(CONFIGS / "disc_brake.yaml", stages.CHAINS, stages.load)
    assert peak_memory(brake.sections) == pytest.approx(5.7e9, rel=0.3)
    alone = peak_memory(brake.varied({"convergence.refinements": ["bases"]}).sections)
    assert alone == pytest.approx(0.6e9 + 34e3 * 62_400, rel=0.1)


def test_systems_without_a_brake_are_not_weighed():
    assert peak_memory(case.load(CONFIGS / "belt.yaml", stages.CHAINS, stages.load).sections) == 0
