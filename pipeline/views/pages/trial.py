"""The page of a scored trial, in the style of the report: rates, failures, and what the trial does not prove."""

from pipeline.contract.context import Case
from pipeline.views.chapters.bench import trial as chapters
from pipeline.views.chapters.chapter import Figure
from pipeline.views.figures.bench.trial import rates
from pipeline.views.figures.number_format import number, percent, plural
from pipeline.views.pages.report import template
from pipeline.views.pages.summary import Verdict

#: rates of the first screen
_FIRST = ("type and place, one effect", "both of a pair", "false alarms", "not in the catalogue: unknown",
          "sensor and solver called so", "held out within 1.2 noise floors, named")


def page(result):
    """HTML text of the page of a result.json; the same result gives the same bytes."""
    about, main = result["set"], result["methods"]["diagnosis"]
    names = [name for name, one in main["rates"].items() if one["goal"]]
    figure = Figure(rates(result["methods"], names),
                    "Rates with their 95 % intervals (Wilson); upright bars: what was to be reached.")
    case = Case(about["name"], f"Concealed trial {about['name']}",
                "Cases with hidden physics, solved without their truth and scored once")
    return template().render(case=case, chapters=chapters.all_of(result), verdict=_verdict(result), key_figure=figure,
                             key_tables=(), stages=(), methods=(), limits=chapters.not_proven(result),
                             limits_name="not proven")


def _verdict(result):
    main = result["methods"]["diagnosis"]["rates"]
    missed = [name for name, one in main.items() if one["goal"] and not chapters.reached(one)]
    return Verdict(_headline(main), "warning" if missed else "quiet", tuple(_answers(result, missed)),
                   tuple(_facts(result)))


def _headline(main):
    told = []
    if one := main.get("type and place, one effect"):
        told.append(f"{one['hits']} of {one['count']} hidden effects named at their place")
    if one := main.get("false alarms"):
        told.append(f"{plural(one['hits'], 'false alarm')} in {plural(one['count'], 'control')}")
    return ", ".join(told) or "No case of this set is scored by name"


def _answers(result, missed):
    about = result["set"]
    sealed = about["kind"] == "sealed"
    yield "What was tried", (
        f"{plural(len(result['cases']), 'case')}, each a nominal model with wrong values and recordings of something"
        " else; the diagnosis saw these two files only. " + (
            f"The truth was sealed under the commitment {about['commitment']} before anything was solved." if sealed
            else "This is an open set: whoever makes the method may look at its truth. It proves nothing by itself."))
    for name in _FIRST:
        if one := result["methods"]["diagnosis"]["rates"].get(name):
            yield name[0].upper() + name[1:], chapters.in_words(one)
    yield "Short of its goal", "; ".join(missed) if missed else "No rate."
    yield "What it does not prove", chapters.not_proven(result)[0]


def _facts(result):
    about, cost = result["set"], result["methods"]["diagnosis"]["cost"]
    yield "Set", f"{about['name']}, {about['kind']}"
    yield "Cases", str(len(result["cases"]))
    if about.get("commit"):
        yield "Code", f"{about['version']}, commit {about['commit'][:10]}"
    yield "Catalogue", plural(len(about.get("catalogue", ())), "effect") if "catalogue" in about else "not recorded"
    yield "Diagnosis", f"{number(cost['total'] / 3600, 3)} CPU hours"
    wrong = sum("why" in one["answers"]["diagnosis"] for one in result["cases"].values())
    yield "Cases not right", f"{wrong} of {len(result['cases'])} ({percent(wrong / len(result['cases']), 2)})"
