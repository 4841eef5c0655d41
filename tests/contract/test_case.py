"""A case file is checked whole before anything is computed."""

from types import SimpleNamespace
from typing import Literal

import pytest

from pipeline.contract import ConfigError, InputFile, OneOf, Section, case, documents, option, settings
from tests.contract.toy import CHAINS, load

YAML = """
chain: toy
title: A toy
source:
  duration: {value: 3 s, origin: stated, source: "page 2"}
doubled:
  factor: 4
"""


@pytest.fixture
def config(tmp_path):
    path = tmp_path / "toy.yaml"
    path.write_text(YAML)
    return path


def loaded(path, *overrides):
    return case.load(path, CHAINS, load, overrides)


def test_sections_origins_and_methods(config):
    toy = loaded(config)
    assert toy.sections["source"].duration == 3.0 and toy.sections["doubled"].factor == 4.0
    card = toy.card("0.1")
    assert card.origins["source"] == {"duration": {"origin": "stated", "source": "page 2"}, "level": {}}
    assert card.methods["source"] == "Signals of {duration} were made." and card.units["source"]["duration"] == "s"


def test_overrides_replace_the_value_and_its_origin(config):
    toy = loaded(config, "source.duration=5 s", "doubled.factor=3")
    assert toy.sections["source"].duration == 5.0 and toy.sections["doubled"].factor == 3.0
    assert toy.card("").origins["source"] == {"duration": {"origin": "user"}, "level": {}}


def test_origins_reach_what_they_hold_and_bare_values_are_the_users():
    given = {"a": {"value": [1, {"b": 2}], "origin": "stated"}, "c": 3}
    assert case._origin(given, ["a", "1", "b"]) == {"origin": "stated"}
    assert case._origin(given, ["c"]) == {"origin": "user"} and case._origin(given, ["d"]) == {}


def test_an_alias_is_a_copy(tmp_path):
    path = tmp_path / "alias.yaml"
    path.write_text("a: &list [1, 2]\nb: *list\n")
    document = documents.read_yaml(path)
    document["a"][0] = 9
    assert document["b"] == [1, 2]


@pytest.mark.parametrize("text, message", [
    ("chain: tuy", "chain: expected one of toy, varied, beside, searched, or sections, found 'tuy'"),
    ("chain: toy\nsuorce: {}", "suorce: unknown section; did you mean 'source'?"),
    ("chain: toy\nsource: {duration: -3 s}", "source.duration: input should be greater than 0"),
    ("chain: toy\nsource: {}\nsource: {}", "expected 'source' once, found it again"),
    ("chain: toy\nsource: {duration: 1 s, duration: 2 s}", "expected 'duration' once, found it again"),
    ("chain: toy\nsource: {duration: {value: 1 s, orgin: user}}", "duration.orgin: unknown key beside"),
    ("chain: [toy", "expected valid YAML"), ("- 1", "expected a mapping of sections"),
    ("chain: toy\nsolver: fast", "solver: expected one of auto, pypardiso, superlu"),
    ("chain: toy\ntitle: [1]", "title: expected text"),
    ("chain: toy\nsource: 3", "source: expected a mapping of settings"),
    ("chain: [toy]", "chain: expected one of toy, varied, beside, searched, or sections, found ['toy']"),
    ("chain: toy\ntitle: 2020-13-45", "bad.yaml:2: expected a timestamp, found '2020-13-45' (month must be in 1..12)"),
    ("chain: toy\nsource: {duration: !!bool 3 s}", "bad.yaml:2: expected a bool, found '3 s'; correct it, or quote"),
    ("chain: toy\ntitle: !!int x", "bad.yaml:2: expected a int, found 'x'"),
    ("chain: toy\n? {a: 1}\n: 3", "bad.yaml"), ("chain: toy\nsource: &a {duration: *a}", "bad.yaml"),
])
def test_refusals(tmp_path, text, message):
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(ConfigError) as error:
        loaded(path)
    assert message in str(error.value) and "bad.yaml" in str(error.value)


@pytest.mark.parametrize("override", ["duration=3 s", "source.duration", "source.duration.x.y=3",
                                      "source.durations=1 s"])
def test_bad_overrides_are_refused(config, override):
    with pytest.raises(ConfigError):
        loaded(config, override)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(ConfigError, match="none.yaml: expected a YAML file, found none"):
        loaded(tmp_path / "none.yaml")


def test_a_case_may_be_based_on_another(config):
    other = config.with_name("other.yaml")
    other.write_text("based_on: toy.yaml\ntitle: Another\ndoubled: {factor: 7}\n")
    case_ = loaded(other)
    assert case_.sections["source"].duration == 3.0 and case_.sections["doubled"].factor == 7.0
    assert case_.card("").origins["source"]["duration"]["origin"] == "stated" and case_.card("").title == "Another"


