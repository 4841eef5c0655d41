"""The table of a result, for the terminal and for a README."""

from pipeline.blind_trial.metrics.rates import line
from pipeline.blind_trial.metrics.wording import rate_in_words

#: method whose rates name the rows
_FIRST = "diagnosis"


def lines(result):
    """Lines of the rates of the diagnosis, then of every baseline."""
    text = [f"{result['set']['name']}: {len(result['cases'])} cases, {result['set']['kind']}"]
    for method, numbers in result["methods"].items():
        text += ["", method.replace("_", " ")]
        text += [line(rate_in_words(name), rate) + _goal(rate) for name, rate in numbers["rates"].items()]
        text.append(f"{numbers['cost']['total'] / 60:.1f} CPU minutes")
    return text


def as_markdown(result):
    """Table of the rates with a goal: every method in a column of its own."""
    methods = result["methods"]
    head = ["", "goal", *(method.replace("_", " ") for method in methods)]
    rows = [[rate_in_words(name), _goal(rate).strip(),
             *(_cell(numbers["rates"].get(name)) for numbers in methods.values())]
            for name, rate in methods[_FIRST]["rates"].items() if rate["goal"]]
    return "\n".join([_row(head), "|" + "---|" * len(head), *map(_row, rows)])


def _row(cells):
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|"


def _goal(rate):
    return f"   {rate['goal'][0]} {rate['goal'][1]:.0%}" if rate["goal"] else ""


def _cell(rate):
    if rate is None:
        return ""
    return f"{rate['hits']} of {rate['count']} ({rate['low']:.0%} to {rate['high']:.0%})"
