"""A new case: short, commented, of no paper, checked by the program as it stands."""

import re
import textwrap

import pytest
import yaml
from click.testing import CliRunner

import stages
from pipeline.cli.main import cli
from pipeline.cli.new_case import ASKED
from pipeline.contract import case
from pipeline.contract.settings import leaves
from tests.commands import ROOT


def made(folder, *options, entered="", code=0):
    """(case file, what was printed) of 'new my_brake' in a folder."""
    done = CliRunner().invoke(cli, ["new", str(folder / "my_brake"), *options], input=entered)
    assert done.exit_code == code, done.output + str(done.exception)
    return folder / "my_brake.yaml", done.output


def loaded(file):
    return case.load(file, stages.CHAINS, stages.load)


def values(brake):
    """{stage: {dotted setting: value}}."""
    return {s.name: {key: value for key, value, *_ in leaves(brake.sections[s.name])} for s in brake.stages}


def test_a_new_case_is_short_and_checked(tmp_path):
    """Nothing of a paper in it; what is not written is a default of the program, parts that are meshed included."""
    file, printed = made(tmp_path)
    text = file.read_text()
    assert len(text.splitlines()) <= 100 and f"brakechain run {file}" in printed
    assert not any(word in text.lower() for word in ("paper", "tuned", "reference", "table 1"))
    brake = loaded(file)
    assert brake.document["chain"] == "own_brake" and "comparison" not in brake.sections
    card = brake.card("")
    origins = {each.get("origin") for rows in card.origins.values() for each in rows.values()}
    assert origins == {None, "user", "assumed"}
    assert card.origins["structure"]["disc.ring_thickness"] == {}, "behind a # it is a default"
    assert card.settings["structure"]["bracket.kind"] == card.settings["structure"]["piston.kind"] == "body"


def test_every_commented_value_is_the_default_that_it_says(tmp_path):
    """With every # before a value taken away the case is the same."""
    file = made(tmp_path)[0]
    before = values(loaded(file))
    lines = [line.replace("# ", "", 1) if line.startswith(" ") and line.lstrip().startswith("# ") else line
             for line in file.read_text().splitlines()]
    assert sum(":" in line for line in lines) > 60
    file.write_text("\n".join(lines))
    assert yaml.safe_load(file.read_text())["structure"]["disc"]["ring_thickness"] == "6.87 mm"
    assert before == values(loaded(file))


def test_its_example_of_a_countermeasure_is_one(tmp_path):
    file = made(tmp_path)[0]
    head, found, example = file.read_text().partition("# countermeasures:")
    file.write_text(head + found.removeprefix("# ") + example.replace("\n#", "\n"))
    assert list(loaded(file).sections["countermeasures"].variants) == ["shim"]


def test_answers_stand_in_it_as_the_users(tmp_path):
    """Asked again where a quantity is of another unit or not positive; Enter keeps the typical value."""
    file, printed = made(tmp_path, "--ask", entered="7 kg\n-1 mm\n150 mm\n" + "\n" * (len(ASKED) - 1))
    assert "expected a quantity in m" in printed and "expected more than 0" in printed
    brake = loaded(file)
    assert brake.sections["structure"].disc.ring_outer_radius == pytest.approx(0.15)
    origins = brake.card("").origins["structure"]
    assert origins["disc.ring_outer_radius"]["origin"] == "user" and origins["disc.ring_inner_radius"] == {}


def test_a_quick_variant_is_the_same_brake_on_coarse_grids(tmp_path):
    file = made(tmp_path, "--quick")[0]
    fine, quick = loaded(file).sections, loaded(file.with_name("my_brake_quick.yaml")).sections
    assert quick["structure"].disc.angular_cells < fine["structure"].disc.angular_cells
    for part in ("joints", "piston"):
        assert getattr(quick["structure"], part) == getattr(fine["structure"], part)


def test_no_file_is_overwritten(tmp_path):
    made(tmp_path)
    assert "a name that is free" in str(CliRunner().invoke(cli, ["new", str(tmp_path / "my_brake.yaml")]).exception)
    assert "a folder" in str(CliRunner().invoke(cli, ["new", str(tmp_path / "none" / "brake")]).exception)


#: indented blocks of the page on brakes of one's own that begin with a section of a case
BLOCKS = [textwrap.dedent(block) for block in re.findall(r"(?:^    .*\n|^\n(?=    ))+", (
    ROOT / "docs" / "own_brake.md").read_text(), re.MULTILINE)]
EXAMPLES = {block.partition(":")[0].strip(): block for block in BLOCKS
            if block.partition(":")[0].strip() in stages.CHAINS["own_brake"] and "mesh_file" not in block}


@pytest.mark.parametrize("section", EXAMPLES)
def test_the_examples_of_the_page_fit_what_is_written(tmp_path, section):
    """On the case as on its quick one, with every variant that they ask for."""
    assert {"sensitivities", "countermeasures", "design_search"} <= set(EXAMPLES)
    made(tmp_path, "--quick")
    for base in ("my_brake.yaml", "my_brake_quick.yaml"):
        (tmp_path / "example.yaml").write_text(f"based_on: {base}\n{EXAMPLES[section]}")
        assert section in loaded(tmp_path / "example.yaml").document
