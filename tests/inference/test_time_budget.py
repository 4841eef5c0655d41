"""A diagnosis whose time is spent: it ends, says so, and names nothing that the whole one would not."""

import os
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from pipeline.diagnosis.problem import DiagnosisProblem
from pipeline.inference import time_budget
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.noise import budget
from pipeline.inference.procedure import diagnose
from tests.inference.oscillator import CATALOGUE, bench, both
from tests.inference.test_procedure import coulomb


class Counted:
    """A forward model after so many predictions of which the time is spent."""

    def __init__(self, predict):
        self.predict, self.count = predict, 0

    def __call__(self, *args):
        self.count += 1
        return self.predict(*args)

    @contextmanager
    def until(self, most):
        with time_budget.until(lambda: self.count >= most):
            yield self


def told(problem, most):
    """(Diagnosis after so many predictions, their number)."""
    counted = Counted(problem.predict)
    with counted.until(most):
        found = diagnose(replace(problem, predict=counted), budget(problem), CATALOGUE, Settings(draws=500))
    return found, counted.count


@pytest.mark.parametrize("truth, shares", [
    ({"stiffness": 380.0, "extra": both}, (0.5,)), ({}, (0.0, 0.3))], ids=["two", "none"])
def test_it_ends_at_any_time_and_names_nothing_else(truth, shares):
    problem = bench(5, 0.05, **truth)
    whole, count = told(problem, np.inf)
    names = {e for e, _ in whole.nominal.effects} | {c.name for c in whole.decision.named}
    for share in shares:
        short, _ = told(problem, share * count)
        assert {e for e, _ in short.nominal.effects} | {c.name for c in short.decision.named} <= names
        assert short.decision.verdict in ("unknown", whole.decision.verdict)
        if short.decision.verdict == "unknown" != whole.decision.verdict:
            assert "diagnosis.time" in short.decision.reasons[0]


def test_it_says_how_far_it_came_and_what_took_the_time():
    problem, said = bench(5, 0.05, stiffness=430.0, extra=coulomb), []
    asked = DiagnosisProblem(problem, budget(problem), CATALOGUE, {}, Settings(draws=500, seconds=1e-3))
    found = asked.solved(log=said.append)
    assert found.cut_short and found.decision.verdict == "unknown" and not found.decision.named
    assert said[0].startswith("first verdict after") and "of a core" in said[-1]
    said.clear()
    found = replace(asked, settings=Settings(draws=500)).solved(log=said.append)
    assert not found.cut_short and [c.name for c in found.decision.named] == ["coulomb"]
    assert "led by coulomb" in said[0] and "most by" in said[-1]


def test_tasks_of_other_processes_count_side_by_side():
    spent = time_budget.TimeBudget(10.0)

    def elsewhere(function, items):
        return [(item, "law", process, 4.0) for process, item in items]

    assert spent.over(elsewhere)(None, [(-1, "a"), (-2, "b"), (-1, "c")]) == ["a", "b", "c"]
    assert 8.0 <= spent.used < 9.0 and spent.by_name == {"law": 12.0}
    with spent.counting():
        assert not time_budget.spent()
        spent.over(elsewhere)(None, [(-1, "d")])
        assert time_budget.spent()
    assert not time_budget.spent()


def test_tasks_of_a_round_in_one_process_share_what_is_left(monkeypatch):
    now = [0.0]
    monkeypatch.setattr(time_budget.time, "process_time", lambda: now[0])

    def task(seconds):
        now[0] += seconds
        return time_budget.spent()

    assert time_budget.TimeBudget(10.0).over(map)(task, [4.0, 4.0, 4.0]) == [False, False, True]


def test_a_part_of_the_time_goes_to_what_comes_first(monkeypatch):
    now = [0.0]
    for clock in ("process_time", "monotonic"):
        monkeypatch.setattr(time_budget.time, clock, lambda: now[0])
    with time_budget.share(0.5):
        assert not time_budget.spent(), "nothing is counted"
    with time_budget.TimeBudget(10.0).counting():
        now[0] = 2.0
        with time_budget.share(0.5):
            now[0] = 5.9
            assert not time_budget.spent()
            now[0] = 6.1
            assert time_budget.spent()
        assert not time_budget.spent()
        now[0] = 10.1
        assert time_budget.spent()


def test_cpu_time_is_read_no_sooner_than_it_can_be_gone_and_soon_enough(monkeypatch):
    """A process of as many threads as there are cores, each asking every millisecond."""
    now, cores, read = [0.0], os.cpu_count() or 1, []
    monkeypatch.setattr(time_budget.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(time_budget.time, "process_time", lambda: (read.append(now[0]), cores * now[0])[1])
    with time_budget.within(5.0 * cores):
        while not time_budget.spent():
            now[0] += 1e-3
    assert 5.0 <= now[0] < 5.002 and len(read) < 70
