"""One report of small products, shared by the tests that read it."""

import pytest

from pipeline.contract import Context
from stages.report import Settings, report
from tests.views import products_for_views as small


@pytest.fixture(scope="session")
def html():
    """The page of all small products, with few and coarse pictures."""
    few = Settings(dots_per_inch=50, mode_pictures=1)
    return report(small.products(), settings=few, context=Context(case=small.case())).html.item()
