"""Chapter on complex modes: where roots were solved for on the full finite-element matrices, a table says so."""

from dataclasses import replace

import numpy as np

from pipeline.views.chapters.complex_modes import _table
from pipeline.views.figures.number_format import percent, quantity
from tests.views import products_for_views as small


def test_distance_and_residual_are_a_table_where_there_are_full_matrices():
    modes = small.complex_modes()
    assert len(_table(modes)) == 3
    residual = np.full(len(modes.unstable_root), 3e-7)
    residual[1] = -1.0
    reduced = modes.unstable_root - 5.0
    reduced[0] += 1e-4j * reduced[0].imag
    *_, table = _table(replace(modes, unstable_residual=residual, unstable_reduced=reduced))
    assert table.rows[0][3:] == ("+0.010", "3e-07") and len(table.rows) == 1
    assert table.rows[0][2] == quantity(reduced[0].real, "1/s", 4)
    assert f"within {percent(1e-4, 2)} and {quantity(5.0, '1/s', 2)} of these" in table.title


def test_modes_that_were_not_solved_for_there_are_left_out():
    modes = small.complex_modes()
    residual = np.full(len(modes.unstable_root), -1.0)
    residual[-1] = 3e-7
    assert len(_table(replace(modes, unstable_residual=residual), most=1)) == 3


def test_every_body_and_both_planes_of_the_disc_are_listed():
    modes = small.complex_modes()
    _, table, reasons = _table(modes)
    assert table.head == ("frequency", "diameters in plane", "diameters out of plane", "disc motion out of plane",
                          "disc / %", "outer pad / %", "inner pad / %", "caliper / %")
    assert table.rows[0][1:] == ("2", "5", percent(0.87, 2), "70", "20", "10", "0")
    assert "diameters" not in reasons.head and len(reasons.head) == len(reasons.rows[0])
    plain = replace(modes, unstable_diameters=np.full(len(modes.unstable_root), -1))
    assert _table(plain)[1].head[1] == "disc / %" and "disc" not in _table(plain)[1].title
