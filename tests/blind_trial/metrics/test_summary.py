"""The table in the terminal and as Markdown."""

from pipeline.blind_trial.metrics.result import result
from pipeline.blind_trial.metrics.summary import as_markdown, lines
from tests.blind_trial.protocol.small_set import TOLD, TRUTH

FOUND = result({"name": "small", "kind": "open"}, TRUTH, {"diagnosis": TOLD, "largest_residual": TOLD})


def test_the_terminal_shows_every_rate_with_interval_and_goal():
    told = lines(FOUND)
    assert told[0] == "small: 3 cases, open" and "largest residual" in told
    alarm = next(line for line in told if line.startswith("false alarms"))
    assert "0 of 1" in alarm and "95 %: 0.0% to 79.3%" in alarm and alarm.endswith("at most 3%")


def test_markdown_holds_the_rates_with_a_goal_and_a_column_for_every_method():
    head, rule, *rows = as_markdown(FOUND).splitlines()
    assert head == "| | goal | diagnosis | largest residual |" and rule == "|---|---|---|---|"
    assert "| false alarms | at most 3% | 0 of 1 (0% to 79%) | 0 of 1 (0% to 79%) |" in rows
    assert not any("refused" in row for row in rows)
