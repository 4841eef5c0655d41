"""The table of a result, for the terminal and for a README."""

from pipeline.blind_trial.metrics.rates import line
from pipeline.blind_trial.metrics.wording import rate_in_words

#: method whose rates name the rows
_FIRST = "diagnosis"


def lines(result):
    """Lines of the rates of the diagnosis, then of every baseline."""
    told = [f"{result['set']['name']}: {len(result['cases'])} cases, {result['set']['kind']}"]
    for method, numbers in result["methods"].items():
        told += ["", method.replace("_", " ")]
        told += [line(rate_in_words(name), one) + _goal(one) for name, one in numbers["rates"].items()]
        told.append(f"{numbers['cost']['total'] / 60:.1f} CPU minutes")
    return told


def as_markdown(result):
    """Table of the rates with a goal: every method in a column of its own."""
    methods = result["methods"]
    head = ["", "goal", *(method.replace("_", " ") for method in methods)]
    rows = [[rate_in_words(name), _goal(one).strip(),
             *(_cell(numbers["rates"].get(name)) for numbers in methods.values())]
            for name, one in methods[_FIRST]["rates"].items() if one["goal"]]
    return "\n".join([_row(head), "|" + "---|" * len(head), *map(_row, rows)])


def _row(cells):
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|"


def _goal(one):
    return f"   {one['goal'][0]} {one['goal'][1]:.0%}" if one["goal"] else ""


def _cell(one):
    if one is None:
        return ""
    return f"{one['hits']} of {one['count']} ({one['low']:.0%} to {one['high']:.0%})"
