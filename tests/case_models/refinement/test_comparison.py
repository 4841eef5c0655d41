"""Which mode is which in the finer model, what counts as held, and what moved it."""

import numpy as np
import pytest

from pipeline.case_models.refinement.comparison import Comparison, Stated, Tolerances, causes, error_factor

LIMITS = Tolerances(0.005, 0.1, 10.0)
ROOT, REDUCED = np.array([300 + 6e4j, 40 + 2e4j]), np.array([295 + 6.001e4j, 35 + 2.001e4j])
#: by frequency, with one beside them that decays
STARTS = np.array([-20 + 1e4j, 35 + 2.001e4j, 295 + 6.001e4j])


def compared(finer, exact=True, base=None, bases=0.0):
    stated = Stated.of(ROOT, REDUCED, STARTS, exact)
    return Comparison(stated, stated.moved(np.array(finer), base), np.full(2, bases, complex), np.array(finer), LIMITS)


def test_modes_of_finite_elements_are_compared_as_they_are():
    made = compared([-19 + 1e4j, 45 + 2.001e4j, 310 + 6e4j])
    assert made.held.all() and not made.grows.any() and not len(made.moved)
    fields = made.fields()
    np.testing.assert_allclose(fields["refined_root"], [310 + 6e4j, 45 + 2.001e4j])
    assert fields["growth_change"] == pytest.approx(10) and fields["growth_share"] == pytest.approx(5 / 40)
    assert fields["frequency_change"] == pytest.approx(5e-4)


def test_others_by_the_change_between_two_models_of_elements():
    base = np.array([-20 + 1e4j, 50 + 2.1e4j, 280 + 6.1e4j])
    made = compared([-19 + 1e4j, 45 + 2.1e4j, 281 + 6.1e4j], False, base)
    np.testing.assert_allclose(made.fields()["refined_root"], ROOT + [1, -5])
    assert made.held.all()


@pytest.mark.parametrize("finer, held, moved", [
    ([-20 + 1e4j, 20 + 2e4j, 300 + 6e4j], [1, 0], [1]),         # growth
    ([-20 + 1e4j, 40 + 2e4j, 300 + 6.04e4j], [0, 1], [2]),      # frequency
    ([-20 + 1e4j, np.nan, 300 + 6e4j], [1, 0], [1]),            # gone
    ([15 + 1e4j, 40 + 2e4j, 300 + 6e4j], [1, 1], [0])])         # grows in the finer model alone
def test_what_does_not_stay_is_seen(finer, held, moved):
    made = compared(finer)
    assert list(made.held) == held and list(made.moved) == moved
    assert made.fields()["added"] == int(moved == [0])
    assert np.isfinite(made.fields()["refined_root"]).all() and list(made.found) == [1, int(np.isfinite(finer[1]))]


def test_a_mode_that_grows_by_no_more_than_what_is_neutral_may_decay():
    root = np.array([9 + 2e4j, 11 + 2e4j])
    assert list(LIMITS.hold(root, np.array([-40.0, -40.0]))) == [True, False]


def test_a_reduction_that_moves_modes_too_far_is_not_held():
    assert not compared([-20 + 1e4j, 40 + 2e4j, 300 + 6e4j], bases=-60.0).held.any()


@pytest.mark.parametrize("order, factor", [(2, 1.3), (2, 1.5), (4, 1.3)])
def test_errors_are_those_of_a_law_of_second_order_and_never_less_than_of_a_higher_one(order, factor):
    def root(size):
        return 300 + 7 * size**order

    error = error_factor(factor) * abs(root(1 / factor) - root(1.0))
    assert error == pytest.approx(7) if order == 2 else error > 7


def test_a_change_that_is_within_while_the_error_is_not_is_not_held():
    change = np.array([-20.0, 0.0])
    assert list(LIMITS.hold(ROOT, change)) == [True, True]
    assert list(LIMITS.hold(ROOT, change, error_factor(1.3))) == [False, True]


def test_a_mode_that_no_start_is_near_is_not_held():
    far = Stated.of(ROOT, REDUCED, STARTS[:2], True)
    assert list(far.start) == [-1, 1] and np.isnan(far.moved(STARTS[:2], None)[0])


def test_causes_are_changes_from_elements_of_the_same_meshes():
    asked = []

    def model(names, chosen):
        asked.append(names)
        return np.array([{(): 34, ("disc",): 33, ("bracket",): np.nan}[names]], complex)

    names, change = causes(("disc", "bracket"), model, np.array([41.0 + 0j]), np.array([1]))
    assert names == ("model", "disc", "bracket") and asked == [(), ("disc",), ("bracket",)]
    np.testing.assert_allclose(change.ravel(), [-7, -1, 0])
