"""How a term changes with speed and friction, as text."""

import pytest

from pipeline.case_models.matrices.dependence import summands
from pipeline.contract import ConfigError


@pytest.mark.parametrize("text, found", [
    ("1", [(1, 0, 0)]), ("speed", [(1, 1, 0)]), ("friction/speed - 1", [(1, -1, 1), (-1, 0, 0)]),
    ("speed^2 - 1", [(1, 2, 0), (-1, 0, 0)]), ("-0.5 friction * speed**2", [(-0.5, 2, 1)]),
    ("2e-1/4/friction^-2", [(0.05, 0, 2)]), (" 3 speed + .5 ", [(3, 1, 0), (0.5, 0, 0)])])
def test_sums_of_products(text, found):
    assert list(summands(text, "x")) == [pytest.approx(each) for each in found]


@pytest.mark.parametrize("text", ["", "speed +", "sped", "1/0", "speed^10^10", "(speed)", "2^3", "speed^99",
                                  "speed 1 -", "1" * 300, "__import__('os')", "speed speed^9 speed^9"])
def test_what_is_none_is_refused(text):
    with pytest.raises(ConfigError, match=r"^\[?x|x: "):
        summands(text, "x")
