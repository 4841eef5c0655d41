"""Plans of sets: shares are kept, effects, sizes and noises stand evenly."""

from collections import Counter

import numpy as np
import pytest

from pipeline.blind_trial.generators.systems import CLASSES, System
from pipeline.blind_trial.protocol.stratification import SHARES, drawn, shared_out
from pipeline.contract.errors import BrakechainError

FIRST = System("first", None, {"control": ((),), "effect": (("a",), ("b",), ("c",))}, (0.1, 0.3), (0.01, 0.1))
SECOND = System("second", None, {"control": ((),), "foreign": (("z",),)}, (0.2,), (0.03,), "self_excited", 0.5)
BOTH = {"first": FIRST, "second": SECOND}


def test_the_shares_are_those_of_all_classes_and_a_set_of_320_has_130_controls():
    assert set(SHARES) == set(CLASSES) and sum(SHARES.values()) == pytest.approx(1) and SHARES["foreign"] >= 0.15
    whole = shared_out(320, SHARES)
    assert sum(whole.values()) == 320 and whole["control"] >= 130


@pytest.mark.exact
def test_whole_numbers_by_the_largest_remainders():
    assert shared_out(10, {"a": 0.52, "b": 0.29, "c": 0.19}) == {"a": 5, "b": 3, "c": 2}
    assert shared_out(3, {"a": 100.0, "b": 1.0, "c": 1.0}) == {"a": 1, "b": 1, "c": 1}
    assert shared_out(1, {"a": 3.0, "b": 1.0}) == {"a": 1, "b": 0}


def test_classes_systems_effects_sizes_and_noises_stand_evenly_in_random_order():
    found = drawn(200, BOTH, np.random.default_rng(1))
    kinds = Counter(d.kind for d in found)
    assert len(found) == 200 and set(kinds) == {"control", "effect", "foreign"}
    for kind, share in (("control", 0.42), ("effect", 0.26), ("foreign", 0.15)):
        assert abs(kinds[kind] - 200 * share / 0.83) <= 2
    controls = Counter(d.system for d in found if d.kind == "control")
    assert abs(controls["first"] - 2 * controls["second"]) <= 2
    effects = [d for d in found if d.kind == "effect"]
    for counted in (Counter(d.hidden for d in effects), Counter(d.size for d in effects),
                    Counter(d.noise for d in effects)):
        assert max(counted.values()) - min(counted.values()) <= 1 and len(counted) > 1
    assert all(d.size == 0 and d.hidden == () for d in found if d.kind == "control")
    assert [d.kind for d in found] != sorted(d.kind for d in found)
    assert found == drawn(200, BOTH, np.random.default_rng(1)) != drawn(200, BOTH, np.random.default_rng(2))


def test_fewer_cases_than_classes_are_refused():
    with pytest.raises(BrakechainError, match="at least one of each of the 3 classes"):
        drawn(2, BOTH, np.random.default_rng(1))
