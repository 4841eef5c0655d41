"""Variants as case files: what differs becomes a change; what cannot be compared is refused before anything runs."""

import pytest
from click.testing import CliRunner

from pipeline.cli.compare import differences
from pipeline.cli.main import cli

BASE = """
chain: own_brake
title: My brake
structure:
  pressures: [1 MPa]
  pad: {lining_thickness: {value: 10 mm, origin: measured}}
"""


@pytest.fixture
def base(tmp_path):
    (tmp_path / "base.yaml").write_text(BASE)
    return tmp_path / "base.yaml"


def compare(base, **variants):
    """(output, message of the error) of the plan of a comparison."""
    files = []
    for name, text in variants.items():
        files.append(base.with_name(f"{name}.yaml"))
        files[-1].write_text(text)
    done = CliRunner().invoke(cli, ["compare", *map(str, (base, *files)), "--run", str(base.parent / "run"),
                                    "--dry-run"])
    assert not (base.parent / "run").exists()
    return done.output, str(done.exception or "")


def test_differences_are_dotted_and_as_small_as_they_can_be():
    before = {"pad": {"thickness": "9 mm", "angle": "50 deg"}, "disc": {"young": "110 GPa"}, "pressures": ["1 MPa"]}
    after = {"pad": {"thickness": "8 mm", "angle": "50 deg", "loss": 0.1}, "disc": {"density": "7 kg/m^3"},
             "pressures": ["2 MPa"]}
    assert differences("structure", before, after) == {
        "structure.pad.thickness": "8 mm", "structure.pad.loss": 0.1, "structure.disc": {"density": "7 kg/m^3"},
        "structure.pressures": ["2 MPa"]}
    assert differences("structure", before, before) == {}
    assert differences("structure", {"a": 1}, {"b": 2}) == {"structure": {"b": 2}}


def test_variants_based_on_the_case_are_planned(base):
    done = compare(base, thin="based_on: base.yaml\ntitle: Thin\nstructure: {pad: {lining_thickness: 8 mm}}\n"
                   "countermeasures: {cost: {mass: -0.1 kg}, note: thinner}",
                   damped="based_on: base.yaml\nstructure: {pad: {lining_loss_factor: 0.2}}")
    assert "countermeasures  would run" in done[0] and not done[1]


@pytest.mark.parametrize("text, message", [
    ("based_on: base.yaml", "expected settings that differ from those of"),
    ("based_on: base.yaml\nstructure: {pad: {lining_thickness: 10 mm}}", "expected settings that differ from those of"),
    ("based_on: base.yaml\nstructure: {pad: {lining_thickness: 1 cm}}", "found those of the case"),
    ("based_on: base.yaml\nstructure: {pad: {lining: 8 mm}}", "structure.pad.lining: unknown key"),
    ("based_on: base.yaml\nstructur: {}", "structur: unknown section; did you mean 'structure'"),
    ("based_on: base.yaml\nchain: brake_squeal", "chain: expected own_brake, as in"),
    ("based_on: base.yaml\nprobability: {draws: 7}", "which modes depend on, found 'probability.draws'"),
    ("based_on: base.yaml\nstructure: {pressures: [2 MPa]}", "operating points are compared one by one"),
    ("based_on: base.yaml\ncomplex_modes: {speeds: [2 rad/s]}", "operating points are compared one by one")])
def test_what_cannot_be_compared_is_refused_before_anything_runs(base, text, message):
    assert message in compare(base, variant=text)[1]


def test_equal_variants_and_equal_names_are_refused(base):
    text = "based_on: base.yaml\nstructure: {pad: {lining_thickness: 8 mm}}"
    assert "variants.two: expected settings that differ" in compare(base, one=text, two=text)[1]
    base.write_text(BASE + "countermeasures: {variants: {one: {change: {structure.pad.lining_thickness: 7 mm}}}}")
    assert "expected a variant of another name" in compare(base, one=text)[1]


def test_a_chain_without_the_stage_is_refused(base):
    base.write_text("chain: disc_brake\n")
    assert "expected a chain with the stage countermeasures" in compare(base, other="chain: disc_brake\n")[1]
