"""The study of convergence of the micro scale: its tables, its limits, and that its sweeps change what they say."""

import numpy as np
import pytest

from tests.studies import micro_convergence
from tests.studies.micro_convergence import NUMBERS, SWEEPS, Sweep, cost, drawn, gathered, table


@pytest.fixture
def small(monkeypatch):
    """A sweep of seconds."""
    quick = {"cycles": 2, "recorded_distances": ["0 mm", "10 mm"]}
    sweep = Sweep((4, 8, 16), lambda nodes: (0.25, {"nodes": 4 * nodes}, quick), (2, 2, 2), float)
    monkeypatch.setitem(SWEEPS, "grid", sweep)
    return "grid"


def test_a_finer_grid_lowers_the_real_area_of_the_same_surfaces(small, tmp_path):
    found = gathered(map, (small,))
    area = np.array([each[:, 0] for each in found[small]])
    assert area.shape == (3, 2) and (np.diff(area, axis=0) < 0).all() and np.ptp(area[0]) > 0
    lines = table(small, found[small])
    assert len(lines) == 2 + 3 + 1 and lines[-1].startswith("| limit") and lines[-1].count("±") == len(NUMBERS)
    drawn(found, tmp_path / "drawn.svg")
    assert (tmp_path / "drawn.svg").stat().st_size > 5000


@pytest.mark.parametrize("name", list(SWEEPS))
def test_every_value_of_a_sweep_is_another_case(name):
    cases = [str(SWEEPS[name].changed(value)) for value in SWEEPS[name].values]
    assert len(set(cases)) == len(cases) == len(SWEEPS[name].pairs)


def test_cost_is_told_per_n_log_n():
    lines = cost((16, 32))
    assert len(lines) == 4 and lines[2].endswith("| 1.00 |")
    assert micro_convergence.solve_seconds(16) > 0
