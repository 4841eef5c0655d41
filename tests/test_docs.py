"""The documents name what exists: functions, product fields, packages, pages."""

import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
import textwrap
from dataclasses import fields
from pathlib import Path

import click
import numpy as np
import pytest

import stages
from pipeline import products
from pipeline.cli.main import cli
from pipeline.contract.product import is_product
from pipeline.effects.effect import null_values
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import let_go, sprung

ROOT = Path(__file__).parents[1]
HOPS = (ROOT / "docs" / "where_numbers_come_from.md").read_text()
FIELDS = {cls.__name__: {f.name for f in fields(cls)} for cls in filter(is_product, vars(products).values())}


def test_every_function_on_the_way_of_a_number_exists():
    named = re.findall(r"`((?:pipeline|stages)/[\w/]+\.py):(\w+)`", HOPS)
    assert len(named) > 12
    for file, function in named:
        tree = ast.parse((ROOT / file).read_text())
        assert function in {n.name for n in tree.body if isinstance(n, ast.FunctionDef)}, f"{file}:{function}"


def test_every_step_from_a_channel_to_the_verdict_exists():
    page = (ROOT / "docs" / "diagnosis_pipeline.md").read_text()
    named = re.findall(r"`((?:pipeline|stages)/[\w/]+\.py)(?::([\w.]+))?`", page)
    assert len(named) > 12
    for file, name in named:
        nodes = ast.parse((ROOT / file).read_text()).body
        for part in filter(None, name.split(".")):
            node = next((n for n in nodes if getattr(n, "name", None) == part), None)
            assert node is not None, f"{file}:{name}"
            nodes = node.body


def test_every_product_field_on_the_way_of_a_number_exists():
    by_product = {re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower(): names for name, names in FIELDS.items()}
    named = [(a, b) for a, b in re.findall(r"`(\w+)\.(\w+)`", HOPS) if a in by_product and b != "py"]
    assert len(named) >= 6
    assert not [f"{product}.{field}" for product, field in named if field not in by_product[product]]


def test_the_layout_names_every_package():
    layout = (ROOT / "CONTRIBUTING.md").read_text().partition("## Layout")[2].partition("\n## ")[0]
    missing = [str(p.parent.relative_to(ROOT)) for p in (ROOT / "pipeline").rglob("__init__.py")
               if f"{p.parent.name}/" not in layout and p.parent.parent.parent.name != "views"]
    assert not missing
    assert max(len(line) for line in layout.splitlines()) <= 120 and len(layout.splitlines()) < 50, "one screen"


def inputs_of(file, name):
    """Number of inputs of a test by its parameters as written: 1 of a list that has a name."""
    node = next((n for n in ast.parse((ROOT / file).read_text()).body if getattr(n, "name", None) == name), None)
    assert node is not None, f"{file}::{name}"
    lists = [call.args[1] for call in node.decorator_list if isinstance(call, ast.Call) and len(call.args) > 1]
    return np.prod([len(each.elts) if isinstance(each, ast.List | ast.Tuple) else 1 for each in lists], initial=1)


def test_kinds_of_files_name_tests_of_three_inputs_or_more():
    page = (ROOT / "docs" / "file_kinds.md").read_text()
    rows = [line for line in page.splitlines() if line.startswith("| ") and "::" in line]
    assert len(rows) >= 26
    for row in rows:
        named = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", row)
        assert named and row.count("::") == len(named), row
        assert sum(inputs_of(*each) for each in named) >= 3, row


def test_links_between_documents_lead_somewhere():
    for page in (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")):
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.relative_to(ROOT)}: {target}"


def test_documented_commands_and_targets_exist():
    pages = (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("configs/*.yaml"))
    texts = [page.read_text() for page in pages]
    context = click.Context(cli)
    command_form = re.compile(r"(?:^[# ]+|`)brakechain ([a-z_-]+)(?: ([a-z_]+))?", re.MULTILINE)
    commands = {words for text in texts for words in command_form.findall(text)}
    assert len(commands) > 15
    for name, word in commands:
        command = cli.get_command(context, name)
        assert command, f"brakechain {name}"
        if isinstance(command, click.Group) and word:
            assert command.get_command(context, word), f"brakechain {name} {word}"
    makefile = (ROOT / "Makefile").read_text()
    targets = {*re.findall(r"^([a-z_-]+):", makefile, re.MULTILINE), *stages.NAMES}
    named = {name for text in texts for name in re.findall(r"(?:^[# ]+|`)make ([a-z][a-z_-]*)", text, re.M)}
    assert len(named) > 8
    assert not named - targets


@pytest.mark.exact
def test_the_worked_example_of_an_effect_is_an_effect():
    """Its null is the base bit for bit; a free mass slows down as the page states."""
    page = (ROOT / "docs" / "add_an_effect.md").read_text()
    code = re.search(r'^( +)"""Drag of a seal.*?(?=^\d\. )', page, re.MULTILINE | re.DOTALL)[0]
    module = {}
    exec(compile(textwrap.dedent(code), "docs/add_an_effect.md", "exec"), module)
    effect, free, run = module["EFFECT"], sprung(stiffness=1e-6, damping=0.0), let_go(0.0, speed=2.0)
    null = respond(effect.on(free, "joint_0", null_values(effect.at(free, "joint_0", (run,)))), run)
    np.testing.assert_array_equal(null["v"], respond(free, run)["v"])
    slowed = respond(effect.on(free, "joint_0", {"coefficient": 5.0}), run)["v"]
    assert slowed == pytest.approx((2.0**-0.5 + 5.0 * run.time / 2) ** -2, rel=1e-4)


def command(words, folder):
    """Output of a documented command, run in ``folder``."""
    program = [sys.executable, *(["-m", "pipeline"] if words[0] == "brakechain" else [])]
    done = subprocess.run([*program, *words[1:]], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert done.returncode == 0, f"{shlex.join(words)}: {done.stderr}"
    return done.stdout


def documented(page):
    """Commands of a page, word by word."""
    lines = re.findall(r"^    ((?:brakechain|python) .*)$", (ROOT / page).read_text(), re.MULTILINE)
    return [shlex.split(line, comments=True) for line in lines]


def test_the_plan_of_the_tutorial_is_what_is_printed():
    plan = documented("docs/tutorial.md")[0]
    printed = command(plan[:3], ROOT)
    shown = re.search(r"^    (\w+ at \w+) +(.*)$", (ROOT / "docs/tutorial.md").read_text(), re.MULTILINE)
    row = next(line for line in printed.splitlines() if shown[1] in line).split(shown[1])[1]
    assert [float(d) for d in row.split()] == pytest.approx([float(d) for d in shown[2].split()], rel=0.01, abs=0.05)
    assert "cheapest set: soft (cost 1)" in printed


@pytest.mark.slow
def test_the_commands_of_the_tutorial_lead_to_the_completed_case(tmp_path):
    shutil.copytree(ROOT / "docs/practice", tmp_path / "docs/practice", ignore=shutil.ignore_patterns("*.h5"))
    commands = documented("docs/tutorial.md")
    assert len(commands) == 6
    for words in commands:
        command([word.replace("EFFECT", "coulomb") for word in words], tmp_path)
    assert (tmp_path / "data/runs/rig/report.html").exists() and (tmp_path / "data/runs/rig/latent_force.csv").exists()
    assert (tmp_path / "data/runs/rig_with_coulomb/report.html").exists()
