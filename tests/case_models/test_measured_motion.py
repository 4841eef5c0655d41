"""Parts of a measured motion that are kept: they are what a fresh one finds."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.corrections import corrected
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.force_balance import balance
from pipeline.physics.virtual_rig.force_residual import moving, smoothed
from tests.case_models.test_force_balance import rig
from tests.diagnosis.small_rig import HIDDEN, effects

#: each changes one part of a bench, and the last ones several at once
CHANGES = ({}, {"masses.block": 1.3}, {"channels.x.gain": 1.2}, {"channels.x.offset": 1e-3},
           {"channels.x.delay": 2e-3}, {"inputs.shaker.gain": 0.8}, {"joints.mount.stiffness": 300.0},
           {"channels.x.gain": 0.7, "channels.x.offset": -2e-3, "masses.block": 0.9})


@pytest.mark.exact
def test_what_is_kept_is_what_a_fresh_balance_finds():
    bench, runs, settings = rig(HIDDEN)
    kept = balance(bench, runs["level_2"], settings.equation)
    benches = [corrected(b, change) for b in (bench, with_effects(bench, effects(HIDDEN))) for change in CHANGES]
    for each in [*benches, *benches[::-1]]:
        fresh = replace(kept, rate_doubt=kept.rate_doubt)
        assert not fresh.kept and kept.predicted(each) == pytest.approx(fresh.predicted(each), abs=1e-12)


@pytest.mark.exact
def test_a_motion_by_its_channels_is_the_motion_as_a_whole():
    """The filters are linear, but for what the thinning filter makes of a constant."""
    bench, runs, settings = rig(HIDDEN)
    one = balance(bench, runs["level_2"], settings.equation)
    for change in CHANGES:
        each = corrected(bench, change)
        whole = moving(smoothed(each, one.run, one.measured, 20.0), 1 / one.run.sample_rate, 20.0)
        for found, expected in zip(one.motion(each), (whole, whole.thinned(4, 60)), strict=True):
            for part, other in zip(found, expected, strict=True):
                np.testing.assert_allclose(part, other, atol=1e-9 * abs(other).max())
