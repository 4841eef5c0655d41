"""The page of a scored trial, in the style of the report: rates, failures, and what the trial does not prove."""

from pipeline.blind_trial.metrics.wording import rate_in_words
from pipeline.contract.context import CaseSummary
from pipeline.views.chapters.bench import trial as chapters
from pipeline.views.chapters.chapter import Figure
from pipeline.views.figures.bench.trial import rates
from pipeline.views.figures.number_format import number, percent, plural
from pipeline.views.pages.summary import Verdict
from pipeline.views.pages.template import template

#: rates of the first screen
_FIRST = ("type and place, one effect", "both of a pair", "false alarms", "not in the catalogue: unknown",
          "sensor and solver called so", "held out within 1.2 noise floors, named")


def page(result):
    """HTML text of the page of a result.json; the same result gives the same bytes."""
    about, main = result["set"], result["methods"]["diagnosis"]
    names = [name for name, rate in main["rates"].items() if rate["goal"]]
    figure = Figure(rates(result["methods"], names, [rate_in_words(name) for name in names]),
                    "Rates with their 95 % Wilson confidence intervals; vertical bars: goals.")
    case = CaseSummary(about["name"], f"Concealed trial {about['name']}",
                "Cases with hidden physics, solved without access to the truth and scored once")
    return template().render(case=case, chapters=chapters.all_of(result), verdict=_verdict(result),
                             key_figures=(figure,), key_tables=(), stages=(), methods=(),
                             limits=chapters.not_proven(result), limits_name="not proven")


def _verdict(result):
    main = result["methods"]["diagnosis"]["rates"]
    missed = [name for name, rate in main.items() if rate["goal"] and not chapters.reached(rate)]
    return Verdict(_headline(main), "warning" if missed else "quiet", tuple(_answers(result, missed)),
                   tuple(_facts(result)))


def _headline(main):
    parts = []
    if rate := main.get("type and place, one effect"):
        parts.append(f"{rate['hits']} of {rate['count']} hidden effects correctly named and located")
    if rate := main.get("false alarms"):
        parts.append(f"{plural(rate['hits'], 'false alarm')} in {plural(rate['count'], 'control')}")
    return ", ".join(parts) or "No case of this set contains a single effect"


def _answers(result, missed):
    about = result["set"]
    sealed = about["kind"] == "sealed"
    yield "What was tested", (
        f"{plural(len(result['cases']), 'case')}, each a deliberately inaccurate nominal model and recordings of a"
        " different system; the diagnosis was given these two files only. " + (
            f"The truth was sealed under the commitment {about['commitment']} before any case was solved." if sealed
            else "This is an open set: its truth is visible to the authors of the method. It proves nothing by"
                 " itself."))
    for name in _FIRST:
        if rate := result["methods"]["diagnosis"]["rates"].get(name):
            label = rate_in_words(name)
            yield label[0].upper() + label[1:], chapters.in_words(rate)
    yield "Goals missed", "; ".join(map(rate_in_words, missed)) if missed else "None."
    yield "What it does not prove", chapters.not_proven(result)[0]


def _facts(result):
    about, cost = result["set"], result["methods"]["diagnosis"]["cost"]
    yield "Set", f"{about['name']}, {about['kind']}"
    yield "Cases", str(len(result["cases"]))
    if about.get("commit"):
        yield "Code", f"{about['version']}, commit {about['commit'][:10]}"
    yield "Catalogue", plural(len(about.get("catalogue", ())), "effect") if "catalogue" in about else "not recorded"
    yield "Diagnosis", f"{number(cost['total'] / 3600, 3)} CPU hours"
    wrong = sum("why" in case["answers"]["diagnosis"] for case in result["cases"].values())
    yield "Cases not correct", f"{wrong} of {len(result['cases'])} ({percent(wrong / len(result['cases']), 2)})"
