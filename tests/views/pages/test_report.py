"""The page: every section, the case's settings, nothing from outside."""

import base64
import csv
import hashlib
import re
import zipfile
from io import BytesIO, StringIO
from pathlib import Path

import pytest

from pipeline.contract.context import CaseSummary
from pipeline.views.chapters import vibration
from pipeline.views.chapters.chapter import Look
from pipeline.views.pages import case_settings as case_view
from pipeline.views.pages.limits import limits
from pipeline.views.pages.report import page
from tests.views import products_for_views as small

LOOK = Look(dpi=50, shapes=0)


def test_every_section_is_there_in_the_order_of_the_chain(html):
    anchors = re.findall(r'<section id="(\w+)">', html)
    assert anchors == ["table", "surface", "micro_friction", "friction_map", "structure", "lumped", "complex_modes",
                       "multibody", "transient", "response", "squeal", "comparison", "limits", "settings", "methods"]
    assert set(re.findall(r'<a href="#(\w+)">', html)) == set(anchors)


def test_nothing_is_loaded_from_outside(html):
    sources = re.findall(r'(?:src|href|srcset|action|data)="([^"]*)"', html)
    assert sources
    assert all(source.startswith(("data:", "#")) for source in sources)
    assert "url(" not in html
    assert "@import" not in html


def test_only_the_scripts_of_the_template_may_run(html):
    policy, = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', html)
    scripts = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    digests = {f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in scripts}
    assert scripts and html.count("<script") == len(scripts)
    assert set(re.search(r"script-src ([^;]*)", policy)[1].split()) == digests


def test_every_figure_has_its_data_beside_it(html):
    """A row of numbers or more below a head with units; the files are named after the case and the figure."""
    figures = re.findall(r"<figure.*?</figure>", html, re.DOTALL)
    for number, figure in enumerate(figures, 1):
        (name, kind, data), = re.findall(r'download="([^"]*)" href="data:([\w/]+);base64,([^"]*)"', figure)
        content = base64.b64decode(data)
        if kind == "application/zip":
            content = zipfile.ZipFile(BytesIO(content)).read(name.removesuffix(".zip"))
        head, *rows = csv.reader(StringIO(content.decode()))
        assert name.removesuffix(".zip") == f"small_figure_{number}.csv" and rows and " / " in "".join(head)


def test_a_file_of_data_says_if_it_is_of_the_last_frame(html):
    assert "data of the last frame (CSV)" in html


def test_the_squeal_can_be_heard_and_says_what_it_is(html):
    (address,) = re.findall(r'<audio controls preload="none" src="([^"]*)"></audio>', html)
    assert address.startswith("data:audio/wav;base64,") and "media-src data:" in html
    assert "not the sound at an ear" in html and "full scale is 20\u202fmm/s" in html
    assert not vibration.squeal(small.squeal(quiet=True), (), LOOK).sounds


def test_figures_are_numbered_without_gaps(html):
    numbers = [int(n) for n in re.findall(r"<b>Figure (\d+)\.</b>", html)]
    assert numbers == list(range(1, len(numbers) + 1))
    assert len(numbers) > 20


def test_settings_show_value_origin_and_source(html):
    assert "13.5\u202fMPa" in html
    assert "Figure 10c" in html
    assert "largest shear stress of a spot" in html
    assert "1 tuned" in html
    assert "1, 2, 3\u202fMPa" in html


def test_the_load_of_the_pads_is_told_without_friction_and_in_steady_sliding(html):
    """The first patch goes from 560 to 880 N, the last from 240 to 0 N; the largest force without friction is 560 N."""
    assert "without friction, nominal 2\u202fMPa" in html and "none of 12 patches open. Right: the same" in html
    assert "steady sliding at 10.25\u202frad/s with friction 0.46" in html and "1 of 12 patches open." in html
    assert "by up to 57\u202f% of the largest force without friction" in html


def test_the_table_shows_every_row_of_the_comparison_with_its_key_and_product_field(html):
    facts = small.comparison()
    for row, key, field in zip(facts.row, facts.key, facts.field, strict=True):
        below = f"{key} ← {field}" if field else key
        assert f'<td>{row}<small class="address">{below}</small></td>' in html
    assert "prints 337.3 Hz" in html


def test_the_squeal_chapter_distinguishes_harmonics_from_fundamentals():
    chapter = vibration.squeal(small.squeal(harmonic=True), (), LOOK)
    assert [row[3] for row in chapter.tables[0].rows] == ["20th harmonic of 0.83\u202fkHz", "fundamental"]
    assert "1 harmonic of a lower fundamental (0.83\u202fkHz), 1 fundamental." in chapter.conclude
    assert "hollow: harmonics" in chapter.figures[0].caption
    assert "None is a harmonic" in vibration.squeal(small.squeal(), (), LOOK).conclude


def test_text_of_the_case_cannot_break_the_page():
    wicked = CaseSummary(name="x", title='<img src="//example.org/a.png">', methods={"surface": "a < b & c"})
    text = page([], {}, wicked, LOOK)
    assert "<img src" not in text
    assert "a &lt; b &amp; c" in text


def test_a_case_without_settings_has_no_such_section():
    text = page([], {}, CaseSummary(name="bare"), LOOK)
    assert 'id="settings"' not in text
    assert 'id="methods"' not in text
    assert 'id="table"' not in text


def test_limits_follow_the_products():
    assert limits({}) == ()
    assert any("dB(A)" in text for text in limits({"squeal": 1}))
    assert not any("dB(A)" in text for text in limits({"response": 1}))


def test_limits_tell_the_size_of_what_the_interface_leaves_out():
    """Uniform compliance 3.5 um/MPa against an interface of 2 MPa/um; the last grid lowers the area from 3.1 to 3 %."""
    told = "\n".join(limits({"micro_friction": small.micro_friction()}))
    assert "blocks, 3.5 µm/MPa" in told and "compliance after wear is 0.5 µm/MPa at 1\u202fMPa and" in told
    assert "lowers the real contact area by 3.2\u202f%" in told


@pytest.mark.exact
def test_settings_are_written_for_reading():
    assert case_view.written(True, "") == "yes"
    assert case_view.written(None, "") == "—"
    assert case_view.written(7, "") == "7"
    assert case_view.written("turned", "") == "turned"
    assert case_view.written(Path("/somewhere/plu-1.plu"), "") == "plu-1.plu"
    assert case_view.written({"bell": 2750.0, "ring": 5200.0}, "Hz") == "bell: 2.75\u202fkHz, ring: 5.2\u202fkHz"
    assert case_view.written((1e6, 2.5e6), "Pa") == "1, 2.5\u202fMPa"
    idle = CaseSummary(settings={"structure": {"disc.hat_thickness": 6e-3, "disc.hat_height": 0.0}},
                       units={"structure": {"disc.hat_height": "m"}},
                       idle={"structure": {"disc.hat_thickness": "disc.hat_height", "disc.hat_height": ""}})
    told = [row["source"] for row in case_view.stages(idle)[0]["rows"]]
    assert told == ["no effect while disc.hat_height is 0\u202fm", ""]
    assert case_view.tuned(small.case()) == (("micro_friction.shear_limit", "13.5\u202fMPa"),)
