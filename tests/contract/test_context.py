"""What a stage may use of its context."""

from functools import partial

from pipeline.contract import Context


def test_groups_run_in_one_round_and_come_back_one_by_one():
    rounds = []

    class Counted(Context):
        def map(self, function, items, label=""):
            rounds.append(label)
            return super().map(function, items, label)

    halves, none, wholes = Counted().side_by_side([partial(divmod, 7, 2)], [], [partial(int, "3"), partial(int, "4")],
                                                  label="numbers")
    assert (halves, none, wholes) == ([(3, 1)], [], [3, 4]) and rounds == ["numbers"]
