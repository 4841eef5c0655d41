"""Chapter on complex modes: where roots were solved for on the full finite-element matrices, the table says so."""

from dataclasses import replace

import numpy as np

from pipeline.views.chapters.complex_modes import _table
from tests.views import products_for_views as small


def test_distance_and_residual_are_columns_where_there_are_full_matrices():
    modes = small.complex_modes()
    plain, _ = _table(modes)
    assert len(plain.head) == 7 and "full" not in plain.title
    residual = np.full(len(modes.unstable_root), 3e-7)
    solved, _ = _table(replace(modes, unstable_residual=residual, unstable_reduced=modes.unstable_root - 5.04 + 1j))
    assert solved.head[7:] == ("reduced model / %", "reduced model / 1/s", "residual")
    assert solved.rows[0][:7] == plain.rows[0] and solved.rows[0][8:] == ("\N{MINUS SIGN}5.0", "3e-07")
    assert "full finite-element matrices" in solved.title


def test_modes_without_leave_their_cells_empty():
    modes = small.complex_modes()
    residual = np.full(len(modes.unstable_root), 3e-7)
    residual[0] = -1.0
    table, _ = _table(replace(modes, unstable_residual=residual), most=1)
    assert table.rows[0][7:] == ("", "", "")
