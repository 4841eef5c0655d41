"""The report page of a case."""

from operator import call

from pipeline.contract import Context, Products, Section, option, stage
from pipeline.products import Report


class Settings(Section):
    """Figures of the report."""

    dots_per_inch: int = option(150, "resolution of the pictures that are not line drawings", ge=50, le=600)
    mode_pictures: int = option(6, "mode shapes drawn of the disc; 0 = none, and no unstable mode moves", ge=0, le=40)


def _companions(product, case):
    return {"report.html": product.html.item(), "verdict.json": product.verdict.item()}


@stage(companions=_companions, reads_case=True)
def report(products: Products, settings: Settings, context: Context) -> Report:
    """Write the HTML report with figures, tables, settings and methods.

    Method:
    Figures were drawn from the data products only ({dots_per_inch} dots per inch, up to {mode_pictures} mode shapes
    of the disc); every number in this report is read from a product or from the settings.
    """
    from pipeline.views.chapters.chapter import Look
    from pipeline.views.pages.report import LONGEST, page, plan
    from pipeline.views.pages.summary import verdict
    from pipeline.views.pages.verdict_file import verdict_text

    look = Look(settings.dots_per_inch, settings.mode_pictures)
    planned = plan(products, look)
    order = sorted(planned, key=lambda name: name != LONGEST)
    made = dict(zip(order, context.map(call, [planned[name] for name in order], "chapters"), strict=True))
    chapters = [made[name] for name in planned if made[name] is not None]
    return Report(html=page(chapters, products, context.case, look),
                  verdict=verdict_text(verdict(products, ()), products))
