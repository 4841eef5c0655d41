"""The latent force of a place: a hidden spring comes back as its force, and noise as nothing."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.diagnosis.signals.forward_model import observed
from pipeline.diagnosis.signals.latent_force import describe, sentence
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.inference.problem import Hypothesis, Problem
from tests.diagnosis.small_rig import HIDDEN, NOISE, laid_out, model, recording


def described(hidden):
    bench, found = benches.built(model(), laid_out()), recorded(recording(hidden, levels=(2.0, 5.0)), laid_out())
    runs = tuple(observed(one, {"x": NOISE}) for one in found.values())
    noise = budget(Problem(runs, None, Hypothesis("n", (), (Parameter("a", "1", 1.0, LogNormal(1.0, 0.1)),))))
    return describe(bench, {r.name: (found[r.name].run, r, noise[r.name]) for r in runs}, ("level_2",),
                    "mount = block", draws=300)


@pytest.fixture(scope="module")
def hardening():
    return described(HIDDEN)


def test_a_hidden_cubic_spring_comes_back_with_its_coefficient(hardening):
    """F = -15000 x^3 at the place; within 5 %, the error of bands below the noise and of faded ends."""
    for name in ("level_1", "level_2"):
        one = hardening.runs[name]
        fitted = np.polyfit(one.displacement, one.force, 3)
        assert fitted[0] == pytest.approx(-15000.0, rel=0.05)
        assert abs(fitted[2]) * np.ptp(one.displacement) < 0.1 * np.ptp(one.force)


def test_it_follows_the_displacement_and_lies_at_large_amplitudes(hardening):
    share = {f.name: f.share for f, _ in hardening.follows}
    assert share["displacement"] > 0.8 > 0.3 > share["velocity"] and "follows the displacement" in hardening.sentence
    found, unit, edges = hardening.regimes["amplitude"]
    assert unit == "m" and found.members[-1] and found.p_value[-1] < 0.01 and edges[-1, 1] == edges.max()


def test_nothing_missing_leaves_no_force():
    assert described({}) is None


def test_the_sentence_tells_when_nothing_is_followed(hardening):
    told = sentence("mount", list(hardening.runs.values()), ())
    assert "follows neither" in told and told.endswith("description, not identified physics.")
