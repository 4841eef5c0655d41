"""Published facts as lists of lines."""

import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.lines import line_list
from pipeline.validation.published_facts import Published


def fact(key, value=100.0, **more):
    return Published(key=key, part="modes", role="test", quantity=key, value=value, unit=more.pop("unit", "Hz"),
                     tolerance=2.0, why="why", source="here", **more)


FACTS = (fact("mode_1_test", single=True, diameters=0), fact("mode_2_test", 33.0, single=False, doubt="misprint",
                                                           read_as=330.0), fact("step", unit="us"))


def test_patterns_choose_facts_and_doubted_values_enter_as_read():
    found = line_list(FACTS, ["mode_*_test"], 1, "disc", "here")
    assert found.label.tolist() == ["mode_1_test", "mode_2_test"] and found.frequency.tolist() == [100, 330]
    assert found.partners.tolist() == [1, 2] and found.diameters.tolist() == [0, -1] and str(found.place) == "disc"
    assert found.level_known.tolist() == [0, 0]


def test_a_base_has_its_multiples_with_their_tolerance():
    found = line_list(FACTS, ["mode_1_test"], 3, "", "here")
    assert found.frequency.tolist() == [100, 200, 300] and found.frequency_tolerance.tolist() == [2, 4, 6]
    assert found.label.tolist() == ["mode_1_test", "mode_1_test x 2", "mode_1_test x 3"]


@pytest.mark.parametrize("wanted, message", [(["mod_1"], "mod_1, which matches no key"),
                                             (["step"], "expected facts in Hz, found step")])
def test_refusals(wanted, message):
    with pytest.raises(ConfigError, match=message):
        line_list(FACTS, wanted, 1, "", "here")
