"""From sound files of stops to the noise matrix of a lumped brake, and on to the case that asks why they differ."""

import numpy as np
import pytest

from pipeline.contract import documents, store
from pipeline.products import LineEvidence, NoiseMatrix
from tests.commands import ROOT, brakechain

RATE, TONE = 48000, 5.2e3
HALF = 0.7071067811865476
#: a pad whose two modes couple by friction, on a disc that is hardly moved
BRAKE = {
    "masses": {"pad": {"mass": "1 g", "moves": ["x", "y"]}, "disc": {"mass": "100 g", "moves": ["y"]}},
    "springs": {"along": {"between": ["pad.x", "ground"], "stiffness": "1 N/um"},
                "onto": {"between": ["pad.y", "ground"], "stiffness": "0.7 N/um"},
                "inclined": {"along": {"pad.x": HALF, "pad.y": -HALF}, "stiffness": "0.2 N/um"},
                "hub": {"between": ["disc.y", "ground"], "stiffness": "1 N/um"}},
    "contacts": {"face": {"tangent": {"pad.x": 1}, "normal": {"pad.y": 1, "disc.y": -1}, "stiffness": "0.4 N/um"}},
    "inputs": {"press": {"along": {"pad.y": -1}, "force": "1 mN"}}, "sensors": {"pad": {"along": {"pad.x": 1}}},
    "load_factors": ["500 kPa", "1 MPa"]}
MATRIX = {"modules": [{"module": "drags", "kind": "drag", "speeds": ["3 km/h"], "pressures": ["5 bar", "10 bar"]}],
          "draws": 60, "repeats": 2, "training": 1, "checked": 1,
          "sources": [{"kind": "friction", "variation": 0.05}, {"kind": "joint_stiffness", "variation": 0.01}]}


def stop(folder, number, bar, noisy):
    """A recorded drag at 3 km/h as a file of the case."""
    soundfile = pytest.importorskip("soundfile")
    time = np.arange(int(0.6 * RATE)) / RATE
    sound = 0.02 * np.random.default_rng(number).normal(size=len(time)) + 0.3 * noisy * np.sin(2 * np.pi * TONE * time)
    soundfile.write(folder / f"stop_{number}.wav", sound, RATE, subtype="FLOAT")
    conditions = {"pressure": {"value": bar, "unit": "bar"}, "speed": {"value": 3 / 3.6 / 0.31, "unit": "rad/s"}}
    return {"kind": "audio", "file": f"stop_{number}.wav", "runs": {f"stop_{number}": {"conditions": conditions}},
            "columns": {"mic": {"column": "1", "unit": "Pa", "factor": 1.0, "measures": "sound_pressure"}}}


@pytest.mark.slow
def test_a_bench_that_squeals_more_than_the_model_is_handed_on(tmp_path):
    files = [stop(tmp_path, k, 5 if k < 6 else 10, k < 6) for k in range(9)]
    case = tmp_path / "bench.yaml"
    case.write_text(documents.yaml_text({
        "chain": "lumped_noise_matrix_records", "title": "Bench", "lumped": BRAKE, "noise_matrix": MATRIX,
        "complex_modes": {"speeds": ["2.7 rad/s"], "friction": 0.2, "friction_steps": 2, "damping_speed": "1e9 m/s"},
        "recording": {"files": files}}))
    brakechain("run", case, "--run", tmp_path / "run")
    made = store.read(NoiseMatrix, tmp_path / "run" / "noise_matrix.h5")
    assert list(made.condition_stops) == [6, 3] and list(made.condition_noisy) == [6, 0]
    assert made.probability.max() < 0.2 and list(made.condition_difference) == [-1, 0]
    why = documents.read_yaml(tmp_path / "run" / "bench_why.yaml")
    assert why["chain"] == "lumped_squeal_records" and len(why["line_evidence"]["runs"]) == 9
    brakechain("run", tmp_path / "run" / "bench_why.yaml", "--run", tmp_path / "why", "--set", "line_evidence.draws=20")
    weighed = store.read(LineEvidence, tmp_path / "why" / "line_evidence.h5")
    assert list(weighed.test) == why["line_evidence"]["runs"]
    np.testing.assert_array_equal(weighed.heard_in.any(axis=0), np.arange(9) < 6)


@pytest.mark.slow
def test_the_quick_case_of_a_brake_runs_to_its_report(tmp_path):
    brakechain("run", ROOT / "configs" / "disc_brake_matrix_quick.yaml", "--run", tmp_path / "run")
    made = store.read(NoiseMatrix, tmp_path / "run" / "noise_matrix.h5")
    assert made.applications.sum() == 132 and made.missed == 0 and not made.outside.any()
    assert (tmp_path / "run" / "report.html").stat().st_size > 10_000
