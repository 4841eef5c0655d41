"""One report of small products, shared by the tests that read it."""

import re
from contextlib import contextmanager

import pytest
from matplotlib.figure import Figure

from pipeline.contract import Context
from pipeline.views.figures import style
from pipeline.views.figures.plotted.columns import Table
from stages.report import Settings, report
from tests.views import products_for_views as small


@pytest.fixture(scope="session")
def html(once):
    """The page of all small products, with few and coarse pictures; drawn by whichever process asks first."""
    def draw(folder):
        folder.mkdir()
        few = Settings(dots_per_inch=50, mode_pictures=1)
        drawn = report(small.products(), settings=few, context=Context(case=small.case())).html.item()
        (folder / "report.html").write_bytes(drawn.encode())

    return (once("small_report", draw) / "report.html").read_bytes().decode()


@pytest.fixture(autouse=True)
def every_picture_has_its_data_with_units_and_nothing_is_clipped(monkeypatch):
    """Whatever a test draws has columns with names of their own and, where they hold numbers, with units; all of it is
    within the picture. ``with`` what this gives, that is not looked at: for drawings equal to others that were."""
    drawn, numbers = [], style.numbers

    def record(figure):
        drawn.append((numbers(figure), figure.get_tightbbox().extents, figure.get_size_inches()))
        return drawn[-1][0]

    @contextmanager
    def not_looked_at():
        with monkeypatch.context() as patch:
            patch.setattr(style, "numbers", numbers)
            yield

    monkeypatch.setattr(style, "numbers", record)
    yield not_looked_at
    for (panels, series), (left, bottom, right, top), (width, height) in drawn:
        columns = Table.of(series).columns
        assert len({column.name for column in columns}) == len(columns)
        assert all(len(column.values) for column in columns)
        assert not [c.name for c in columns if c.values.dtype.kind != "U" and not re.search(r" / \S", c.name)]
        assert {item.panel for item in series} <= set(range(len(panels)))
        assert min(left, bottom, width - right, height - top) > -0.02, (left, bottom, width - right, height - top)


@pytest.fixture
def words_only(monkeypatch):
    """Line drawings are laid out and looked at, but not drawn: for tests of what is told beside pictures that other
    tests draw."""
    whole = Figure.savefig
    monkeypatch.setattr(Figure, "savefig", lambda figure, stream, format, **more: stream.write(b"<svg></svg>")
                        if format == "svg" else whole(figure, stream, format=format, **more))
