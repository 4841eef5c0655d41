"""The case that asks whether a diagnosed rig squeals: its values are those that the diagnosis corrected."""

import copy
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.corrections import corrected
from pipeline.contract import case as cases
from pipeline.contract.case import CaseText
from pipeline.contract.documents import read_yaml
from pipeline.contract.settings import fill, without_origins
from pipeline.diagnosis.output.squeal_case import companions
from stages import CHAINS, load
from stages.lumped import Settings as Lumped
from stages.lumped import lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model

LUMPED = {
    "masses": {"pad": {"mass": "1 kg", "moves": ["x", "z"]}, "disc": {"mass": "2 kg", "moves": ["z"]},
               "arm": {"inertia": "0.01 kg m^2", "moves": ["tilt_y"]}},
    "springs": {"guide": {"between": ["pad.x", "ground"], "stiffness": "1 N/um", "damping": "5 N s/m"},
                "seat": {"along": {"pad.z": 1, "arm.tilt_y": "20 mm"}, "stiffness": "0.5 N/um"},
                "plate": {"between": ["disc.z", "ground"], "stiffness": "2 N/um", "damping": "10 N s/m"},
                "hinge": {"between": ["arm.tilt_y", "ground"], "torsional_stiffness": "300 N m/rad"}},
    "contacts": {"face": {"tangent": {"pad.x": 1}, "normal": {"pad.z": 1, "disc.z": -1}, "lever": "0.1 m",
                          "stiffness": "3 N/um"}},
    "inputs": {"press": {"along": {"pad.z": -1}, "force": "100 N"}}}
BENCH = {"step": "10 us", "contact": "penalty", "contact_stiffness": "3 N/um", "friction": 0.4,
         "poles": {"high": "2 kHz"}}
VALUES = {"joints.guide.stiffness": (1.2e6, 2e4, "N/m", 0), "joints.guide.damping": (7.0, 1.0, "N s/m", 0),
          "joints.hinge.stiffness": (330.0, 3.0, "N m/rad", 0), "bodies.disc.frequency": (1.05, 0.01, "1", 1),
          "bodies.disc.damping": (1.5, 0.2, "1", 1), "bodies.pad.mass": (0.9, 0.01, "1", 1),
          "bodies.arm.modal_mass": (1.1, 0.02, "1", 1), "contact.stiffness": (0.8, 0.05, "1", 1),
          "friction": (1.1, 0.02, "1", 1), "channels.laser.gain": (1.01, 0.01, "1", 1),
          "friction.stiffness": (1.3, 0.1, "1", 1), "falling_friction@face.rise": (0.2, 0.05, "1", 0),
          "falling_friction@face.decay_speed": (0.1, 0.05, "m/s", 0)}


def diagnosed(runs=(("stop", 200.0, 2.0), ("tap", 200.0, 0.0), ("slow", 100.0, 0.5)), verdict="missing"):
    """What a diagnosis says, as far as a completed case asks for it."""
    return SimpleNamespace(
        verdict=np.array(verdict), parameter=list(VALUES), parameter_value=[v[0] for v in VALUES.values()],
        parameter_std=[v[1] for v in VALUES.values()], parameter_unit=[v[2] for v in VALUES.values()],
        parameter_factor=[v[3] for v in VALUES.values()], effect=["", "falling_friction"], place=["", "face"], known=[],
        named=[1], completed_step=0.0, runs={name: SimpleNamespace(
            condition=["press", "speed"], condition_value=[load, speed]) for name, load, speed in runs})


def stated(**more):
    document = {"chain": "lumped_bench", "title": "Rig", "lumped": LUMPED, "bench": BENCH, "recording": {},
                "diagnosis": {}, **more}
    return CaseText("rig", copy.deepcopy(document))


@pytest.fixture
def written(tmp_path):
    path = tmp_path / "squeal.yaml"
    path.write_text(companions(diagnosed(), stated())["rig_squeal.yaml"], encoding="utf-8")
    return path


def built(section):
    return lumped(settings=fill(Lumped, without_origins(section, "case"), "lumped"))


@pytest.mark.exact
def test_its_matrices_are_those_of_the_corrected_bench(written):
    """Values written into the section against the same numbers changed in the model of the bench."""
    bench = benches.built(reduced_model(built(LUMPED), settings=Reduction()), fill(benches.Settings, BENCH, "bench"))
    kept = {name: value for name, (value, *_) in VALUES.items() if name.partition(".")[0] in ("joints", "bodies")}
    expected = corrected(bench, kept).model.supported()
    model = reduced_model(built(read_yaml(written)["lumped"]), settings=Reduction())
    found = benches.built(model, fill(benches.Settings, BENCH, "bench")).model
    for ours, theirs in zip(found.supported(), expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-12)
    assert model.contact_stiffness == pytest.approx(0.8 * 3e6)
    np.testing.assert_allclose(found.contacts.area, bench.model.contacts.area)


def test_it_can_be_run_at_the_points_that_slid(written):
    given = cases.load(written, CHAINS, load)
    assert given.document["chain"] == "lumped_brake"
    assert list(given.sections["lumped"].load_factors) == [1.0, 2.0]
    assert list(given.sections["complex_modes"].speeds) == [0.5, 2.0]
    assert given.sections["complex_modes"].friction == pytest.approx(0.44)
    assert given.sections["effects"].falling_friction["face"].rise == pytest.approx(0.2)
    assert "friction.stiffness 1.3" in given.document["description"] and "laser" not in str(given.document)


def test_what_the_diagnosis_leaves_uncertain_scatters(written):
    sources = {(s["kind"], s.get("part")): s["variation"] for s in read_yaml(written)["probability"]["sources"]}
    assert sources["joint_stiffness", "guide"] == pytest.approx(2e4 / 1.2e6, rel=1e-2)
    assert sources["joint_stiffness", "plate"] == pytest.approx(2 * 0.01 / 1.05, rel=1e-2)
    assert sources["joint_loss", "plate"] == pytest.approx(0.2 / 1.5, rel=1e-2)
    assert sources["contact_stiffness", None] == pytest.approx(0.05 / 0.8, rel=1e-2)
    assert sources["friction", None] == pytest.approx(0.02 * 0.4, rel=1e-2)


@pytest.mark.parametrize(("product", "case"), [
    (diagnosed(runs=(("tap", 200.0, 0.0),)), stated()), (diagnosed(verdict="unknown"), None),
    (diagnosed(), stated(chain="pin_squeal")), (diagnosed(), stated(lumped={**LUMPED, "contacts": {}}))])
def test_no_case_without_a_run_that_slid_under_a_load(product, case):
    assert companions(product, case) == {}
