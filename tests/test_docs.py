"""The documents name what exists: functions, product fields, packages, pages."""

import ast
import re
from dataclasses import fields
from pathlib import Path

from pipeline import products
from pipeline.contract.product import is_product

ROOT = Path(__file__).parents[1]
HOPS = (ROOT / "docs" / "where_numbers_come_from.md").read_text()
FIELDS = {cls.__name__: {f.name for f in fields(cls)} for cls in filter(is_product, vars(products).values())}


def test_every_function_on_the_way_of_a_number_exists():
    named = re.findall(r"`((?:pipeline|stages)/[\w/]+\.py):(\w+)`", HOPS)
    assert len(named) > 12
    for file, function in named:
        tree = ast.parse((ROOT / file).read_text())
        assert function in {n.name for n in tree.body if isinstance(n, ast.FunctionDef)}, f"{file}:{function}"


def test_every_product_field_on_the_way_of_a_number_exists():
    by_product = {re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower(): names for name, names in FIELDS.items()}
    named = [(a, b) for a, b in re.findall(r"`(\w+)\.(\w+)`", HOPS) if a in by_product and b != "py"]
    assert len(named) >= 6
    assert not [f"{product}.{field}" for product, field in named if field not in by_product[product]]


def test_the_layout_names_every_package():
    layout = (ROOT / "CONTRIBUTING.md").read_text().partition("## Layout")[2].partition("## Add a stage")[0]
    missing = [str(p.parent.relative_to(ROOT)) for p in (ROOT / "pipeline").rglob("__init__.py")
               if f"{p.parent.name}/" not in layout and p.parent.parent.parent.name != "views"]
    assert not missing
    assert max(len(line) for line in layout.splitlines()) <= 120 and len(layout.splitlines()) < 60


def test_links_between_documents_lead_somewhere():
    for page in (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")):
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.relative_to(ROOT)}: {target}"
