"""How one long record is cut."""

import numpy as np

from pipeline.recordings.survey.pieces import pieces


def test_what_repeats_is_cut_by_its_period():
    one = np.random.default_rng(0).standard_normal(500)
    spans, how = pieces(np.tile(one, 6), False)
    assert spans == [(500 * k, 500 * (k + 1)) for k in range(6)] and "repeats every 500" in how


def test_free_motions_begin_behind_blows():
    time = np.arange(4000) / 1000
    decays = sum(np.where(time >= t, np.exp(-5 * (time - t)) * np.cos(200 * (time - t)), 0) for t in (0.5, 1.7, 2.9))
    spans, how = pieces(decays, True)
    assert how.startswith("one after each blow") and len(spans) == 3
    assert all(abs(a / 1000 - t) < 0.02 for (a, _), t in zip(spans, (0.5, 1.7, 2.9), strict=True))


def test_noise_is_cut_evenly_and_never_too_long():
    spans, how = pieces(np.random.default_rng(0).standard_normal(100_000), False)
    assert len(spans) == 4 and all(b - a == 8192 for a, b in spans) and "first 8192" in how
