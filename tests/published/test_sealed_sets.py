"""Sealed sets that were published in data/trial: they hold, and the README shows the newest of them."""

from pathlib import Path

from pipeline.blind_trial.metrics.summary import as_markdown
from pipeline.blind_trial.protocol.case_set import TrialSet
from pipeline.blind_trial.protocol.verifying import verify

ROOT = Path(__file__).parents[2]
PUBLISHED = sorted(path.parent for path in ROOT.glob("data/trial/*/result.json"))


def test_every_published_set_can_be_verified():
    for folder in PUBLISHED:
        assert TrialSet(folder).sealed and verify(folder)


def test_the_readme_shows_the_newest_result_or_none_and_says_what_was_not_available():
    shown = (ROOT / "README.md").read_text().partition("<!-- trial:")[2].partition("<!-- /trial -->")[0]
    assert "No recording of a real squealing brake was available" in " ".join(shown.split())
    if PUBLISHED:
        assert as_markdown(TrialSet(PUBLISHED[-1]).read("result.json")) in shown
        assert TrialSet(PUBLISHED[-1]).about["commitment"] in shown
    else:
        assert "No sealed set has been published yet" in shown and "| goal |" not in shown