def test_null_takes_back_what_a_base_states(config):
    """In place of a value, with its origin or without; over a section it says nothing."""
    other = config.with_name("other.yaml")
    other.write_text("based_on: toy.yaml\nsource: {duration: null}\ndoubled: null\n")
    found = case._read(other, {})[0]
    assert found["source"]["duration"] is None and isinstance(found["doubled"], dict)


def test_a_value_that_tells_its_unit_is_no_annotation(config):
    given = {"load": {"value": 5, "unit": "N"}}
    assert settings.without_origins(given, "x") == given
    assert settings.without_origins({"load": {"value": given["load"], "origin": "measured"}}, "x") == given
    with pytest.raises(ConfigError, match="x.load.orgin: unknown key"):
        settings.without_origins({"load": {"value": 5, "orgin": "user"}}, "x")


def test_a_case_of_another_chain_leaves_what_it_has_no_stage_for(config):
    """Sections of the base that only its chain has are left; a misspelt one of its own is still refused."""
    class Any(Section):
        model_config = {"extra": "allow"}

    def named(name):
        return SimpleNamespace(name=name, settings=Any, check=lambda sections: None, varied={})

    chains = {"toy": ("source", "doubled"), "short": ("source",)}
    base, other = config.with_name("base.yaml"), config.with_name("other.yaml")
    base.write_text("chain: toy\nsource: {}\ndoubled: {}\n")
    other.write_text("based_on: base.yaml\nchain: short\n")
    assert set(case.load(other, chains, named).document) == {"based_on", "chain", "source"}
    other.write_text("based_on: base.yaml\nchain: short\ndoubled: {}\n")
    with pytest.raises(ConfigError, match="doubled: unknown section"):
        case.load(other, chains, named)


def test_files_are_found_beside_the_case_and_beside_its_base(config, tmp_path):
    (tmp_path / "own").mkdir()
    other = tmp_path / "own" / "other.yaml"
    other.write_text("based_on: ../toy.yaml")
    assert loaded(other).folders == (other.parent, other.parent / "..")


class Files(Section):
    """Files that a case names."""

    scan: InputFile = option(..., "one file")
    more: tuple[InputFile, ...] = option((), "more files")


def files_of(path, *overrides):
    """Filled section 'source' of a case whose only stage reads files."""
    reader = SimpleNamespace(name="source", settings=Files, check=lambda sections: None, varied={})
    return case.load(path, {"toy": ("source",)}, lambda name: reader, overrides).sections["source"]


@pytest.mark.parametrize("named", ["scan.dat", "{value: scan.dat, origin: measured}"])
def test_a_file_beside_the_yaml_that_names_it_comes_first(tmp_path, named, monkeypatch):
    """A file of the same name beside a case that is based on it does not stand in for it; nor the other way round."""
    for folder in ("base", "own", "here"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "scan.dat").write_text(folder)
    base, own = tmp_path / "base" / "base.yaml", tmp_path / "own" / "own.yaml"
    base.write_text(f"chain: toy\nsource: {{scan: {named}, more: [{named}]}}")
    own.write_text("based_on: ../base/base.yaml")
    monkeypatch.chdir(tmp_path / "here")
    assert files_of(own).scan.read_text() == files_of(own).more[0].read_text() == "base"
    assert files_of(own, "source.scan=scan.dat").scan.read_text() == "own"
    own.write_text(f"based_on: ../base/base.yaml\nsource: {{scan: {named}}}")
    assert files_of(own).scan.read_text() == "own" and files_of(own).more[0].read_text() == "base"
    (tmp_path / "own" / "scan.dat").unlink()
    assert files_of(own).scan.read_text() == "base", "what is not beside the case is looked for beside its base"


def test_another_kind_replaces_the_whole_mapping():
    base = {"pad": {"kind": "generated", "seed": 3}, "n": {"value": 3, "origin": "stated"}}
    assert case._laid_over(base, {"pad": {"kind": "scan", "file": "a"}})["pad"] == {"kind": "scan", "file": "a"}
    assert case._laid_over(base, {"pad": {"seed": 4}})["pad"] == {"kind": "generated", "seed": 4}
    assert case._laid_over(base, {"n": 4})["n"] == 4


