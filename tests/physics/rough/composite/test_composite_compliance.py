"""Contact on a composite block: complementarity with its own finite elements, one modulus as its limit."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.composite import composite_compliance
from pipeline.physics.rough.composite.composite_block import composite_block
from pipeline.physics.rough.composite.composite_compliance import CompositeCompliance
from pipeline.physics.rough.contact.normal_contact import apply, interface_stiffness, solve_normal_contact, uniform
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.layered_solid import layered_compliance

N, SPACING, DEPTH = 16, (1.0, 1.0), np.array([0.0, 1.0, 2.5, 5.0, 9.0])
MEAN, TOLERANCE = 0.004, 1e-5
Y, X = np.mgrid[:N, :N] * 2 * np.pi / N
GAP = 0.05 * (np.cos(X) * np.cos(Y) + 0.5 * np.sin(2 * X + Y))


def pair(factor, alike=1.0):
    block = composite_block(factor, SPACING, DEPTH, 1.0, 0.3)
    one = layered_compliance((N, N), SPACING, DEPTH, alike, 0.3).normal
    other = layered_compliance((N, N), SPACING, DEPTH, 5.0, 0.3).normal
    return CompositeCompliance(one + other, one, block), other


@pytest.fixture
def mixed():
    return np.where(np.random.default_rng(1).random((DEPTH.size - 1, N, N)) < 0.3, 8.0, 1.0)


def test_no_node_overlaps_and_none_that_bears_is_open(mixed):
    compliance, other = pair(mixed, 2.0)
    found = solve_normal_contact(GAP, compliance, MEAN, tolerance=TOLERANCE)
    left = GAP + apply(other, found.pressure) + compliance.block.under(found.pressure, tolerance=1e-9)[0, ..., 2]
    left -= found.approach
    bears = found.pressure > 0
    assert 0.1 < bears.mean() < 0.9 and found.pressure.mean() == pytest.approx(MEAN, rel=1e-9)
    assert np.abs(left[bears]).max() < 3 * TOLERANCE * GAP.std() and left.min() > -3 * TOLERANCE * GAP.std()


def test_the_modulus_from_which_it_is_corrected_does_not_matter(mixed):
    first, second = (solve_normal_contact(GAP, pair(mixed, alike)[0], MEAN, tolerance=TOLERANCE)
                     for alike in (1.5, 4.0))
    np.testing.assert_allclose(first.pressure, second.pressure, atol=2e-3 * first.pressure.max())
    assert first.approach == pytest.approx(second.approach, rel=1e-4)


@pytest.mark.parametrize("hardness", [np.inf, 0.012])
def test_of_one_modulus_it_is_the_contact_of_layers(hardness):
    """Its finite elements are solved to a share of the tolerance."""
    compliance, _ = pair(np.full((DEPTH.size - 1, N, N), 2.0), 1.3)
    alone = solve_yielding_contact(GAP, pair(np.full((DEPTH.size - 1, N, N), 2.0), 2.0)[0].whole, MEAN,
                                   tolerance=TOLERANCE, hardness=hardness)
    found = solve_yielding_contact(GAP, compliance, MEAN, tolerance=TOLERANCE, hardness=hardness)
    np.testing.assert_allclose(found.pressure, alone.pressure, atol=2e-3 * alone.pressure.max())
    np.testing.assert_allclose(found.flattened, alone.flattened, atol=1e-3 * GAP.std())
    assert uniform(compliance) == pytest.approx(uniform(pair(np.ones((1, N, N)).repeat(4, 0), 2.0)[0].whole), rel=1e-4)


def test_stiffness_of_the_interface_and_stiffer_particles(mixed):
    soft, stiff = pair(np.ones_like(mixed), 1.0)[0], pair(mixed, 2.0)[0]
    stiffness = [interface_stiffness(GAP, c, solve_normal_contact(GAP, c, MEAN, tolerance=TOLERANCE), TOLERANCE, 2000)
                 for c in (soft, stiff)]
    areas = [(solve_normal_contact(GAP, c, MEAN, tolerance=TOLERANCE).pressure > 0).mean() for c in (soft, stiff)]
    assert stiffness[0] > 0 and stiffness[1] > 0 and areas[1] < areas[0]


def test_a_correction_that_does_not_settle_raises(mixed, monkeypatch):
    monkeypatch.setattr(composite_compliance, "_STEPS", 1)
    with pytest.raises(ConvergenceError, match="settles"):
        solve_normal_contact(GAP, pair(100 * mixed, 1.0)[0], MEAN, tolerance=1e-9)
