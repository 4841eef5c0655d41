"""Settings: strict, and their messages are part of the contract."""

import json
from typing import Literal

import pytest

from pipeline.contract import ConfigError, InputFile, NamedFile, Quantities, Quantity, Section, option
from pipeline.contract.fingerprint import settings_of
from pipeline.contract.settings import fill, leaves, restored, stored, without_origins


class Ring(Section):
    """A nested section."""

    thickness: Quantity("m", gt=0) = option("6.87 mm", "ring thickness")


class Settings(Section):
    """Everything a section can hold."""

    ring: Ring = option(Ring(), "the ring")
    pressures: Quantities("Pa", gt=0) = option(("1 MPa", "2 MPa"), "pressures")
    steps: int = option(41, "steps", gt=1)
    kind: Literal["one", "two"] = option("one", "kind")
    scan: InputFile | None = option(None, "a file")


def test_defaults_and_units():
    filled = fill(Settings, {"ring": {"thickness": "7 mm"}}, "c.yaml: s")
    assert filled.ring.thickness == pytest.approx(0.007) and filled.pressures == (1e6, 2e6)


@pytest.mark.parametrize("values, message", [
    ({"stepz": 3}, "c.yaml: s.stepz: unknown key; did you mean 'steps'?"),
    ({"ring": {"thicknes": "1 mm"}}, "c.yaml: s.ring.thicknes: unknown key; did you mean 'thickness'?"),
    ({"ring": {"thickness": "1 kg"}},
     "c.yaml: s.ring.thickness: expected a quantity in m, such as \"12 mm\", found '1 kg'"),
    ({"ring": {"thickness": "-1 mm"}}, "c.yaml: s.ring.thickness: input should be greater than 0, found '-1 mm'"),
    ({"pressures": []}, "c.yaml: s.pressures: "), ({"steps": 4.5}, "c.yaml: s.steps: "),
    ({"pressures": ["1 MPa", "2 m"]}, "c.yaml: s.pressures.1: expected a quantity in Pa"),
    ({"kind": "three"}, "c.yaml: s.kind: input should be 'one' or 'two', found 'three'"),
    ({"scan": "nowhere.dat"}, "c.yaml: s.scan: expected a file, found none at 'nowhere.dat'"),
    ([], "c.yaml: s: expected a mapping of settings, found []"),
])
def test_refusals_say_where_expected_found(values, message):
    with pytest.raises(ConfigError) as error:
        fill(Settings, values, "c.yaml: s")
    assert message in str(error.value)


def test_every_mistake_is_told_at_once():
    with pytest.raises(ConfigError) as error:
        fill(Settings, {"stepz": 3, "kind": "three"}, "c")
    assert len(str(error.value).splitlines()) == 2


def test_files_are_found_from_the_folder_of_the_yaml_or_by_name_of_the_measurement(tmp_path):
    (tmp_path / "a.dat").write_text("x")
    context = {"folders": [tmp_path], "measured": {"scan": tmp_path / "a.dat"}.__getitem__}
    assert fill(Settings, {"scan": "a.dat"}, "c", context).scan == tmp_path / "a.dat"
    assert fill(Settings, {"scan": "measured:scan"}, "c", context).scan == tmp_path / "a.dat"
    with pytest.raises(ConfigError, match="other"):
        fill(Settings, {"scan": "measured:other"}, "c", context)


def test_origins_are_split_from_values():
    given = {"ring": {"thickness": {"value": "7 mm", "origin": "stated", "source": "Table 1"}}, "steps": [{"value": 3}]}
    assert without_origins(given, "c.yaml: s") == {"ring": {"thickness": "7 mm"}, "steps": [3]}
    with pytest.raises(ConfigError, match="c.yaml: s.ring.origin: expected one of stated"):
        without_origins({"ring": {"value": 1, "origin": "guessed"}}, "c.yaml: s")


