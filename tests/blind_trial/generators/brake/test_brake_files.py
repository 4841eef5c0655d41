"""Cases on the practice brake: two neutral files, a truth in the words of the catalogue, and how much it leaves."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from pipeline.blind_trial.generators.brake import brake, brake_files, brake_model, brake_parts
from pipeline.blind_trial.generators.systems import Draw
from pipeline.blind_trial.metrics.criteria import judged
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical
from pipeline.recordings.neutral import read_neutral
from tests.studies.forced import by_stages, recorded

SHAPE = brake_parts.SHAPES[0]


@pytest.fixture
def short(monkeypatch):
    monkeypatch.setattr(brake, "DURATION", 0.01)


@pytest.fixture(scope="module")
def seen():
    return brake_files.Seen(brake_parts.NOMINAL, SHAPE)


@pytest.mark.parametrize("kind, hidden", [("control", ()), ("sensor", ("sensor_delay",)), ("wrong_value", ())])
def test_a_case_is_two_files_that_tell_nothing(tmp_path, short, kind, hidden):
    truth = brake_files.write(Draw(4, "disc_brake", kind, hidden, 0.0, 0.0), tmp_path / "a")
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == ["nominal.yaml", "recordings.h5"]
    assert truth["class"] == kind and [e["name"] for e in truth["effects"]] == list(hidden)
    assert all(e["place"] in brake.CHANNELS for e in truth["effects"])
    assert bool(truth["wrong"]) == (kind == "wrong_value") and "left" not in truth
    runs = read_neutral(tmp_path / "a" / "recordings.h5")
    assert len(runs) == 18 and str(runs["lifted_2"].repeat_of) == "lifted_1"
    document = yaml.safe_load((tmp_path / "a" / "nominal.yaml").read_text())
    assert document in [brake_model.nominal(shape) for shape in brake_parts.SHAPES], "that of a drawing"
    assert brake_files.write(Draw(4, "disc_brake", kind, hidden, 0.0, 0.0), tmp_path / "b") == truth
    for name in ("nominal.yaml", "recordings.h5"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_values_are_off_and_one_may_be_far_off(tmp_path, short):
    plain, far = (brake_files.write(Draw(5, "disc_brake", kind, (), 0.0, 0.0), tmp_path)["parameters"]
                  for kind in ("control", "wrong_value"))
    nominal = {name: brake_parts.NOMINAL[name.split(".")[1]] if name.startswith("joints") else 1.0 for name in plain}
    off = np.log([plain[name] / nominal[name] for name in plain])
    assert np.all(off != 0) and np.all(abs(off) < 0.36) and set(plain) == set(far)
    assert set(plain) <= set(brake_model.nominal(SHAPE)["diagnosis"]["parameters"])


@pytest.mark.parametrize("name", [*brake.HIDDEN, *brake.DECOYS, *brake.FOREIGN])
def test_told_names_and_values_are_those_of_the_catalogue(name):
    told = brake_files.named(name, brake_files.sizes(np.random.default_rng(1), name))
    effect = next((e for e in CATALOGUE if e.name == name), None)
    assert (effect is None) == (name in brake.FOREIGN)
    if effect:
        assert set(told["parameters"]) <= {p.name for p in effect.parameters(Typical())}
        assert told["place"] in brake_model.nominal(SHAPE)["diagnosis"]["places"]


@pytest.mark.exact
def test_what_other_values_explain_leaves_nothing(seen):
    """A change of the brake that is one of its values is taken off by it: d = r / sqrt(1 + j^2) with little noise."""
    assert seen.left({}) == pytest.approx(0, abs=1e-6)
    softer = brake_parts.built({**brake_parts.NOMINAL, "fingers": 1.001 * brake_parts.NOMINAL["fingers"]}, SHAPE)
    change = seen._change(softer)
    assert seen.explained.left(change[None, None], np.ones(1)) < 0.01 * np.linalg.norm(change) + 0.01


def test_more_hidden_leaves_more_and_a_size_is_found_for_little(seen):
    sizes = [seen.left({"attached_mass": {"mass": mass, "sensor": 0}}) for mass in (0.002, 0.004)]
    assert sizes[1] == pytest.approx(2 * sizes[0], rel=0.1) and sizes[0] > 1
    found = brake_files._faint(seen, {"attached_mass": {"mass": 0.05, "sensor": 0}}, 1.0)
    assert seen.left(found) == pytest.approx(1.0, rel=0.25) and found["attached_mass"]["sensor"] == 0


def test_it_hides_by_class_and_lacks_at_least_two_of_the_catalogue():
    hides = brake_files.hides()
    assert len(hides["foreign"]) >= 2 and hides["below"] == hides["effect"] and hides["control"] == ((),)
    known = {e.name for e in CATALOGUE}
    assert {name for name, in (*hides["effect"], *hides["sensor"])} <= known
    assert not {name for name, in hides["foreign"]} & known


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("kind, hidden, seed", [("control", (), 12), ("effect", ("doublet_split",), 14),
                                                ("foreign", ("resonant_clip",), 15)])
def test_a_case_is_solved(tmp_path, monkeypatch, kind, hidden, seed):
    truth = brake_files.write(Draw(seed, "disc_brake", kind, hidden, 0.0, 0.0), tmp_path)
    monkeypatch.chdir(tmp_path)
    answer = by_stages(yaml.safe_load(Path("nominal.yaml").read_text()), recorded(Path("recordings.h5")))
    assert judged(truth, answer)["right"], answer["reasons"]
