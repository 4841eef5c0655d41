"""The page in a headless Chromium: no console message, no request that leaves the file, no overflow on a phone."""

import json
import shutil
import subprocess
from html import escape, unescape
from urllib.parse import urlsplit

import pytest

from pipeline.contract import Context
from pipeline.views.pages.trial import page
from stages.report import Settings, report
from tests.views import products_for_views as small
from tests.views.trial_for_views import drawn

CHROMIUM = shutil.which("chromium")
FLAGS = ("--headless", "--hide-scrollbars", "--no-sandbox", "--disable-gpu", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", "--v=0", "--dump-dom")
PHONE, DESKTOP = 380, 1280
#: a screen of the width of the frame; Chromium's own windows are never narrower than 500 pixels
SCREEN = """<!DOCTYPE html><title>screen</title><link rel="icon" href="data:,"><body style="margin:0">
<iframe style="border:0" width="{width}" height="4000" srcdoc="{page}"></iframe><script>
addEventListener("load", () => {{
const inside = document.querySelector("iframe").contentDocument, images = [...inside.images];
document.title = JSON.stringify({{wide: inside.documentElement.scrollWidth, images: images.length,
broken: images.filter(i => !i.naturalWidth).length, text: inside.querySelector("h1").textContent}}); }})
</script>"""

#: what a reader does with a page: moves the pointer over a curve and over a large map, enlarges one, turns a mode; the
#: document that is being written keeps the browser from taking the page for loaded before all is done
READER = """<!DOCTYPE html><title>reader</title><link rel="icon" href="data:,"><body style="margin:0">
<iframe hidden></iframe><script>
const busy = document.querySelector("iframe").contentDocument;
busy.open();
const tell = made => {{ document.title = JSON.stringify(made); busy.close(); }};
addEventListener("unhandledrejection", event => tell({{failed: String(event.reason)}}));
const read = async frame => {{
const page = frame.contentDocument, view = page.defaultView;
const wait = () => new Promise(done => setTimeout(done, 400)), tip = page.querySelector(".tip"), made = {{}};
const at = (target, kind, x, y) => {{ const frame = target.getBoundingClientRect();
  target.dispatchEvent(new view.PointerEvent(kind, {{bubbles: true, clientX: frame.left + x * frame.width,
    clientY: frame.top + y * frame.height}})); }};
for (const [name, chapter, index] of [["curve", "complex_modes", 2], ["map", "surface", 0]]) {{
  const image = page.querySelectorAll(`#${{chapter}} figure img`)[index];
  for (let y = 0.2; y < 0.8 && !made[name]; y += 0.05) {{
    at(image, "pointermove", 0.5, y); await wait(); made[name] = tip.hidden ? "" : tip.textContent; }}
}}
at(page.querySelector("h1"), "pointermove", 0.5, 0.5); await wait(); made.hidden = tip.hidden;
page.querySelector("figure .picture[data-places]").click();
const large = page.querySelector("dialog[open] .picture");
large.dispatchEvent(new view.WheelEvent("wheel", {{bubbles: true, deltaY: -400, clientX: 400, clientY: 300}}));
made.zoom = large.style.transform;
const dialog = page.querySelector("dialog"), told = new Promise(done => dialog.addEventListener("close", done));
dialog.close(); await told; made.closed = !page.querySelector("dialog");
const figure = [...page.querySelectorAll("figure")].find(f => f.querySelector(".turn"));
if (figure) {{ figure.querySelector(".turn").click(); await wait(); await wait();
  const canvas = figure.querySelector("canvas"), first = canvas.toDataURL();
  canvas.setPointerCapture = () => 0;
  at(canvas, "pointerdown", 0.5, 0.5);
  canvas.dispatchEvent(new view.PointerEvent("pointermove",
    {{bubbles: true, buttons: 1, movementX: 40, movementY: 9}}));
  const later = canvas.toDataURL();
  made.turned = first !== later && Math.min(first.length, later.length) > 10000;
  made.controls = figure.querySelectorAll("input").length; }}
tell(made); }};
</script>
<iframe style="border:0" width="1280" height="60000" onload="read(this)" srcdoc="{page}"></iframe>"""

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine (Debian package 'chromium')")


def opened(folder, html):
    """Open ``html`` as a file: (document after loading, console lines, requests of the page that leave the file)."""
    page, log = folder / "report.html", folder / "net.json"
    page.write_text(html, encoding="utf-8")
    run = subprocess.run([CHROMIUM, *FLAGS, f"--user-data-dir={folder / 'profile'}", f"--log-net-log={log}",
                          "--window-size=1280,4000", page.as_uri()],
                         capture_output=True, text=True, timeout=120, check=True)
    console = [line for line in run.stderr.splitlines() if ":CONSOLE:" in line]
    return run.stdout, console, _requests(json.loads(log.read_text()))


def _requests(log):
    """Addresses that the page asked for; Chromium's own services carry no initiating origin."""
    started = log["constants"]["logEventTypes"]["URL_REQUEST_START_JOB"]
    asked = [e["params"] for e in log["events"] if e["type"] == started and "url" in e.get("params", {})]
    return [a["url"] for a in asked
            if a.get("initiator") != "not an origin" and urlsplit(a["url"]).scheme not in ("file", "data")]


def test_the_page_opens_without_message_and_without_request(html, tmp_path):
    document, console, requests = opened(tmp_path, html)
    assert "Squeal at 2 of 9" in document
    assert console == []
    assert requests == []


@pytest.mark.parametrize("width", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_every_picture_loads_and_nothing_is_wider_than_the_screen(html, width, tmp_path):
    document, console, requests = opened(tmp_path, SCREEN.format(width=width, page=escape(html)))
    found = json.loads(unescape(document.partition("<title>")[2].partition("</title>")[0]))
    assert found["text"] == "Squeal at 2 of 9 operating points"
    assert found["wide"] == width
    assert found["images"] > 30
    assert found["broken"] == 0
    assert console == []
    assert requests == []


@pytest.fixture(scope="module")
def ruptured():
    """The page of a rupture."""
    few = Settings(dots_per_inch=50)
    return report({"rupture": small.rupture()}, settings=few, context=Context(case=small.case())).html.item()


@pytest.mark.parametrize("width", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_the_page_of_a_rupture_is_no_wider_than_the_screen(ruptured, width, tmp_path):
    document, console, requests = opened(tmp_path, SCREEN.format(width=width, page=escape(ruptured)))
    found = json.loads(unescape(document.partition("<title>")[2].partition("</title>")[0]))
    assert found["text"] == "The left front stops, the right one runs on" and found["wide"] == width
    assert found["images"] > 3 and found["broken"] == 0 and not console and not requests


@pytest.fixture(scope="module")
def tried():
    """The page of a trial."""
    return page(drawn())


@pytest.mark.parametrize("width", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_the_page_of_a_trial_opens_quietly_and_is_no_wider_than_the_screen(tried, width, tmp_path):
    document, console, requests = opened(tmp_path, SCREEN.format(width=width, page=escape(tried)))
    found = json.loads(unescape(document.partition("<title>")[2].partition("</title>")[0]))
    assert "hidden effects correctly named and located" in found["text"] and found["wide"] == width
    assert found["images"] == 9 and found["broken"] == 0 and not console and not requests


def test_a_reader_sees_values_zooms_and_turns_a_mode(html, tmp_path):
    """Where this machine draws pictures in three dimensions; values under the pointer anywhere."""
    document, console, requests = opened(tmp_path, READER.format(page=escape(html)))
    made = json.loads(unescape(document.partition("<title>")[2].partition("</title>")[0]))
    assert "failed" not in made, made
    assert "coefficient of friction: " in made["curve"] and "kHz: growth rate: " in made["curve"]
    assert "height: " in made["map"] and " µm" in made["map"] and made["hidden"]
    assert "scale(1." in made["zoom"] and made["closed"]
    assert made.get("turned", True) and made.get("controls", 1) in (1, 2)
    assert console == [] and requests == []


def test_a_page_that_speaks_or_asks_is_caught(tmp_path):
    wrong = '<!DOCTYPE html><title>x</title><img src="http://127.0.0.1:9/a.png"><script>console.error("no")</script>'
    _, console, requests = opened(tmp_path, wrong)
    assert any("no" in line for line in console)
    assert requests == ["http://127.0.0.1:9/a.png"]