@pytest.mark.parametrize("written", ["{}", "null", "{based_on: null}"])
def test_mappings_and_lists_of_a_base_are_cleared(config, written):
    """What is written replaces; only a mapping with keys is laid over, unless it says that it is based on nothing."""
    base, other = config.with_name("base.yaml"), config.with_name("other.yaml")
    base.write_text("chain: toy\nsource: {tuned: {a: x, b: y}, list: [1, 2], n: {value: 2, origin: stated}}\n")

    def read(source):
        other.write_text(f"based_on: base.yaml\nsource: {{{source}}}\n")
        return case._read(other, {"toy": ("source",)})[0]["source"]

    assert not read(f"tuned: {written}")["tuned"] and read(f"tuned: {written}")["list"] == [1, 2]
    assert read("tuned: {a: z}")["tuned"] == {"a": "z", "b": "y"}
    assert read("tuned: {based_on: null, c: z}")["tuned"] == {"c": "z"}
    assert read("list: []")["list"] == [] and read("list: null")["list"] is None
    assert read("n: {value: 3}")["n"] == {"value": 3}, "an annotated value is replaced with its origin"
    other.write_text("based_on: base.yaml\nsource: {}\n")
    assert case._read(other, {"toy": ("source",)})[0]["source"] == {}, "{} clears a whole section"


def test_a_mapping_based_on_nothing_needs_no_base(config):
    config.write_text("chain: toy\nsource: {tuned: {based_on: null, c: z}}\n")
    assert case._read(config, {})[0]["source"] == {"tuned": {"c": "z"}}


def test_a_circle_of_cases_is_refused(tmp_path):
    (tmp_path / "a.yaml").write_text("based_on: b.yaml")
    (tmp_path / "b.yaml").write_text("based_on: a.yaml")
    with pytest.raises(ConfigError, match="a file that does not lead back here"):
        loaded(tmp_path / "a.yaml")


@pytest.mark.parametrize("further, message", [
    ("doubeld.factor: 3", "variant further of compared: .*doubeld: unknown section; did you mean 'doubled'"),
    ("doubled.facto: 3", "variant further of compared: .*doubled.facto: unknown key; did you mean 'factor'"),
    ("source.level: 3 kg", "variant further of compared: .*source.level: expected a quantity in Pa"),
    ("source.duration: 5 s", "compared: further: expected the duration of the case")])
def test_variants_are_checked_with_the_case(tmp_path, further, message):
    """Before anything is computed: whatever a stage declares must be a case that runs."""
    path = tmp_path / "varied.yaml"
    path.write_text("chain: varied\ncompared: {further: {doubled.factor: 3}}\n")
    assert loaded(path).sections["compared"].further == {"doubled.factor": 3}
    path.write_text(f"chain: varied\ncompared: {{further: {{{further}}}}}\n")
    with pytest.raises(ConfigError, match=message):
        loaded(path)


class Ground(Section):
    """Nothing to state."""

    kind: Literal["ground"] = option("ground", "kind")
    name: str = option("", "of both kinds")


class Body(Section):
    """Something to state."""

    kind: Literal["body"] = option("body", "kind")
    name: str = option("", "of both kinds")
    loss_factor: float = option(0.0, "of this one alone")


class Held(Section):
    """A part of one of two kinds, and several of them."""

    bracket: OneOf(Ground, Body) = option(Ground(), "one")


def of_kind(path, *overrides):
    """A case whose only stage holds a part of two kinds."""
    stage = SimpleNamespace(name="source", settings=Held, check=lambda sections: None, varied={})
    return case.load(path, {"toy": ("source",)}, lambda name: stage, overrides)


def test_a_section_that_becomes_another_kind_keeps_what_both_have(tmp_path):
    """By a variant or --set, in whatever order; a value that is asked for beside it and does not fit is refused."""
    path = tmp_path / "a.yaml"
    path.write_text("chain: toy\nsource:\n"
                    "  bracket: {kind: {value: body, origin: stated}, loss_factor: 0.1, name: b}\n")
    whole = of_kind(path)
    assert whole.sections["source"].bracket == Body(loss_factor=0.1, name="b")
    for other in (whole.varied({"source.bracket.kind": "ground"}), of_kind(path, "source.bracket.kind=ground"),
                  of_kind(path, "source.bracket.name=b", "source.bracket.kind=ground")):
        assert other.sections["source"].bracket == Ground(name="b")
    back = whole.varied({"source.bracket.loss_factor": 0.2, "source.bracket.kind": "body"})
    assert back.sections["source"].bracket == Body(loss_factor=0.2, name="b")
    with pytest.raises(ConfigError, match="loss_factor: unknown key; known: kind, name"):
        _ = whole.varied({"source.bracket.loss_factor": 0.2, "source.bracket.kind": "ground"}).sections
    with pytest.raises(ConfigError, match="bracket"):
        _ = whole.varied({"source.bracket.kind": "air"}).sections
    path.write_text("chain: toy\nsource: {bracket: {kind: body, los_factor: 0.1}}\n")
    with pytest.raises(ConfigError, match="los_factor: unknown key"):
        of_kind(path, "source.bracket.kind=ground")
