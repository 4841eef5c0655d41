"""A prior that is too narrow neither hides nor gives up what is there; one that the case states is told."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.widening import widened
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis
from pipeline.inference.procedure import diagnose
from pipeline.inference.rules import DEFAULTS
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


def test_a_size_that_is_all_but_none_is_not_widened():
    size = Parameter("size", "1", 0.2, HalfNormal(1.0), 0.0)
    null, laws = SimpleNamespace(latent=np.zeros(1)), (Hypothesis("law", (("law", "here"),), (size,)),)

    def ended(latent):
        return {0: SimpleNamespace(fit=SimpleNamespace(latent=np.array([0.0, latent]), weights=np.ones(1),
                                                       betters=lambda _: 1e3))}

    assert not widened(laws, ended(-8.0), null, DEFAULTS) and not widened(laws, ended(4.9), null, DEFAULTS)
    assert widened(laws, ended(8.0), null, DEFAULTS)[0].parameters[0].prior == HalfNormal(10.0)


def test_sizes_alone_are_widened():
    half = Parameter("force", "N", 0.1, HalfNormal(0.5), 0.0)
    assert half.widened(10.0).prior == HalfNormal(5.0)
    assert replace(half, prior=Normal(0.0, 0.2)).widened(10.0).prior == Normal(0.0, 2.0)
    for kept in (replace(half, null=None), replace(half, stated=True), replace(half, prior=LogNormal(0.1, 1.0))):
        assert kept.widened(10.0) == kept
