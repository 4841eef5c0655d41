"""The report stage: products in, one page and its companion file out."""

from pipeline.contract import Context
from stages.report import Settings, report
from tests.views import products_for_views as small

FEW = Settings(dots_per_inch=50, mode_pictures=1)


def written(**products):
    return report(products, settings=FEW, context=Context(case=small.case()))


def test_the_same_products_give_the_same_bytes():
    def some():
        return written(reduced_model=small.reduced_model(), complex_modes=small.complex_modes(), squeal=small.squeal())

    assert some().html.item() == some().html.item()


def test_other_products_give_other_bytes():
    assert written(squeal=small.squeal(quiet=True)).html.item() != written(squeal=small.squeal()).html.item()


def test_page_and_verdict_are_the_companion_files():
    product = written()
    assert report.companions(product, None) == {"report.html": product.html.item(),
                                                  "verdict.json": product.verdict.item()}


def test_missing_products_leave_out_their_chapters_only():
    html = written(surface=small.surface()).html.item()
    assert '<section id="surface">' in html
    assert '<section id="squeal">' not in html
    assert "No verdict" in html


def test_the_contract_is_declared():
    assert report.reads_case
    assert report.reads_all and not report.inputs
    assert report.method.format(**FEW.model_dump())
