"""Rigs of a trial: their shape, and beliefs that are off."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.rig import Link, Rig, believed, drawn, far_off
from pipeline.contract.errors import ConfigError


@pytest.mark.parametrize("masses", [1, 2, 3, 4])
def test_a_row_of_masses_is_held_by_every_link(masses):
    rig = drawn(np.random.default_rng(masses), masses)
    stiffness = rig.rows.T @ np.diag([link.stiffness for link in rig.links]) @ rig.rows
    assert len(rig.links) == masses + (masses > 2) and np.linalg.eigvalsh(stiffness)[0] > 0


def test_every_belief_is_off_by_10_to_30_percent_but_what_is_exact():
    rig = drawn(np.random.default_rng(0), 3)
    belief = believed(np.random.default_rng(1), rig, ("mass_1", "stiffness_0"))
    ratio = [b / t for b, t in zip(belief.mass, rig.mass, strict=True)] + [
        getattr(b, what) / getattr(t, what) for b, t in zip(belief.links, rig.links, strict=True)
        for what in ("stiffness", "damping")]
    exact = [k for k, r in enumerate(ratio) if r == 1]
    assert exact == [1, 3]
    off = np.abs(np.log(np.delete(ratio, exact)))
    assert (off >= np.log(1.1)).all() and (off <= np.log(1.3)).all()


@pytest.mark.parametrize("mass, links", [((), ()), ((0.0,), ()), ((1.0,), (Link(1, -1, 1.0, 0.0),))])
def test_a_rig_that_cannot_be_is_refused(mass, links):
    with pytest.raises(ConfigError, match="rig"):
        Rig(mass, links)


def test_one_value_far_off():
    rig = drawn(np.random.default_rng(0), 3)
    for seed in range(12):
        belief, name = far_off(np.random.default_rng(seed), rig, rig, (1.4, 1.7))
        what, k = name.split("_")
        true, wrong = ((r.mass[int(k)] if what == "mass" else getattr(r.links[int(k)], what)) for r in (rig, belief))
        assert 1.4 <= max(wrong / true, true / wrong) <= 1.7
        assert sum(a != b for a, b in zip((*rig.mass, *rig.links), (*belief.mass, *belief.links), strict=True)) == 1
