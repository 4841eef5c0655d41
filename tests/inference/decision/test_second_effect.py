"""When a second effect matters beside a first one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.inference.decision import second_effect
from pipeline.inference.procedure import Settings, diagnose
from pipeline.inference.rules import DEFAULTS
from tests.inference import linear


@pytest.fixture(scope="module")
def solved():
    """(Diagnosis of one hidden effect of two, its catalogue)."""
    whole, noise, catalogue, _ = linear.problem((2, 1, 1), runs=4, held_out=1, truth={"effect_1_0": 0.6})
    return diagnose(whole, noise, catalogue, Settings(draws=2000)), catalogue


def test_the_named_effect_leads(solved):
    single, _ = solved
    assert [w.candidate.name for w in second_effect.leading(single, DEFAULTS)] == ["effect_1"]


def test_a_fit_at_the_noise_leaves_room_only_for_what_the_noise_may_hide(solved):
    first = solved[0].named[0].fit
    assert second_effect.has_room(first, 1e-3 * first.counts.sum(), DEFAULTS)
    assert not second_effect.has_room(first, 1e6 * first.counts.sum(), DEFAULTS)


@pytest.mark.parametrize("explained, matters", [(1.0, True), (1e9, False)])
def test_a_second_effect_must_explain_a_fraction_of_what_the_first_does(solved, explained, matters):
    assert second_effect.matters(solved[0], explained, DEFAULTS) is matters
    tie = replace(solved[0], decision=replace(solved[0].decision, verdict="tie"))
    assert not second_effect.matters(tie, explained, DEFAULTS), "only what is named matters"


def test_the_second_begins_without_the_first(solved):
    single, catalogue = solved
    pair = SimpleNamespace(null=SimpleNamespace(latent=np.zeros(2)), named=(SimpleNamespace(
        candidate=catalogue[1], fit=SimpleNamespace(latent=np.array([1.0, 2.0, 3.0, 4.0]))),))
    first = SimpleNamespace(fit=SimpleNamespace(latent=np.zeros(3)))
    (index, start), = second_effect.starts_without(first, pair, catalogue[1:]).items()
    assert index == 0 and start.tolist() == [1.0, 2.0, 4.0]


def test_a_name_of_less_evidence_alone_does_not_take_the_place_of_the_pair(solved):
    single, _ = solved
    assert not second_effect.better_alone(single, single)
    other = replace(single, decision=replace(single.decision, verdict="unknown", named=()))
    assert not second_effect.better_alone(other, single)
