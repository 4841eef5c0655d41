"""The fuzzer finds what it is for: each way to fail is told apart, and the inputs after it are tried."""

import os
import signal
import time

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from tests.fuzz.trial import Outcome, Target, Trial, difference, outcome
from tests.fuzz.worker import tried


def _refuse(path):
    raise ConfigError(path, "another file", "this one")


def _stumble(path):
    raise KeyError("x")


def _kill(path):
    os.kill(os.getpid(), signal.SIGSEGV)


def _long(path):
    error = ConfigError("x")
    error.args = ("\x1b[2J" + "x" * 3000,)
    raise error


def target(read, **trial):
    """Every third input goes to ``read``, the others are read."""

    def number(rng):
        return Trial("a", bytes([int(rng.integers(256))]), **trial)

    made = Target("toy", read, number)
    whole = Target("toy", lambda path: 1, lambda rng: Trial("a", b""))

    class Mixed(Target):
        def trial(self, seed, k):
            return made.trial(seed, k) if k % 3 == 1 else whole.trial(seed, k)

    return Mixed("toy", lambda path: read(path) if path.read_bytes() else 1, number)


@pytest.mark.parametrize(
    "read, trial, kind",
    [
        (lambda path: 1, {}, "read"),
        (_refuse, {}, "refused"),
        (_stumble, {}, "internal"),
        (_long, {}, "internal"),
        (lambda path: 1, {"must": "refuse"}, "wrong"),
        (lambda path: 1, {"check": lambda value: "2"}, "wrong"),
        (_refuse, {"must": "read"}, "rejected"),
        (_kill, {}, "crash"),
        (lambda path: time.sleep(60), {}, "hang"),
        (lambda path: exit(3), {}, "internal"),
    ],
)
def test_each_failure_is_told_as_what_it_is_and_the_rest_is_tried(read, trial, kind):
    kinds = [result.kind for _, result in tried(target(read, **trial), 0, range(6), patience=1.0)]
    assert kinds == ["read", kind, "read", "read", kind, "read"]


def test_a_reader_apart_that_dies_is_asked_again_by_its_public_entry():
    """In the fast run it is in this process; the process of its own makes a sentence of its death."""
    parent = os.getpid()

    def read(path):
        if os.getpid() != parent:
            os.kill(os.getpid(), signal.SIGSEGV)
        raise ConfigError(path, "an undamaged file", "one that stops its reader (exit code -11)")

    ((number, result),) = tried(Target("toy", read, lambda rng: Trial("a", b""), apart=True), 0, [5])
    assert (number, result.kind) == (5, "contained") and "its process ended; " in result.said


def test_a_mistake_of_the_fuzzer_is_told_as_one():
    ((_, result),) = tried(Target("toy", _refuse, lambda rng: {}["x"]), 0, [0])
    assert (result.kind, result.how) == ("internal", "the fuzzer itself")


def test_the_time_ends_a_run():
    begin = time.monotonic()
    assert 1 <= len(list(tried(target(lambda path: 1), 0, range(10**9), begin + 0.5))) < 10**6
    assert time.monotonic() - begin < 5


def test_a_number_names_an_input_for_ever(tmp_path):
    made = Target(
        "toy", _refuse, lambda rng: Trial("a", rng.bytes(8)), (lambda rng: Trial("b", rng.bytes(8), must="read"),)
    )
    trials = [made.trial(7, k) for k in range(50)]
    assert [t.content for t in trials] == [made.trial(7, k).content for k in range(50)]
    assert len({t.content for t in trials}) == 50 and {t.name for t in trials} == {"a", "b"}
    assert isinstance(outcome(made, trials[0], tmp_path), Outcome) and not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "value, expected, same",
    [
        ({"a": [1.0, 2.0]}, {"a": np.array([1.0, 2.0])}, True),
        ({"a": 1}, {"b": 1}, False),
        ([1, 2], [1, 3], False),
        (np.array([1.0, np.nan]), np.array([1.0, np.nan]), True),
        ("m", "m", True),
        ("m", "mm", False),
        (np.ones(2), np.ones(3), False),
        ({"a": {"b": "x"}}, {"a": {"b": "y"}}, False),
        (np.array([1.0, 0.0]), np.array([1.0, 1e-3]), False),
    ],
)
def test_differences(value, expected, same):
    assert (difference(value, expected) == "") == same
