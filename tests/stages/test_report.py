"""The report stage: products in, one page and its companion file out."""

import pytest

from pipeline.contract import Context
from stages.report import Settings, report
from tests.views import products_for_views as small

FEW = Settings(dots_per_inch=50, mode_pictures=1)


@pytest.fixture(scope="module")
def product():
    return report(**small.products(), settings=FEW, context=Context(case=small.case()))


def test_the_page_has_every_chapter_and_is_its_companion(product):
    html = product.html.item()
    for anchor in ("surface", "micro_friction", "friction_map", "structure", "complex_modes", "multibody", "response",
                   "squeal", "comparison", "limits", "settings", "methods"):
        assert f'<section id="{anchor}">' in html
    assert report.companions(product) == {"report.html": html}


def test_the_same_products_give_the_same_bytes(product):
    again = report(**small.products(), settings=FEW, context=Context(case=small.case()))
    assert again.html.item() == product.html.item()


def test_missing_products_leave_out_their_chapters_only():
    nothing = dict.fromkeys(small.products())
    html = report(**{**nothing, "surface": small.surface()}, settings=FEW).html.item()
    assert '<section id="surface">' in html
    assert '<section id="squeal">' not in html
    assert "No verdict" in html


def test_the_contract_is_declared():
    assert report.reads_case
    assert set(report.optional) == set(report.inputs)
    assert report.method.format(**FEW.model_dump())
