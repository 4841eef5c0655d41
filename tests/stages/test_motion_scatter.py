"""Stage motion_scatter: runs, what is judged, energy, and what it refuses."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.validation.beam_on_beam import beam_on_beam_rows
from stages.motion_scatter import Settings, motion_scatter
from tests.stages.small_beams import model

QUICK = {"steps": ["2 us"], "seeds": [1, 2], "duration": "0.1 s", "settling": "40 ms",
         "highest_frequency": "30 kHz"}


@pytest.fixture(scope="module")
def found():
    return motion_scatter(model(), settings=Settings(**QUICK))


def test_one_run_for_each_formulation_step_and_seed(found):
    assert list(found.formulation) == ["hard", "hard", "forward", "forward"] and list(found.seed) == [1, 2, 1, 2]
    np.testing.assert_allclose(found.status_share.sum(axis=1), 1.0)
    assert found.duration == pytest.approx(0.06)


def test_the_contact_opens_sticks_and_slides(found):
    assert np.all(found.status_share > 0.01) and np.all(found.peak_force > 9.0)


@pytest.mark.exact
def test_energy_balances_where_the_linear_part_is_exact(found):
    assert np.all(found.imbalance < 0.005)


@pytest.mark.exact
def test_below_its_threshold_nothing_grows():
    """At friction 0.05 all modes are stable: the kick dies out and the contact slides all the time."""
    calm = motion_scatter(model(), settings=Settings(**{**QUICK, "formulations": ["hard"], "friction": 0.05}))
    np.testing.assert_allclose(calm.status_share, [[0, 0, 1], [0, 0, 1]])
    np.testing.assert_allclose(calm.peak_force, 9.0, rtol=0.05)


def test_rows_are_medians_with_their_range(found):
    rows = beam_on_beam_rows({"motion_scatter": found}, (), {})
    assert rows["peak_force"].value == pytest.approx(np.median(found.peak_force))
    assert f"{found.peak_force.max():.4g}" in rows["peak_force"].note


@pytest.mark.parametrize("change, said", [({"settling": "90 ms"}, "duration"), ({"low_band": ["1 kHz"]}, "low_band")])
def test_runs_that_cannot_be_judged_are_refused(change, said):
    with pytest.raises(ConfigError, match=said):
        motion_scatter.check({"motion_scatter": Settings(**{**QUICK, **change})})
