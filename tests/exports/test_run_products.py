"""Names of what an export writes, and of operating points."""

from types import SimpleNamespace

import pytest

from pipeline.contract import ConfigError
from pipeline.exports.run_products import described, operating_point, refuse_existing, safe_names


def modes(unstable=()):
    return SimpleNamespace(operating_speed=[8.0, 12.5], operating_pressure=[1e6, 2.5e6], unstable_operating=unstable)


def test_operating_points_by_number():
    assert operating_point(modes()) == 0 and operating_point(modes((1, 0))) == 1
    assert operating_point(modes((1,)), 0) == 0
    assert described(modes(), 1) == "1 (2.5 MPa, 12.5 rad/s)"
    with pytest.raises(ConfigError, match="--state: expected one of 0 .*, found -1"):
        operating_point(modes(), -1)


def test_names_are_safe_and_each_stands_once():
    assert safe_names(["a b", "a/b", "a_b", "", "\N{GREEK SMALL LETTER MU}"]) == ["a_b", "a_b_2", "a_b_3", "_", "__2"]


def test_what_is_there_is_not_overwritten(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="a name that is free, found a file"):
        refuse_existing(tmp_path / "file")
    (tmp_path / "link").symlink_to(tmp_path / "nothing")
    with pytest.raises(ConfigError, match="a name that is free"):
        refuse_existing(tmp_path / "link")
    refuse_existing(tmp_path / "new")
