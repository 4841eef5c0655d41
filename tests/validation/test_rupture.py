"""Rows of a made-up rupture whose figures are known."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.validation.published_facts import load
from pipeline.validation.rupture import rupture_rows
from tests.views.products_for_views import rupture


def rows(product):
    return {key: row.value for key, row in rupture_rows({"rupture": product}, (), {}).items()}


def test_every_row():
    found = rows(rupture())
    assert found["left_speed"] == 1650 and found["right_speed"] == 975 and found["left_stop"] == pytest.approx(8.75e-3)
    assert found["left_supershear"] == pytest.approx(1650 / 1304) and found["left_near_dilatational"] == 1650 / 1807
    assert found["right_near_rayleigh"] == 975 / 959 and found["adams_right"] == 975 / 1036
    assert found["right_self_sustained"] == pytest.approx(2.0 / 1.25, rel=0.02)
    assert found["left_evanescent"] < 1 and found["right_slip_grows"] == 1.4
    assert found["left_heals"] < 0.1 and found["left_mach_cone"] == pytest.approx(0.9)
    assert found["shear_2"] == 1044 and found["contrast"] == 1044 / 1304


def test_every_row_has_its_fact_and_every_compared_fact_its_row():
    facts = load("data/reference/bimaterial_rupture.yaml")
    found = rows(rupture())
    assert found.keys() <= {fact.key for fact in facts}
    assert {fact.key for fact in facts if fact.comparable and fact.role != "input"} <= found.keys()


def test_what_did_not_happen_has_no_number():
    dead = replace(rupture(), slip_growth=0.0, speed=[0.0, 0.0], outcome=["died", "died"],
                   mach_known=np.zeros((2, 2), int), reached=np.zeros(161, int), pulse_exists=0, interface_wave=0)
    found = rows(dead)
    for key in ("left_speed", "right_speed", "left_stop", "left_mach_cone", "left_heals", "adams_left", "adams_right",
                "right_slip_grows"):
        assert found[key] is None, key
