"""Normal laws as the compiled steps see them: one value for each contact, and laws that cannot be."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.time_stepping_contact import HARD, LAGRANGE, PENALTY, TABLE
from pipeline.physics.time_stepping_laws import Forward, Hard, Lagrange, Penalty, Table, contiguous, normal_kernel
from tests.physics.lumps import lumps

pytestmark = pytest.mark.exact
TWO = lumps([1.0, 1.0], normal=np.eye(2), tangent=np.zeros((2, 2))).contacts


@pytest.mark.parametrize("law, kind, newmark", [
    (Hard(), HARD, False), (Penalty(1e6), PENALTY, False), (Penalty(1e6, gamma=0.5), PENALTY, True),
    (Table(np.array([0, 1.0]), np.array([0, 1.0])), TABLE, False), (Lagrange(), LAGRANGE, True),
    (Forward(), LAGRANGE, False)])
def test_each_law_has_its_kind_and_its_rule(law, kind, newmark):
    found = normal_kernel(law, TWO)
    assert (found.kind, found.newmark) == (kind, newmark)


def test_one_value_serves_all_contacts_and_each_may_have_its_own():
    found = normal_kernel(Penalty(np.array([1e6, 2e6]), 5.0, gap=1e-3), TWO)
    assert found.stiffness.tolist() == [1e6, 2e6] and found.damping.tolist() == [5, 5]
    assert found.gap.tolist() == [1e-3, 1e-3]


@pytest.mark.parametrize("law, said", [
    (Hard(-0.1), "restitution: expected between 0 and 1"), (Lagrange(1.1), "gamma: expected between 0.5 and 1"),
    (Penalty(np.array([1.0, 0.0])), "contact stiffness: expected above 0"),
    (Table(np.array([0, 1.0, 1.0]), np.array([0, 1.0, 2.0])), "rise from 0")])
def test_laws_that_cannot_be_are_refused(law, said):
    with pytest.raises(ConfigError, match=said):
        normal_kernel(law, TWO)


def test_a_contiguous_copy_leaves_the_given_array_alone():
    given = np.arange(6).reshape(2, 3).T
    copy = contiguous(given)
    copy[0, 0] = 7.0
    assert given[0, 0] == 0 and copy.flags.c_contiguous and copy.dtype == float
