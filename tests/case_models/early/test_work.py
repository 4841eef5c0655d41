"""Measures of work: more of what takes time is more work; they held for the default brake and a coarse one."""

from pathlib import Path

import pytest

import stages
from pipeline.case_models.early.first_look import coarse
from pipeline.case_models.early.work import FREEDOMS, elements, work
from pipeline.contract import case
from tests.decks.meshes.small_decks import IRON, abaqus, ring

CONFIGS = Path(__file__).parents[3] / "configs"
#: CPU seconds of the default brake and of its first look on one machine
TIMES = {"micro_friction": (54.1, 4.8), "structure": (35.6, 4.0), "reduced_model": (9.3, 1.1),
         "complex_modes": (175.4, 2.2)}


@pytest.fixture(scope="module")
def brake():
    return case.load(CONFIGS / "disc_brake.yaml", stages.CHAINS, stages.load)


def test_measured_times_of_two_sizes_follow_the_measures(brake):
    """Within 1.5 over a factor of 8 to 80."""
    whole, coarser = work(brake.sections), work(brake.varied(coarse(brake.sections)).sections)
    for stage, (long, short) in TIMES.items():
        assert 1 / 1.5 < coarser[stage] / whole[stage] * long / short < 1.5, stage


@pytest.mark.parametrize(("changes", "stage", "times"), [
    ({"surface.nodes": 512}, "surface", 4), ({"micro_friction.realisations": 2}, "micro_friction", 2),
    ({"probability.draws": 1000}, "probability", 2), ({"probability.speeds": "all"}, "probability", 3),
    ({"limit_cycle.step": "1 us"}, "limit_cycle", 2), ({"structure.frequency_max": "60 kHz"}, "structure", 2)])
def test_more_of_what_takes_time_is_more_work(brake, changes, stage, times):
    before, after = work(brake.sections), work(brake.varied(changes).sections)
    assert after[stage] / before[stage] == pytest.approx(times)
    assert after["friction_map"] == before["friction_map"] == 1.0


def test_a_mesh_file_counts_by_its_degrees_of_freedom(brake, tmp_path):
    path, mesh = tmp_path / "disc.inp", ring()
    path.write_text(abaqus(mesh, more=IRON))
    changes = {"structure.disc.mesh_file": str(path), "structure.disc.mesh_units": "mm-t-s"}
    assert elements(brake.varied(changes).sections["structure"]) == pytest.approx(
        elements(brake.sections["structure"]) - 90 * 14 + 3 * len(mesh.node) / FREEDOMS)


def test_systems_without_a_brake_have_measures_too():
    belt = case.load(CONFIGS / "belt.yaml", stages.CHAINS, stages.load)
    assert set(work(belt.sections).values()) == {1.0}
