"""Long records: the same verdicts by way of their beginnings, fitted to all samples; what counts as one."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.inference import long_records
from pipeline.inference.fitting.noise import budget
from pipeline.inference.long_records import beginnings
from pipeline.inference.procedure import diagnose
from tests.inference.oscillator import CATALOGUE, bench
from tests.inference.test_procedure import TRUTHS


@pytest.fixture
def shorter(monkeypatch):
    """A quarter of the 6,000 fitted samples of the toy bench are its beginnings."""
    monkeypatch.setattr(long_records, "MANY", 1500)


@pytest.mark.parametrize("truth, verdict, named", [TRUTHS[k] for k in (0, 1, 3, 5)],
                         ids=lambda v: v if isinstance(v, str) else "")
def test_the_verdict_is_that_of_the_whole(shorter, truth, verdict, named):
    problem = bench(5, 0.1, **truth)
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert (told.decision.verdict, tuple(c.name for c in told.decision.named)) == (verdict, named)
    assert all(run.samples.shape == (2, 2000) for run in told.null.runs), "by all samples"
    if verdict == "missing":
        alone = told.named[0].fit
        assert alone.converged and alone.values["friction_force"] == pytest.approx(0.6, rel=0.05)


def test_what_the_beginnings_do_not_show_is_found_on_the_whole(shorter):
    """A force that sets in after all beginnings: these are consistent, the whole is not."""
    problem = bench(5, 0.02, extra=lambda t, x, v: 2e4 * x**3 if t > 4.0 else 0.0)
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert told.decision.verdict == "unknown"


def test_beginnings_are_as_long_as_it_takes_to_move(shorter):
    problem = bench(5, 0.1)
    short, noises = beginnings(problem, budget(problem))
    lengths = {run.name: run.samples.shape[1] for run in short.runs}
    assert len(lengths) == 4 and all(500 <= length < 510 for length in lengths.values())
    assert all(noises[name].usable.shape == (2, length) for name, length in lengths.items())
    still = replace(problem.runs[0], samples=np.where(np.arange(2000) < 900, 0.0, problem.runs[0].samples))
    quiet = replace(problem, runs=(still, *problem.runs[1:]))
    short, _ = beginnings(quiet, budget(quiet))
    assert 900 < short.runs[0].samples.shape[1] < 1500


def test_short_records_and_features_have_no_beginnings(monkeypatch):
    problem = bench(5, 0.1)
    assert beginnings(problem, budget(problem)) is None
    monkeypatch.setattr(long_records, "MANY", 1500)
    features = {name: replace(noise, ordered=False) for name, noise in budget(problem).items()}
    assert beginnings(problem, features) is None
