"""Random benches are the same whenever they are made, and are of every kind."""

from collections import Counter

import numpy as np

from tests.fuzz.random_benches import Bench


def test_a_number_is_a_bench():
    first, again, other = Bench([1, 7]), Bench([1, 7]), Bench([1, 8])
    assert first.document == again.document != other.document
    for name, channels in first.runs.items():
        for key, (samples, *_) in channels.items():
            np.testing.assert_array_equal(samples, again.runs[name][key][0])


def test_benches_are_of_every_kind():
    benches = [Bench([1, number]) for number in range(40)]
    kinds = Counter(bench.kind for bench in benches)
    assert set(kinds) == {"force", "base", "free", "tap", "course", "poles"} and {b.size for b in benches} == {1, 2, 3}
    sections = {key for bench in benches for key in (*bench.document["bench"], *bench.document["diagnosis"])}
    assert {"courses", "blow", "poles", "forward", "start", "held_out", "latent_force", "next"} <= sections