def test_leaves_tell_units_and_meanings():
    told = {leaf.key: (leaf.value, leaf.unit, leaf.meaning) for leaf in leaves(Settings())}
    assert told["ring.thickness"] == (pytest.approx(0.00687), "m", "ring thickness")
    assert told["pressures"] == ((1e6, 2e6), "Pa", "pressures") and told["steps"] == (41, "", "steps")


def test_leaves_tell_what_has_no_effect():
    class Shim(Section):
        only_with = {"rubber": ("density",)}
        rubber: float = option(0.0, "rubber")
        density: float = option(1200.0, "its density")

    class Pad(Section):
        shim: Shim = option(Shim(), "shim")

    assert {leaf.key: leaf.idle for leaf in leaves(Pad())} == {"shim.rubber": "", "shim.density": "shim.rubber"}
    assert not any(leaf.idle for leaf in leaves(Pad(shim=Shim(rubber=1e-4))))


def test_a_document_of_a_folder_is_named_and_others_are_files(tmp_path):
    (tmp_path / "one.yaml").write_text("{}")
    (tmp_path / "two.yaml").write_text("{}")

    class Named(Section):
        """A section with a named document."""

        which: NamedFile(tmp_path) = option("one", "a document")

    assert Named().which == tmp_path / "one.yaml"
    assert fill(Named, {"which": str(tmp_path / "two.yaml")}, "c").which == tmp_path / "two.yaml"
    for wrong, said in (("onw", "expected one, two or a YAML file, found 'onw'"), ("x.yaml", "expected a file"),
                        (3, "expected one, two or a YAML file")):
        with pytest.raises(ConfigError, match=said):
            fill(Named, {"which": wrong}, "c")


class Inner(Section):
    size: float = option(2.0, "size")


class Holding(Section):
    inner: Inner = option(Inner(), "a section")
    either: Inner | None = option(Inner(), "a section or none")
    many: tuple[float, ...] = option((1.0, 2.0), "a list")
    named: dict[str, str] = option({"a": "b"}, "a mapping")
    speeds: Quantities("m/s") = option(("1 m/s",), "quantities")
    number: float = option(1.0, "a number")


def test_null_stands_for_the_default_of_what_holds_many():
    """Of a section, list or mapping; where none is a value of its own it stays none, and a number needs one."""
    nothing = dict.fromkeys(("inner", "either", "many", "named", "speeds"))
    filled = fill(Holding, nothing, "x")
    assert filled == Holding(either=None)
    assert fill(Holding, {"many": [], "named": {}}, "x").many == ()
    with pytest.raises(ConfigError, match="number"):
        fill(Holding, {"number": None}, "x")


def test_a_section_that_names_a_file_comes_back_from_what_it_is_stored_as(tmp_path):
    (tmp_path / "a.dat").write_text("1")
    section = fill(Settings, {"scan": str(tmp_path / "a.dat"), "pressures": ["3 bar"]}, "c.yaml: s")
    assert restored(Settings, stored(section)) == section


class Deep(Section):
    """Sections two dictionaries deep, as courses of an input in a run are."""

    courses: dict[str, dict[str, Ring]] = option({}, "rings by name and number")


def test_settings_are_reached_however_deep_sections_lie():
    """Each by its dotted key, or, beside what holds none, within a value in a form that JSON keeps."""
    deep = fill(Deep, {"courses": {"load": {"a": {"thickness": "1 mm"}, "b": {}}}}, "c.yaml: s")
    assert {leaf.key: leaf.value for leaf in leaves(deep)} == {
        "courses.load.a.thickness": 0.001, "courses.load.b.thickness": 0.00687}
    assert json.loads(json.dumps(settings_of(deep))) == settings_of(deep)
    mixed = fill(Deep, {"courses": {"load": {"a": {"thickness": "1 mm"}}, "none": {}}}, "c.yaml: s")
    assert json.loads(json.dumps(settings_of(mixed)))["courses"]["load"]["a"]["thickness"] == 0.001
