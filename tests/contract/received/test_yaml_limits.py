"""YAML that would take all memory or the process is refused, and numbers to the base 60 are texts."""

import time

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.documents import parse_value, read_yaml

TENS = list(zip("abcdefghijk", "bcdefghijkl", strict=True))
LISTS = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{n}: &{n} [{', '.join([f'*{p}'] * 10)}]\n" for p, n in TENS)
MERGES = "a: &a {x: 1}\n" + "".join(f"{n}: &{n}\n  <<: [{', '.join([f'*{p}'] * 10)}]\n" for p, n in TENS)


@pytest.mark.parametrize("text, told", [
    (LISTS, "yaml:6: expected at most 200000 values"), (MERGES, "expected at most 200000 values"),
    ("a: &a [*a]\n", "an alias of what is complete"), ("[" * 300_000, "at most 50 lists"),
    ("- " * 200_000 + "x", "at most 50 lists"), ("a: " + "x" * 2_000_000, "more than 2000000 bytes"),
    ("a: " + "9" * 5000, "yaml:1: expected a number of at most 300 digits, found 5000"), ("a: *b\n", "undefined alias"),
    ("? [a]\n: 1\n", "unhashable")])
def test_documents_that_are_refused_in_no_time(tmp_path, in_time, text, told):
    (tmp_path / "a.yaml").write_text(text)
    begin = time.perf_counter()
    with pytest.raises(ConfigError, match=told) as refusal:
        read_yaml(tmp_path / "a.yaml")
    assert time.perf_counter() - begin < 2.0 and len(str(refusal.value)) <= 2000


def test_an_alias_that_harms_nobody(tmp_path):
    (tmp_path / "a.yaml").write_text("a: &a [1, 2]\nb: *a\nc: {<<: &d {x: 1}, y: 2}\n")
    assert read_yaml(tmp_path / "a.yaml") == {"a": [1, 2], "b": [1, 2], "c": {"x": 1, "y": 2}}


def test_numbers_to_the_base_60_are_texts():
    assert parse_value("[1:30, 12:30:45.5, -1:20, 0x1F, 1.5, 1_000]") == ["1:30", "12:30:45.5", "-1:20", 31, 1.5, 1000]
    assert isinstance(parse_value("1" + ":00" * 2000), str)
