"""Chapters that fail are told, and cost nothing else."""

from pipeline.contract import ConvergenceError
from pipeline.diagnosis.output.attempts import Attempts


def test_what_fails_is_told_in_one_sentence_and_the_rest_goes_on():
    attempt = Attempts()
    assert attempt("the place", lambda k: k + 1, 1) == 2 and not attempt.failures
    assert attempt("the place", lambda: 1 / 0, otherwise={}) == {}

    def stuck():
        raise ConvergenceError("time stepping at t = 1 s", "a force that settles", "none")

    assert attempt("the next experiment", stuck) is None
    first, second = attempt.failures
    assert first.startswith("the place could not be computed: internal error ZeroDivisionError: division by zero (")
    assert first.endswith("please report it with the case")
    assert second == "the next experiment could not be computed: " + (
        "time stepping at t = 1 s: expected a force that settles, found none")
