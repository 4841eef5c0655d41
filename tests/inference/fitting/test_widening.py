"""A prior that is too narrow neither hides nor gives up what is there; one that the case states is told."""

from dataclasses import replace

import pytest

from pipeline.inference.diagnosis import Settings
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.procedure import diagnose
from tests.inference import linear


def solved(scale, stated=False, truth=0.5):
    """Diagnosis where a size of ``truth`` is missing, whose prior has this ``scale``, beside two other effects."""
    whole, noise, catalogue, _ = linear.problem((2, 1, 1, 1), 5, 60, {"effect_1_0": truth}, 1, 1, 5.0)
    size = Parameter("effect_1_0", "1", 0.2 * scale, HalfNormal(scale), 0.0, stated=stated)
    return diagnose(whole, noise, (replace(catalogue[0], parameters=(size,)), *catalogue[1:]), Settings(kept=2))


@pytest.mark.parametrize("scale", [1.0, 0.02, 0.015])
def test_a_size_is_found_however_narrow_its_prior_begins(scale):
    told = solved(scale)
    assert told.decision.verdict == "missing" and told.named[0].candidate.name == "effect_1"
    found = told.named[0].fit
    assert found.values["effect_1_0"] == pytest.approx(0.5, abs=4 * found.spread()["effect_1_0"])
    assert not found.excluded(5.0) and (found.hypothesis.parameters[-1].prior.scale > scale) is (scale < 0.1)


def test_a_prior_that_the_case_states_is_told_instead():
    told = solved(0.02, stated=True)
    assert told.decision.verdict == "unknown" and told.decision.leading is None
    assert any("the prior of effect_1_0 excludes the data" in why for why in told.decision.reasons)


def test_nothing_is_found_under_wide_priors_where_nothing_is_missing():
    assert solved(0.015, truth=0.0).decision.verdict in ("consistent", "parameters")


def test_sizes_alone_are_widened():
    half = Parameter("force", "N", 0.1, HalfNormal(0.5), 0.0)
    assert half.widened(10.0).prior == HalfNormal(5.0)
    assert replace(half, prior=Normal(0.0, 0.2)).widened(10.0).prior == Normal(0.0, 2.0)
    for kept in (replace(half, null=None), replace(half, stated=True), replace(half, prior=LogNormal(0.1, 1.0))):
        assert kept.widened(10.0) == kept
