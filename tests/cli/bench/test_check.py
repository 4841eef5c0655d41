"""Command 'check': what is told before anything long."""

import yaml

from tests.cli.bench.rigs import driven
from tests.commands import brakechain


def checked(folder, change=lambda case: None, **record):
    """What check prints of the first case of a shaft, changed."""
    file = driven(folder, **record)
    if not (folder / "mine.yaml").exists():
        brakechain("new", "mine", "--from", file.name, cwd=folder)
    case = yaml.safe_load((folder / "mine.yaml").read_text())
    change(case)
    (folder / "other.yaml").write_text(yaml.safe_dump(case))
    return brakechain("check", "other.yaml", cwd=folder).stdout


def test_it_says_what_is_identifiable_what_can_be_told_and_what_it_costs(tmp_path):
    told = checked(tmp_path)
    assert "values that these runs tell" in told and "masses.shaft" in told and "coulomb at bearing" in told
    assert "the diagnosis of" in told and "sign" not in told


def test_a_sign_against_the_record_is_doubted(tmp_path):
    def turned(case):
        case["lumped"]["inputs"]["torque"]["along"]["shaft.rotation"] = -1

    assert "a sign is wrong; write -1" in checked(tmp_path, turned)


def test_two_values_that_only_go_together_and_one_that_nothing_tells(tmp_path):
    def doubled(case):
        case["lumped"]["springs"]["second"] = {"between": ["shaft.rotation", "ground"],
                                               "torsional_damping": "0.1 N m s/rad"}
        case["lumped"]["springs"]["weak"] = {"between": ["shaft.rotation", "ground"],
                                             "torsional_stiffness": "1e-9 N m/rad"}
        case["diagnosis"]["parameters"] |= {"joints.second.damping": {"spread": 0.7},
                                            "joints.weak.stiffness": {"spread": 0.2}}

    told = checked(tmp_path, doubled)
    assert "joints.bearing.damping and joints.second.damping only go together" in told
    assert "next to nothing, so that they stay as stated: joints.weak.stiffness" in told


def test_without_a_held_out_run_it_says_so(tmp_path):
    assert "no run is held out" in checked(tmp_path, lambda case: case["diagnosis"].pop("held_out"))


def test_another_chain_is_refused(tmp_path):
    assert "whose recordings can be checked" in brakechain("check", "configs/belt.yaml", code=2).stderr


def test_an_input_that_nothing_feeds_is_told(tmp_path):
    def idle(case):
        case["lumped"]["inputs"]["weight"] = {"along": {"shaft.rotation": 1}, "torque": "3 N m"}

    assert "the input weight does nothing" in checked(tmp_path, idle)
