"""Numbers as an engineer writes them."""

import numpy as np
import pytest

from pipeline.views.figures.number_format import number, ordinal, percent, plural, quantity, span

pytestmark = pytest.mark.exact


@pytest.mark.parametrize(("value", "text"), [
    (0.0, "0"), (13.5, "13.5"), (-60.0, "−60"), (16600.0, "16600"), (0.40, "0.4"), (99999.4, "99999"),
    (3.3e-12, "3.3\u202f×\u202f10⁻¹²"), (-2.5e9, "−2.5\u202f×\u202f10⁹"), (1e-3, "0.001")])
def test_a_number_keeps_its_digits(value, text):
    assert number(value, 5) == text


@pytest.mark.parametrize(("value", "unit", "text"), [
    (13.5e6, "Pa", "13.5\u202fMPa"), (0.1567, "m", "156.7\u202fmm"), (7e-7, "m", "700\u202fnm"),
    (3.3e-12, "1/Pa", "3.3\u202f×\u202f10⁻⁶\u202fmm²/N"), (16600, "Hz", "16.6\u202fkHz"), (0.25, "1", "0.25"),
    ((1e6, 2e6, 3e6), "Pa", "1, 2, 3\u202fMPa"), (0.0, "m", "0\u202fm"), (0.0, "N", "0\u202fN"),
    (7200.0, "kg/m^3", "7200\u202fkg/m³")])
def test_a_quantity_takes_a_convenient_unit(value, unit, text):
    assert quantity(value, unit) == text


def test_a_convenient_unit_has_the_size_it_says():
    import pint

    from pipeline.views.figures.number_format import SCALES

    ask = pint.UnitRegistry()
    for si, scales in SCALES.items():
        for name, size in scales:
            assert ask.Quantity(1.0, name).to(si).magnitude == pytest.approx(size, rel=1e-12), name


def test_a_span_runs_from_smallest_to_largest():
    assert span(np.array([3e6, 1e6]), "Pa") == "1–3\u202fMPa"
    assert span([-60.0, 4.0], "1/s") == "−60 to 4\u202f1/s"
    assert span([0.3, 0.3], "1") == "0.3"


def test_words():
    assert percent(0.049) == "4.9\u202f%"
    assert [ordinal(n) for n in (1, 2, 3, 4, 11, 12, 13, 21, 112)] == [
        "1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "112th"]
    assert [plural(n, "mode") for n in (0, 1, 3)] == ["no modes", "1 mode", "3 modes"]
