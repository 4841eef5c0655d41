"""Unstable modes before and after, on a brake of a few elements whose modes friction and joints change."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pipeline.case_models.countermeasures.matching import compared_modes, growth_error
from pipeline.case_models.countermeasures.nearby_modes import modes_about
from tests.case_models.countermeasures.two_brakes import brake, convergence


@cache
def compared(**changed):
    return compared_modes(brake(), brake(**changed), convergence(), 1e-6)


def states(rows):
    return {row.state for row in rows}


def test_the_same_brake_shows_no_difference():
    rows = compared()
    assert len(rows) == len(brake().modes.unstable_root) and states(rows) == {"unchanged"}
    assert all(row.clear and row.mac > 1 - 1e-6 and row.rival == 0 for row in rows)
    np.testing.assert_allclose([row.after for row in rows], [row.before for row in rows], rtol=1e-9)


def test_damping_takes_modes_away_and_says_where_they_went():
    rows = compared(loss=3.0)
    assert states(rows) == {"gone"} and all(row.clear and row.after.real < 0 < row.before.real for row in rows)
    assert all(abs(row.after.imag / row.before.imag - 1) < 5e-3 for row in rows)


def test_more_friction_makes_modes_stronger_and_others_new():
    rows = compared(friction=0.62)
    assert states(rows) == {"stronger", "new"} and all(row.clear for row in rows)
    assert all(row.after.real > 0 > row.before.real for row in rows if row.state == "new")
    after = [row.after for row in rows]
    for root in brake(friction=0.62).modes.unstable_reduced:        # each of them is in one row
        assert np.sum(abs(np.array(after) - root) < 1e-6 * abs(root)) == 1


def test_other_joints_move_frequencies_that_nearest_roots_would_mistake():
    """Stiffer joints raise modes past the places of others: the MAC follows them."""
    row = next(row for row in compared(stiffness=1.3) if row.state == "stronger" and row.operating == 0)
    roots = modes_about(brake(stiffness=1.3), 0, [row.before])[0]
    nearest = roots[np.argmin(abs(roots - row.before))]
    assert nearest.real < 0 < row.after.real and abs(nearest - row.after) > 500 and row.mac > 0.95


def test_what_is_ambiguous_is_not_forced():
    rows = compared(stiffness=2.5)
    doubt = [row for row in rows if not row.clear]
    assert "ambiguous" in states(doubt) and not states(doubt) & {"weaker", "stronger", "unchanged"}
    row = next(row for row in rows if row.state == "ambiguous")
    assert row.mac - row.rival < 0.1


def test_shapes_count_and_not_the_order_of_nodes():
    """The nodes of the other model permuted, a part of them left out: the same rows."""
    other, order = brake(friction=0.62), np.random.default_rng(1).permutation(len(brake().model.visible_position))
    chosen = order[:3 * len(order) // 4]
    model = replace(other.model, visible_position=other.model.visible_position[chosen],
                    visible_body=np.asarray(other.model.visible_body)[chosen], visible_face=np.zeros((0, 4), int),
                    recovery=other.model.recovery[chosen])
    rows = compared_modes(brake(), replace(other, model=model), convergence(), 1e-6)
    assert [row.state for row in rows] == [row.state for row in compared(friction=0.62)]


def test_roots_of_the_full_matrices_move_those_after_alike():
    base = brake()
    full = replace(base, modes=replace(base.modes, unstable_root=base.modes.unstable_root + 3 - 20j))
    rows = compared_modes(full, brake(), convergence(), 1e-6)
    assert states(rows) == {"unchanged"}
    np.testing.assert_allclose([row.after for row in rows], [row.before for row in rows], rtol=1e-9)


def test_error_of_a_growth_rate_holds_that_of_the_reduction():
    known = convergence(root=[100 + 5e4j], reduced_root=[92 + 5e4j], refined_root=[103 + 5e4j], found=[1], held=[1])
    assert growth_error(known, 100 + 5e4j) == pytest.approx(8)


def test_error_of_a_growth_rate_is_that_of_its_mode():
    known = convergence(root=[100 + 5e4j, 40 + 6e4j], refined_root=[130 + 5e4j, 40 + 6e4j], found=[1, 0],
                        held=[0, 0], growth_share=0.3, converged=0)
    assert growth_error(known, 90 + 5.05e4j) == pytest.approx(30)
    assert growth_error(known, 30 + 6e4j) == pytest.approx(40)      # it is gone in the finer model
    assert growth_error(known, 50 + 2e4j) == pytest.approx(0.3 * 50)
    assert growth_error(convergence(), 50 + 2e4j) == pytest.approx(5) and growth_error(convergence(), 2 + 2e4j) == 1
