"""Every case of the project fits the JSON schema that 'brakechain schema' prints, and what is wrong does not."""

import json
from copy import deepcopy
from pathlib import Path

import pytest
from click.testing import CliRunner

from pipeline.cli.main import cli
from pipeline.contract import documents
from stages import CHAINS
from tests.json_schema import faults

ROOT = Path(__file__).parents[2]
CASES = sorted((ROOT / "configs").glob("*.yaml"))


@pytest.fixture(scope="module")
def schema():
    done = CliRunner().invoke(cli, ["schema"])
    assert done.exit_code == 0
    return json.loads(done.stdout)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_a_case_fits_the_schema(path, schema):
    assert not faults(documents.read_yaml(path), schema, schema)


def test_every_stage_of_every_chain_is_a_section(schema):
    chains = schema.get("anyOf", [schema])
    told = {chain["properties"]["chain"]["const"]: chain["properties"].keys() for chain in chains}
    assert told.keys() == CHAINS.keys()
    assert all(set(CHAINS[name]) <= told[name] for name in CHAINS)


@pytest.mark.parametrize("steps, value, said", [
    (["squeal", "windwo"], "10 ms", "case.squeal.windwo: unknown key"),
    (["sqeual"], {}, "case.sqeual: unknown key"),
    (["squeal", "window"], [1], "case.squeal.window: type"),
    (["squeal", "overlap"], "much", "case.squeal.overlap: type number"),
    (["squeal", "overlap"], 0.9, "case.squeal.overlap: maximum 0.8"),
    (["structure", "disc", "bolt_count"], {"value": "five", "origin": "user"}, "bolt_count"),
    (["structure", "disc", "bolt_count"], {"value": 5, "origin": "guessed"}, "origin"),
    (["structure", "pressures"], [], "case.structure.pressures: minItems 1"),
    (["surface", "disc", "kind"], "turned", "case.surface.disc"),
    (["surface", "disc", "seed"], True, "case.surface.disc.seed: type integer"),
    (["multibody", "integrator"], "euler", "case.multibody.integrator: enum"),
    (["comparison", "tuned", "real_area"], 3, "case.comparison.tuned"),
    (["chain"], "none", "case.chain: const"),
])
def test_what_does_not_fit_is_found(steps, value, said, schema):
    base, case = (documents.read_yaml(ROOT / "configs" / f"disc_brake{name}.yaml") for name in ("", "_paper_joints"))
    document = deepcopy({**base, **case, "structure": base["structure"], "comparison": base["comparison"]})
    place = document
    for step in steps[:-1]:
        place = place[step]
    place[steps[-1]] = value
    found = faults(document, schema, schema)
    assert found and any(said in fault for fault in found), found
