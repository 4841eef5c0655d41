"""The plan before the bench: power of records in closed form, and the cheapest set."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.inference.planning.campaign import cheapest, combined_power, power, power_table


@pytest.mark.exact
def test_power_is_what_a_parameter_does_not_hide():
    direction, jacobian = np.array([3.0, 4.0]), np.array([[1e6], [0.0]])
    assert power(direction, np.zeros((2, 0))) == pytest.approx(5.0)
    assert power(direction, jacobian) == pytest.approx(4.0)
    assert power(direction, np.array([[1.0], [0.0]])) == pytest.approx(np.sqrt(16 + 9 / 2))


@pytest.mark.exact
def test_two_loads_reveal_what_one_hides():
    jacobian = np.full((4, 1), 1e4)
    low, high = np.full(4, 1.0), np.full(4, 3.0)
    directions, jacobians = [[low], [high]], [jacobian, jacobian]
    np.testing.assert_allclose(power_table(directions, jacobians), 0.0, atol=1e-3)
    assert combined_power(directions, jacobians, [0, 1])[0] == pytest.approx(np.sqrt(4 * 2), rel=1e-6)
    assert combined_power(directions, jacobians, [])[0] == 0.0


def test_the_cheapest_set_covers_and_holds_nothing_idle():
    none = np.zeros((1, 0))
    directions = [[np.array([5.0]), np.array([0.0])], [np.array([0.0]), np.array([6.0])],
                  [np.array([5.0]), np.array([5.0])], [np.array([1.0]), np.array([1.0])]]
    assert cheapest(directions, [none] * 4, [1.0, 1.0, 5.0, 0.1], [0, 1]) == (0, 1)
    assert cheapest(directions, [none] * 4, [1.0, 1.0, 1.0, 9.0], [0, 1]) == (2,)
    assert cheapest(directions, [none] * 4, [1.0, 1.0, 1.0, 9.0], [1]) in ((1,), (2,))


def test_what_no_record_can_name_is_told():
    with pytest.raises(ConfigError, match=r"records that can name effects \[1\]"):
        cheapest([[np.array([5.0]), np.array([1.0])]], [np.zeros((1, 0))], [1.0], [0, 1])
