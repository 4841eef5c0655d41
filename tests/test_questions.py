"""The pages of docs/questions: every command is run, and prints what the page shows."""

import re
import shlex
from pathlib import Path

import pytest

from tests.commands import brakechain

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs" / "questions").glob("*.md"))
#: largest relative difference of a number: other processors may round the last digit otherwise
_CLOSE = 0.02
_LEFT_OUT = "..."
#: commands with this in them take seconds each, and are run with the slow tests
_LONG = "disc_brake"


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """A function that runs a command, once, in a folder that has the cases: what it prints."""
    folder, known = tmp_path_factory.mktemp("questions"), {}
    (folder / "data").mkdir()
    for name in ("docs", "configs", "data/reference"):
        (folder / name).symlink_to(ROOT / name)

    def run(command):
        if command not in known:
            known[command] = brakechain(*shlex.split(command)[1:], cwd=folder).stdout
        return known[command]

    return run


def shown(text):
    """[(command, lines that a page shows of its output)]."""
    steps = []
    for block in re.findall(r"(?:^    .+\n)+", text, re.MULTILINE):
        for line in block.splitlines():
            if line.startswith("    brakechain "):
                steps.append((line.strip(), []))
            else:
                assert steps, f"output before any command: {line}"
                steps[-1][1].append(line)
    return steps


def tokens(text):
    """Words and numbers; rules of tables are none, and all minus signs are alike."""
    return [word for word in text.replace("\u202f", " ").replace("\N{MINUS SIGN}", "-").split() if word.strip("─")]


def alike(expected, found):
    """Whether two words are the same, or numbers (with punctuation after them) that are close."""
    if expected == found:
        return True
    number = re.compile(r"(\(?)([-+]?\d+\.?\d*)(\D*)")
    one, other = number.fullmatch(expected), number.fullmatch(found)
    return bool(one and other) and one[1] == other[1] and one[3] == other[3] and \
        float(one[2]) == pytest.approx(float(other[2]), rel=_CLOSE)


def missing(lines, output):
    """The first part of the ``lines`` of a page that ``output`` does not hold in their order; '' if it holds all."""
    words, begin = tokens(output), 0
    for part in re.split(rf"^ *{re.escape(_LEFT_OUT)}$", "\n".join(lines), flags=re.MULTILINE):
        wanted = tokens(part)
        ends = [k for k in range(begin, len(words) - len(wanted) + 1)
                if all(map(alike, wanted, words[k:k + len(wanted)]))]
        if wanted and not ends:
            return part
        begin = ends[0] + len(wanted) if wanted else begin
    return ""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_commands_of_a_page_print_what_it_shows(page, printed):
    steps = shown(page.read_text(encoding="utf-8"))
    assert steps or page.stem == "README"
    compare(page, [step for step in steps if _LONG not in step[0]], printed)


@pytest.mark.slow
def test_the_commands_on_a_whole_brake_print_what_is_shown(printed):
    for page in PAGES:
        compare(page, [step for step in shown(page.read_text(encoding="utf-8")) if _LONG in step[0]], printed)


def compare(page, steps, printed):
    for command, lines in steps:
        output = printed(command)
        lost = missing(lines, output)
        assert not lost, f"{page.name}: '{command}' no longer prints\n{lost}\nbut\n{output}"


def test_a_page_that_is_no_longer_true_is_noticed():
    output = "  170.73 Hz   25.57\n ────\nUnstable from friction 0.313 on (0.4 here).\nThe end.\n"
    assert not missing(["170.73 Hz 25.6", "...", "from friction 0.313 on", "(0.4 here)."], output)
    assert missing(["170.73 Hz 26.9"], output) and missing(["170.73 kHz 25.57"], output)
    assert missing(["170.73 Hz −25.57"], output) and missing(["The end.", "...", "170.73 Hz"], output)
    assert missing(["25.57", "from friction 0.313"], output), "left out without a mark"


def test_every_page_is_short_and_in_the_index():
    index = (ROOT / "docs" / "questions" / "README.md").read_text(encoding="utf-8")
    for page in PAGES:
        lines = page.read_text(encoding="utf-8").splitlines()
        assert len(lines) <= 62, page.name
        assert page.name == "README.md" or f"({page.name})" in index, page.name
