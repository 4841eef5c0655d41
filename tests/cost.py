"""CPU seconds of the tests: the slowest are printed after every run, and folders over their budget.

A test is charged with what its worker and the processes that it waited for have used since the test before. That
includes fixtures of a wider scope: the first test of a file pays for what all of it shares.
"""

import os
from collections import defaultdict
from pathlib import Path

import pytest

#: tests printed
_SLOWEST = 20
#: CPU seconds that the tests of a folder may take, of each 850 that all of them do: processors differ
_BUDGETS = {"stages": 127, "chain": 130, "physics": 130, "views": 100, "diagnosis": 95, "effects": 45, "inference": 83,
            "contract": 45, "blind_trial": 45, "case_models": 35, "recordings": 30}
_OTHER, _WHOLE = 30, 850
#: tests that are all of them, or nearly: shares of fewer say nothing
_ALL = 5000
#: a file to which (CPU seconds, test) of every test is written, for a closer look
_TABLE = "BRAKECHAIN_TEST_COSTS"

_since, _collecting = os.times(), 0.0


def pytest_collection_finish():
    """What was imported and collected until now is told apart from the tests."""
    global _collecting
    _collecting = _spent()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport():
    """Write into the report of each phase what it has cost, into the first what collecting has."""
    global _collecting
    outcome = yield
    report = outcome.get_result()
    report.cpu_seconds, report.collecting, _collecting = _spent(), _collecting, 0.0


def _spent():
    """CPU seconds since the last call."""
    global _since
    before, _since = _since, os.times()
    return sum(_since[:4]) - sum(before[:4])


def pytest_terminal_summary(terminalreporter):
    """Print the slowest tests, and write all where a table is asked for."""
    reports = [report for reports in terminalreporter.stats.values() for report in reports]
    costs, collecting = of(reports), sum(getattr(report, "collecting", 0.0) for report in reports)
    if not costs:
        return
    order = sorted(costs, key=costs.get, reverse=True)
    if table := os.environ.get(_TABLE):
        Path(table).write_text("".join(f"{costs[test]:.3f}\t{test}\n" for test in order), encoding="utf-8")
    terminalreporter.section(f"{sum(costs.values()):.0f} CPU seconds and {collecting:.0f} for collecting; the"
                             f" {_SLOWEST} slowest of {len(order)} tests")
    for test in order[:_SLOWEST]:
        terminalreporter.line(f"{costs[test]:8.1f}  {test}")
    for line in over_budget(costs) if len(costs) > _ALL else ():
        terminalreporter.line(line)


def over_budget(costs):
    """A line for each folder of ``costs`` {test: CPU seconds} that takes more than its share of all."""
    folders, whole = defaultdict(float), sum(costs.values())
    for test, seconds in costs.items():
        folders[test.partition("::")[0].split("/")[1]] += seconds
    allowed = {folder: _BUDGETS.get(folder, _OTHER) * max(whole, _WHOLE) / _WHOLE for folder in folders}
    return [f"over its budget: tests/{folder}, {folders[folder]:.0f} CPU seconds, {allowed[folder]:.0f} allowed"
            for folder in sorted(folders) if folders[folder] > allowed[folder]]


def of(reports):
    """{test: CPU seconds} of all phases of all tests."""
    costs = defaultdict(float)
    for report in reports:
        if hasattr(report, "cpu_seconds"):
            costs[report.nodeid] += report.cpu_seconds
    return dict(costs)
