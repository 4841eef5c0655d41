"""The practice bench of worn pads: its files, and each of them to its verdict."""

import json

import pytest

from pipeline.blind_trial.generators.benches import worn_pad
from tests.studies import worn

#: what is hidden -> verdict, effects named
RIGHT = {"third_body": ("missing", ["third_body_film"]), "transfer": ("missing", ["material_transfer"]),
         "": ("parameters", [])}


def test_files_hide_what_their_truth_says(tmp_path, monkeypatch):
    monkeypatch.setattr(worn_pad, "PRESSURES", (2e6,))
    monkeypatch.setattr(worn, "make", lambda seed, hidden: worn_pad.make(seed, hidden, nodes=32, cycles=20))
    worn.practice(tmp_path)
    told = [json.loads((tmp_path / f"worn_{k}_truth.json").read_text())["hidden"] for k in range(3)]
    assert [list(hidden) for hidden in told] == [["third_body"], ["transfer"], []]
    assert all((tmp_path / f"worn_{k}.h5").exists() for k in range(3))


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worn")
    worn.practice(folder)
    return folder


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("number", range(3))
def test_a_concealed_case_reaches_its_verdict(files, number):
    found = worn.solved(files / f"worn_{number}.h5")
    assert (found["verdict"], [e["name"] for e in found["effects"]]) == RIGHT[worn.PRACTICE[number]]
    assert found["location"]["stage"] == ["micro_friction"] or not found["effects"]


@pytest.mark.slow
@pytest.mark.study
def test_without_the_third_body_that_the_paper_leaves_out_its_factor_is_named(files):
    """The control under a model whose spots shear like bare iron."""
    effect, = worn.solved(files / "worn_2.h5", third_body_factor=1)["effects"]
    assert effect["name"] == "shear_limit" and 0.07 < effect["parameters"]["factor"]["value"] < 0.14
