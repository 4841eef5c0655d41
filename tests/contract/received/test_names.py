"""Names lead nowhere else, and links do not either."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.contract.received import names


@pytest.mark.parametrize("name", ["foo/../../../victim", "/etc", "..", ".", "", "a/b", "a\\b", "a\n", ".lock",
                                  "x" * 201, 7, None])
def test_what_is_no_name(name):
    with pytest.raises(ConfigError, match="truth.json: expected a name of letters, digits and _ . -"):
        names.checked_all({name: 1}, "truth.json")


def test_a_name_and_a_path_inside(tmp_path):
    assert names.checked("run_1.a-b", "x") == "run_1.a-b"
    assert names.within(tmp_path, "answers/a.json") == tmp_path / "answers" / "a.json"


def test_a_path_or_a_link_out_of_the_folder(tmp_path):
    inside = tmp_path / "set"
    inside.mkdir()
    (inside / "answers").symlink_to(tmp_path)
    for name in ("../victim", "/etc/passwd", "answers/a.json"):
        with pytest.raises(ConfigError, match="expected a path inside"):
            names.within(inside, name)
