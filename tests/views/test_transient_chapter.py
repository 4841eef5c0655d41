"""The chapter of a transient says what has settled and what has not."""

from dataclasses import replace

import numpy as np

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.transient import chapter
from pipeline.views.figures.models.transient import PERIODS, close_look
from tests.views import products_for_views as small

LOOK = Look(dpi=50)


def test_a_settled_cycle_with_its_harmonics():
    told = chapter(small.transient(), LOOK)
    assert "All signals have settled" in told.conclude and "200\u202f1/s" in told.conclude
    assert any("2.2\u202fkHz; 2f \u221220 dB, 3f \u221238 dB" in figure.caption for figure in told.figures)
    assert any("open 20\u202f%, sticking 30\u202f%, sliding 50\u202f%" in figure.caption for figure in told.figures)
    assert len(told.figures) == 10 and len(told.tables[0].rows) == 4


def test_a_cycle_that_has_not_settled_is_not_called_one():
    told = chapter(small.transient(settled=False), LOOK)
    assert "4 of 4 signals have NOT settled" in told.conclude
    assert {row[5] for row in told.tables[0].rows} == {"NO"}


def test_a_body_at_rest_and_one_without_contact():
    product = small.transient()
    still = replace(product, velocity=0 * product.velocity, cycle_amplitude=0 * product.cycle_amplitude,
                    cycle_frequency=0 * product.cycle_frequency, harmonic_amplitude=0 * product.harmonic_amplitude,
                    grew=0 * product.grew)
    assert "No sensor signal moves" in chapter(still, LOOK).see
    none = {name: np.zeros((2, 0, len(product.time))) for name in ("gap", "normal_force", "friction_force", "slip")}
    free = replace(product, **none, status=np.zeros((2, 0, len(product.time)), int), status_share=np.zeros((2, 0, 3)))
    assert len(chapter(free, LOOK).figures) == 6


def test_the_close_look_is_where_the_motion_slips_most():
    product = small.transient()
    slip, time = 0 * product.slip, product.time
    late = np.flatnonzero(time >= time[-1] - float(product.window))
    for place in (late[0], late[len(late) // 2], late[-1]):
        slip[0, 0, place] = -1.0
        shown = close_look(replace(product, slip=slip), 0)
        slip[0, 0, place] = 0.0
        assert time[shown][0] <= time[place] <= time[shown][-1] and time[shown][0] >= time[late[0]]
        length = min(PERIODS / product.cycle_frequency[0].max(), float(product.window))
        assert abs(np.ptp(time[shown]) - length) <= 2 * time[1]
