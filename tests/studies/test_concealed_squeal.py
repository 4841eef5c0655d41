"""The study of concealed brakes: the truth of its generator, and what is compared with it."""

import numpy as np
import pytest

from tests.studies import concealed_squeal
from tests.studies.concealed_squeal import Squeal, asked, compared, nominal, points_of, true

DOCUMENT = {"chain": "lumped_brake", "title": "t", "description": "d",
            "lumped": {"inputs": {"press": {"force": "700 N"}}, "load_factors": ["1 Pa", "3 Pa"],
                       "springs": {name: {"stiffness": "30 N/um"} for name in concealed_squeal.JOINTS}},
            "complex_modes": {"speeds": ["1 rad/s", "2 rad/s"], "friction": 0.4}}


def test_points_are_those_of_the_case():
    assert points_of(DOCUMENT) == [(700.0, 1.0), (700.0, 2.0), (2100.0, 1.0), (2100.0, 2.0)]


def test_the_truth_grows_as_its_bench_says(monkeypatch):
    """Growth rates of the truth that the bench wrote down beside its recordings, at one of its points."""
    monkeypatch.setattr(concealed_squeal, "TRUE_DRAWS", 4)
    found = true(1, [(1500.0, 1.0)])
    stop = concealed_squeal.brake_stops.made(1)[1]["stops"]["stop_1500N_1"]
    strongest = found.roots[0][np.argmax(found.roots[0].real)]
    assert strongest.real == pytest.approx(stop["growth_rate"], rel=1e-6)
    assert strongest.imag / (2 * np.pi) == pytest.approx(stop["frequency"], rel=1e-6)
    assert 0 <= found.before <= 1 and 0 <= found.after <= 1


def test_errors_are_of_the_strongest_modes():
    truth = Squeal([np.array([300 + 8000j, 20 + 9000j])], 0.5, 0.4)
    told = Squeal([np.array([21 + 9000j, 306 + 8008j])], 0.48, 0.43)
    frequency, growth, before, after = compared(truth, told)
    assert (frequency, growth) == pytest.approx((1e-3, 0.02)) and (before, after) == pytest.approx((-0.02, 0.03))
    assert np.isnan(compared(truth, Squeal([np.empty(0, complex)], 0.0, 0.0))[0])


def test_scatter_countermeasure_and_the_model_of_the_workshop():
    document = asked(DOCUMENT)
    change = document["countermeasures"]["variants"]["stiffer_abutments"]["change"]
    assert change == {f"lumped.springs.{name}.stiffness": "39000000.0 N/m" for name in concealed_squeal.CHANGED}
    workshop = nominal(DOCUMENT)
    assert workshop["lumped"]["load_factors"] == ["1 Pa", "3 Pa"] and "effects" not in workshop
    assert workshop["complex_modes"]["friction"] == 0.35
