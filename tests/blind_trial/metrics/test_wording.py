"""Names of rates in words."""

from pipeline.blind_trial.metrics.result import GOALS
from pipeline.blind_trial.metrics.wording import rate_in_words


def test_every_rate_with_a_goal_has_words_and_no_two_the_same():
    words = [rate_in_words(name) for name in GOALS]
    assert len(set(words)) == len(words) and rate_in_words("false alarms") == "false alarms"
