"""Chains that follow from the sections of a case."""

import pytest

import stages
from pipeline.contract import ConfigError, case
from pipeline.contract.chain import from_sections
from tests.contract import toy

TOY = {name: toy.load(name) for name in ("source", "doubled", "compared", "mean", "sought")}


@pytest.fixture(scope="module")
def every():
    return {name: stages.load(name) for name in stages.NAMES}


def test_what_a_section_cannot_do_without_joins(every):
    assert from_sections({"doubled"}, TOY, "x") == ("source", "doubled")
    found = from_sections({"title", "lumped", "probability", "countermeasures"}, every, "x")
    assert found == ("lumped", "reduced_model", "complex_modes", "probability", "countermeasures", "report")


def test_each_stage_follows_what_it_reads(every):
    sections = {"structure", "friction_map", "micro_friction", "surface", "limit_cycle", "effects"}
    names = from_sections(sections, every, "x")
    written = {every[name].output.name: k for k, name in enumerate(names)}
    for k, name in enumerate(names):
        for products in every[name].inputs.values():
            assert all(written.get(product.name, -1) < k for product in products), name
    assert names[-1] == "report"


def test_one_of_several_must_be_named(every):
    with pytest.raises(ConfigError, match="a section for what it reads: .*lumped.* found none"):
        from_sections({"complex_modes"}, every, "case.yaml")
    with pytest.raises(ConfigError, match="a chain, or sections of stages"):
        from_sections({"title"}, every, "case.yaml")


@pytest.mark.parametrize("head", ["", "chain: sections\n"])
def test_a_case_without_a_chain_says_that_of_its_sections(tmp_path, head):
    path = tmp_path / "toy.yaml"
    path.write_text(head + "source: {duration: 3 s}\ndoubled: {factor: 4}\n")
    found = case.load(path, toy.CHAINS, toy.load)
    assert found.document["chain"] == "toy" and [s.name for s in found.stages] == ["source", "doubled"]
