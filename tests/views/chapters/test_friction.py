"""The slope of friction in words: with its error, its sign where it is known, and what it decides."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.friction import friction_map, micro, outside_computed, slopes, what_slope_decides
from pipeline.views.figures.number_format import percent
from tests.views import products_for_views as small

LOOK = Look(dpi=50)
SLOPED = ["joint_stiffness:finger", "damping_speed", "friction_over_pressure"]


def test_slopes_are_those_of_the_map_with_their_errors():
    law = small.friction_map()
    rises = np.gradient(law.friction[:, :, -1], np.log(law.pressure), axis=0).mean(axis=1)
    told = slopes(law).replace("\N{NARROW NO-BREAK SPACE}", " ")
    values = ", ".join(f"{slope:.2g} at {p} MPa" for slope, p in zip(rises, (1, 2, 3), strict=True))
    assert told.startswith(f"Slope over pressure, p dmu/dp: {values} new (± 0.005 where it is known best, at 2 MPa);")
    assert f"{values} after 10 mm (± 0.005" in told
    assert "Over speed, v dmu/dv: 0.011 ± 0.05 new (sign unknown)" in told


def test_one_pressure_and_one_speed_have_no_slopes():
    law = small.friction_map()
    one = replace(law, computed_pressure=law.computed_pressure[:1], computed_speed=law.computed_speed[:1])
    assert slopes(one) == ""


def test_draws_of_a_higher_slope_squeal_more_often():
    drawn = replace(small.probability(), source=np.array(SLOPED))
    squeals, slope = (drawn.growth > 0).any(axis=1), drawn.value[:, 2]
    low, high = (squeals[half].mean() for half in (slope <= np.median(slope), slope > np.median(slope)))
    assert high > low and f"lower half of the slopes {percent(low)} squeal" in what_slope_decides(drawn)
    assert what_slope_decides(drawn).endswith(f"upper half {percent(high)}.")
    assert what_slope_decides(replace(drawn, squeal_from=np.array(1e5))).endswith(f"upper half {percent(0.0)}.")


def test_no_draw_says_nothing_of_the_slope():
    assert what_slope_decides(SimpleNamespace(source=SLOPED, value=np.zeros((0, len(SLOPED))))) == ""


@pytest.mark.parametrize("drawn", [None, small.probability()])
def test_without_draws_of_the_slope_nothing_is_said_of_it(drawn):
    assert what_slope_decides(drawn) == ""
    assert "p dmu/dp" in friction_map(small.friction_map(), drawn, LOOK).conclude


def test_area_that_yields_is_told():
    rubbed = small.micro_friction()
    soft = replace(rubbed, yielding_area=0.25 * rubbed.real_area)
    assert "hardness" not in micro(rubbed, LOOK).conclude
    assert f"Up to {percent(0.25)} of the real contact area is at the hardness" in micro(soft, LOOK).conclude


def test_pressures_that_were_not_computed_are_asked_for():
    """The setting that is told reaches what the contact bears, in steps of two, and is not told twice."""
    area = np.array([1e-4, 1e-4, 1e-4])
    force = np.array([[40.0, 200.0, 1290.0]])
    modes = SimpleNamespace(operating_force=force)
    law = replace(small.friction_map(), computed_pressure=np.array([1e6, 3e6]))

    def told(computed):
        return outside_computed({"friction_map": replace(law, computed_pressure=computed),
                                 "complex_modes": modes, "reduced_model": SimpleNamespace(contact_area=area)})

    assert told(law.computed_pressure).endswith("micro_friction.pressures='[0.4 MPa, 0.5 MPa, 1 MPa, 3 MPa, 6 MPa,"
                                                " 12 MPa, 13 MPa]'.")
    assert told(np.array([0.4, 0.5, 1, 3, 6, 12, 13]) * 1e6) == ""
