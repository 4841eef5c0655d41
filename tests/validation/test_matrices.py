"""Our numbers of systems of matrices: by whole turns a second, in order of frequency."""

from types import SimpleNamespace

import numpy as np

from pipeline.validation.matrices import matrix_rows


def test_modes_are_told_by_speed_and_frequency():
    roots = SimpleNamespace(speed=2 * np.pi * np.array([1.0, 1.5, 4.0]), unstable_operating=np.array([0, 0, 1, 2]),
                            unstable_root=np.array([7 + 2j, 3 + 1j, 9 + 9j, 4 + 5j]) * 2 * np.pi)
    rows = matrix_rows({"matrix_modes": SimpleNamespace(roots=roots)}, (), {})
    assert set(rows) == {"turns_1_unstable", "turns_1_frequency_1", "turns_1_growth_1", "turns_1_frequency_2",
                         "turns_1_growth_2", "turns_4_unstable", "turns_4_frequency_1", "turns_4_growth_1"}
    assert rows["turns_1_frequency_1"].value == 1.0 and rows["turns_1_unstable"].value == 2
    assert matrix_rows({"matrix_modes": None}, (), {}) == {}
