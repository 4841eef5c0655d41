"""Cases on practice benches: two files, neutral, and a truth in the words of the catalogue."""

import pytest

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.benches import bench_cases, pin_bench, worn_pad
from pipeline.blind_trial.generators.systems import Draw
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical
from pipeline.recordings.neutral import read_neutral


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(pin_bench, "DURATIONS", (0.004, 0.004))
    monkeypatch.setattr(worn_pad, "PRESSURES", (1e6,))
    monkeypatch.setattr(worn_pad, "WAYS", (0.0, 1e-3))


@pytest.mark.parametrize("system, hidden, place", [
    ("pin_on_disc", ("doublet_split",), ("two 1", "three 1")), ("pin_on_disc", ("sensor_delay",), (
        "laser_pin", "accelerometer")), ("shoe_on_drum", ("moving_base",), ("onto",)),
    ("shoe_on_drum", ("sensor_gain",), ("laser_block", "accelerometer")), ("shoe_on_drum", (), ())])
def test_a_bench_leaves_two_files_and_tells_its_truth(tmp_path, short, system, hidden, place):
    kind = "control" if not hidden else "sensor" if hidden[0] in pin_bench.DECOYS else "effect"
    truth = getattr(bench_cases, system)(Draw(4, system, kind, hidden, 0.0, 0.0), tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["nominal.yaml", "recordings.h5"]
    assert truth["class"] == kind and [e["name"] for e in truth["effects"]] == list(hidden)
    assert all(e["place"] in place for e in truth["effects"])
    runs = read_neutral(tmp_path / "recordings.h5")
    assert str(runs["lifted_2"].repeat_of) == "lifted_1" and "turned_15N" in runs
    text = (tmp_path / "nominal.yaml").read_text()
    assert "file: recordings.h5" in text and "practice/bench" not in text


def test_true_values_are_told_of_every_parameter_that_is_asked_for(tmp_path, short):
    truth = bench_cases.pin_on_disc(Draw(4, "pin_on_disc", "effect", ("moving_base",), 0.0, 0.0), tmp_path)
    asked = set(case_files.stated("pin_on_disc_bench.yaml")["diagnosis"]["parameters"])
    assert asked <= set(truth["parameters"])
    factors, known = truth["factors"], truth["parameters"]
    assert known["bodies.two.modal_mass"] == factors["two.mass"] and known["friction"] == factors["friction"]
    assert known["joints.arm.stiffness"] == pytest.approx(2e6 * factors["arm.stiffness"], rel=1e-12)
    assert known["friction.stiffness"] == factors["contact.tangential_stiffness"]


def test_true_values_are_factors_where_those_of_a_diagnosis_are(tmp_path, short):
    """All but the arm are factors of the model (see ``pipeline.case_models.corrections``), hence near to 1."""
    known = bench_cases.pin_on_disc(Draw(4, "pin_on_disc", "control", (), 0.0, 0.0), tmp_path)["parameters"]
    assert {name for name, value in known.items() if not 0.3 < value < 3} == {"joints.arm.stiffness"}


@pytest.mark.parametrize("hidden", ["", "third_body_film", "material_transfer"])
def test_worn_pads_leave_friction_and_faces(tmp_path, short, hidden):
    truth = bench_cases.worn_pads(Draw(4, "worn_pads", "effect", (hidden,) if hidden else (), 0.0, 0.0), tmp_path)
    runs = read_neutral(tmp_path / "recordings.h5")
    assert set(runs) == {"new", "drag_1MPa"} and "pad_worn" in runs["drag_1MPa"].topography
    assert [(e["name"], e["place"]) for e in truth["effects"]] == ([(hidden, "asperities")] if hidden else [])
    assert "data/runs" not in (tmp_path / "nominal.yaml").read_text()


@pytest.mark.parametrize("name", [*pin_bench.HIDDEN, *pin_bench.DECOYS])
def test_told_values_are_those_of_the_catalogue(name):
    values = dict.fromkeys({**pin_bench.HIDDEN, **pin_bench.DECOYS}[name], 0.1)
    more = {"order": 2} if name == "doublet_split" else {"channel": "laser_pin"} if name in pin_bench.DECOYS else {}
    effect = next(e for e in CATALOGUE if e.name == name)
    known = {p.name for p in effect.parameters(Typical())}
    assert set(bench_cases._told(name, {**values, **more}, "pin_on_disc")["parameters"]) <= known
