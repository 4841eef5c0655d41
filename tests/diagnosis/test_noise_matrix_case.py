"""The case that asks why: recorded drags, their pressures, and the chain that weighs hypotheses on them."""

from types import SimpleNamespace

import numpy as np

from pipeline.contract.documents import parse_value
from pipeline.diagnosis.noise_matrix_case import asked, companions

STATED = {"chain": "noise_matrix_records", "title": "Brake", "structure": {"pressures": ["3 MPa"], "mesh": 2},
          "recording": {"files": []}, "noise_matrix": {"pressure_factor": 0.4, "draws": 7}}
PRODUCT = SimpleNamespace(
    kind=np.array(["drag", "stop", "drag"], object), pad_pressure=np.array([2e5, 4e5, 8e5]),
    run=np.array(["a", "b", "c", "d", "e"], object), run_condition=np.array([0, 1, -1, 2, 0]),
    condition_difference=np.array([0, 0, -1]), band_difference=np.zeros(2, int), all_difference=0,
    limits=np.array([2e3, 16e3]))


def test_all_drags_of_the_schedule_take_part_at_their_pressures():
    np.testing.assert_array_equal(asked(PRODUCT), [0, 3, 4])
    (name, text), = companions(PRODUCT, SimpleNamespace(name="brake", document=STATED)).items()
    made = parse_value(text)
    assert name == "brake_why.yaml" and made["chain"] == "disc_squeal_records" and "noise_matrix" not in made
    assert made["structure"] == {"pressures": ["200000.0 Pa", "800000.0 Pa"], "mesh": 2}
    assert made["line_evidence"] == {"runs": ["a", "d", "e"], "pressure_within": 0.2, "low": "2000.0 Hz",
                                     "high": "16000.0 Hz", "pressure_factor": 0.4}
    assert STATED["structure"]["pressures"] == ["3 MPa"]


def test_without_a_difference_or_without_drags_there_is_none():
    case = SimpleNamespace(name="brake", document=STATED)
    for changed in ({"condition_difference": np.zeros(3, int)}, {"run_condition": np.full(5, 1)}):
        assert not companions(SimpleNamespace(**{**vars(PRODUCT), **changed}), case)
    assert not companions(PRODUCT, None)
