"""The estimate of memory beside peaks that were measured."""

from pathlib import Path

import pytest

import stages
from pipeline.case_models.early.memory import peak_memory
from pipeline.contract import case

CONFIGS = Path(__file__).parents[3] / "configs"


def test_the_default_takes_what_was_measured():
    """8.7 GB for a finer model of 213,000 degrees of freedom, as 1.5 times the elements make; the default's has
    151,000, and without one 76,000 are left."""
    brake = case.load(CONFIGS / "disc_brake.yaml", stages.CHAINS, stages.load)
    assert peak_memory(brake.varied({"convergence.meshes": 1.5}).sections) == pytest.approx(8.7e9, rel=0.2)
    assert peak_memory(brake.sections) == pytest.approx(0.6e9 + 34e3 * 151_000, rel=0.15)
    alone = peak_memory(brake.varied({"convergence.refinements": ["bases"]}).sections)
    assert alone == pytest.approx(0.6e9 + 34e3 * 76_400, rel=0.15)


def test_systems_without_a_brake_are_not_weighed():
    assert peak_memory(case.load(CONFIGS / "belt.yaml", stages.CHAINS, stages.load).sections) == 0
