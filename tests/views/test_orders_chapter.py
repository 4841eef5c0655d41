"""Chapter of orders: which are told, how large, at which speed; and no chapter where there are none to seek."""

from dataclasses import replace

import numpy as np

from pipeline.contract.context import CaseSummary
from pipeline.products import Orders, Recording, Run
from pipeline.views.chapters.bench.orders import chapter
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import orders as pictures
from pipeline.views.pages.report import page
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as small

LOOK = Look(dpi=50)


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_orders_are_told_with_amplitude_speed_and_frequency():
    product = small.orders()
    made = chapter(product, LOOK)
    one = product.spectra["stop.torque"]
    largest = int(one.level[1].argmax())
    rpm = 30 * (one.edge[largest] + one.edge[largest + 1]) / 2 / np.pi
    told = plain(made.conclude)
    assert told.startswith("Of 1 channel, at 300–1500 rpm, 1 has orders that stand out. The largest: order 10 of")
    assert f"at {rpm:.0f} rpm, {10 * rpm / 60:.0f} Hz, run stop." in told
    assert [row[2] for row in made.tables[0].rows] == ["10", "1"] and len(made.figures) == 2
    assert "N m" in made.tables[0].rows[0][3]


def test_none_that_stands_out_and_no_varying_speed():
    quiet = chapter(small.orders(quiet=True), LOOK)
    assert len(quiet.figures) == 1 and not quiet.tables and "none has orders that stand out" in plain(quiet.conclude)
    assert chapter(Orders(), LOOK) is None
    without = chapter(Orders(remarks=["stop: the tacho shaft gives fewer than three pulses: no orders"]), LOOK)
    assert "fewer than three pulses" in without.tables[0].rows[0][0] and not without.figures


def test_a_stage_without_a_chapter_has_no_method_on_the_page():
    case = CaseSummary(name="x", methods={"orders": "Told at once.", "recording": "Read from files."})
    text = page([], {"orders": Orders()}, case, LOOK)
    assert "Told at once." not in text and "Read from files." in text
    assert "Told at once." in page([chapter(small.orders(), LOOK)], {"orders": small.orders()}, case, LOOK)


def test_pictures_change_with_the_data():
    one = small.orders().spectra["stop.torque"]
    for draw, field in ((lambda o: pictures.campbell(o, 50), "campbell"), (pictures.levels, "level")):
        assert draw(one) == draw(one) != draw(replace(one, **{field: getattr(one, field)[..., ::-1]}))


def test_the_first_screen_tells_the_largest_orders():
    recording = Recording(source=["stop.wav 0"], runs={"stop": Run(description="", repeat_of="")})
    quiet = {"recording": recording, "noise_events": small.noise_events(quiet=True)}
    told = dict(verdict(quiet | {"orders": small.orders()}, ()).answers)["Where"]
    assert "Orders of the shaft: order 10 of torque with" in plain(told)
    assert "Orders of the shaft" not in dict(verdict(quiet, ()).answers)["Where"]
    case = CaseSummary(name="x")
    assert "Campbell diagram" in page([], quiet | {"orders": small.orders()}, case, LOOK)
    assert "Campbell diagram" not in page([], quiet | {"orders": small.orders(quiet=True)}, case, LOOK)


def test_what_was_assumed_of_a_tacho_is_told(words_only):
    whole = small.orders()
    toothed = {name: replace(one, remark=np.array("a wheel of 60 teeth")) for name, one in whole.spectra.items()}
    assert chapter(replace(whole, spectra=toothed), LOOK).conclude.endswith(" Run stop, wheel: a wheel of 60 teeth.")
    assert "wheel of" not in chapter(whole, LOOK).conclude
