"""The modes of a run on the terminal: ratios of other programs, what a heard frequency says, what is settled to."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.named_modes import named_modes
from pipeline.contract import store
from pipeline.views.figures.number_format import MINUS, THIN
from pipeline.views.pages import modes as page
from tests.commands import brakechain
from tests.views import products_for_views as small
from tests.views.test_matrix_modes_chapter import modes as matrix_modes

HZ = 2 * np.pi


def plain(text):
    return text.replace(THIN, " ").replace(MINUS, "-")


@pytest.mark.exact
def test_the_ratio_of_abaqus_and_nastran_is_twice_the_damping_ratio_of_a_lightly_damped_mode():
    """s = 3 + 400 i: |s| is 400.011, and the velocity grows a thousandfold in ln(1000) / 3 s."""
    frequency, growth, ratio, double, rise, *_ = map(plain, page._row(3 + 400j, "—", ""))
    assert (frequency, growth) == ("63.662 Hz", "3") and float(ratio) == pytest.approx(-100 * 3 / 400.011, rel=1e-3)
    assert float(double) == pytest.approx(-1.5) and rise == "2.3 s"
    assert page._row(-3 + 400j, "—", "")[4] == "never" and float(page._row(-3 + 400j, "—", "")[3]) == 1.5


@pytest.mark.exact
def test_several_frequencies_together_are_as_improbable_as_their_chances_say():
    assert page._at_least(0, [0.3, 0.1]) == pytest.approx(1.0) and page._at_least(2, [0.3, 0.1]) == pytest.approx(0.03)
    assert page._at_least(1, [0.5, 0.2, 0.1]) == pytest.approx(1 - 0.5 * 0.8 * 0.9)


def test_a_heard_frequency_is_told_beside_the_nearest_mode_and_the_unstable_one(tmp_path):
    store.write(small.complex_modes(), tmp_path / "complex_modes.h5", {})
    shown = brakechain("modes", tmp_path, "--heard", "16.5 kHz", "--heard", "4.1kHz", "--near", "0.02").stdout
    assert "which is unstable" in shown and "above the unstable mode" not in shown.partition("Heard at 4.1")[0]
    assert "Heard at 4.1 kHz" in shown and "Of 2 frequencies 1 lie within 2 % of an unstable mode" in shown
    one = named_modes({"a": 2000.0}, None, "here")
    told, = page.beside(one, [2020.0], 0.03)
    chance = np.log(1.03 / 0.97) / np.log(2)
    assert f"1{THIN}% above the nearest mode at 2{THIN}kHz. By chance" in told and f"{100 * chance:.2g}{THIN}%" in told


def test_without_an_unstable_mode_the_least_stable_ones_are_shown(tmp_path):
    title, rows, told = page.of_case(small.complex_modes(stable=True))
    assert "no mode is unstable" in title and len(rows) == 3 and not told
    growth = [float(plain(row[1])) for row in rows]
    assert growth == sorted(growth, reverse=True) and growth[0] < 0 and {row[4] for row in rows} == {"never"}
    failed = brakechain("modes", tmp_path, code=4)
    assert "expected complex_modes.h5 or matrix_modes.h5" in failed.stderr
    refused = brakechain("modes", tmp_path, "--heard", "2750", code=2)
    assert "--heard" in refused.stderr and "Hz" in refused.stderr


def test_modes_of_matrices_are_shown_and_a_frequency_beside_them(tmp_path):
    store.write(matrix_modes(), tmp_path / "matrix_modes.h5", {})
    shown = plain(brakechain("modes", tmp_path, "--heard", "1.49 kHz").stdout)
    assert "800 Hz" in shown and "friction × 1" in shown and "friction, everywhere +5" in shown
    assert "0.67 % below the nearest mode at 1.5 kHz, 84 % above the unstable mode at 810 Hz" in shown
    title, rows, told = page.of_matrices(matrix_modes(unstable=0))
    assert "no mode is unstable" in title and 0 < len(rows) <= 3 and not told


def test_what_the_motion_settles_to_is_told_beside_the_nearest_unstable_mode():
    motion = SimpleNamespace(pressure=[1e6, 2e6], speed=[3.0, 3.0], cycle_amplitude=np.array([[1.0, 2.0], [1.0, 0.0]]),
                             cycle_frequency=np.array([[90.0, 95.0], [95.0, 95.0]]), settled=np.array([[1, 1], [0, 1]]))
    first, second = map(plain, page.cycles(motion, np.array([100.0, 200.0])))
    assert first.endswith("settles to a cycle at 95 Hz, 5 % below the unstable mode at 100 Hz.")
    assert second.endswith("it settles to no cycle.") and page.cycles(None, np.empty(0)) == []
    whole = page.cycles(small.limit_cycle(), np.array([small.SQUEAL_LINE]))
    assert whole and "it settles to" in whole[0]
