"""Chapters of the page of a trial."""

from pipeline.blind_trial.metrics.wording import rate_in_words
from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import trial as pictures
from pipeline.views.figures.number_format import number, percent, plural

#: column of correct effects
_SELF = "correct effect"
#: true class of a case, in words
_CLASSES = {"effect": "single effect", "pair": "two effects", "control": "nothing missing",
            "wrong_value": "wrong parameter value", "sensor": "sensor fault", "solver": "solver error",
            "foreign": "outside the catalogue", "below": "below the threshold"}
#: which fitted values are compared with the truth, in words
_VALUES = {"nominal": "nominal parameters", "lacking": "nominal parameters of incomplete models",
           "effects": "parameters of named effects"}


def all_of(result):
    """Chapters of a result, in reading order."""
    main = result["methods"]["diagnosis"]
    chapters = (_rates(result), _confusion(main), _detection(main, result["thresholds"]), _systems(main),
             _calibration(main), _held_out(result), _parameters(main, result.get("errata", ())), _cost(result),
             _failures(result))
    return [chapter for chapter in chapters if chapter]


def reached(rate):
    """Whether a rate reaches its goal: [at least | at most | interval around, value]."""
    sense, goal = rate["goal"]
    value = rate["hits"] / rate["count"]
    return {"at least": value >= goal, "at most": value <= goal, "interval around": rate["low"] <= goal <= rate["high"]
            }[sense]


def in_words(rate):
    """'12 of 13, 92 % (95 %: 67 % to 99 %); goal: at least 85 %.'"""
    goal = f"; goal: {rate['goal'][0]} {percent(rate['goal'][1], 2)}" if rate["goal"] else ""
    return (f"{rate['hits']} of {rate['count']}, {percent(rate['hits'] / rate['count'], 2)} (95 %:"
            f" {percent(rate['low'], 2)} to {percent(rate['high'], 2)}){goal}.")


def _cell(rate):
    if rate is None:
        return "—"
    return (f"{rate['hits']} of {rate['count']} = {percent(rate['hits'] / rate['count'], 3)}"
            f" ({percent(rate['low'], 2)} to {percent(rate['high'], 2)})")


def _rates(result):
    methods = result["methods"]
    main = methods["diagnosis"]["rates"]
    head = ("rate", *(m.replace("_", " ") for m in methods), "goal", "goal met")
    rows = tuple((rate_in_words(name), *(_cell(numbers["rates"].get(name)) for numbers in methods.values()),
                  f"{rate['goal'][0]} {percent(rate['goal'][1], 3)}" if rate["goal"] else "",
                  ("within" if reached(rate) else "outside") if rate["goal"] else "") for name, rate in main.items())
    others = plural(len(methods) - 1, "baseline")
    return Chapter("rates", "Rates", f"Every rate with its 95 % Wilson confidence interval, beside {others} on the same"
                                     " files.",
                   _beaten(methods), (), (Table(head, rows, "Rates", tuple(range(1, len(methods) + 1))),))


def _beaten(methods):
    """The best baseline at identifying single effects."""
    name = "type and place, one effect"
    main = methods["diagnosis"]["rates"].get(name)
    others = {m: n["rates"].get(name) for m, n in methods.items() if m != "diagnosis" and n["rates"].get(name)}
    if not main or not others:
        return "No baseline was run on this set."
    better = [m.replace("_", " ") for m, rate in others.items() if rate["hits"] >= main["hits"]]
    best = max(others, key=lambda m: others[m]["hits"])
    sentence = f"The best baseline for single effects is {best.replace('_', ' ')}: {in_words(others[best])}"
    return f"{sentence} {'As good as the diagnosis or better: ' + ', '.join(better) + '.' if better else ''}".strip()


def _confusion(main):
    named = main["names"]
    figures = [Figure(pictures.table(main["confusion"], "true class", "verdict"),
                      "Cases of each true class by verdict; colour: fraction of the class.")]
    if named:
        counts = {hidden: {_SELF if name == hidden else name: count for name, count in row.items()}
                for hidden, row in sorted(named.items())}
        figures.append(Figure(pictures.table(counts, "hidden effect", "named effect"),
                              "Effect named for each hidden effect, at any location; verdicts where none was named."))
    rows = tuple((_CLASSES[kind], verdict, str(count)) for kind, row in main["confusion"].items()
                 for verdict, count in sorted(row.items(), key=lambda r: -r[1]))
    return Chapter("confusion", "Confusion matrix", "Rows: true class; columns: verdict.",
                   f"Columns other than '{_SELF}' are confusions or abstentions.", tuple(figures),
                   (Table(("true class", "verdict", "cases"), rows, "All verdicts", (2,), folded=True),))


def _detection(main, thresholds):
    points = main["detection"]
    if not points:
        return None
    rows = tuple((percent(p["noise"], 2), f"{percent(p['low'], 2)} to {percent(p['high'], 2)}", _cell(p["right"]))
                 for p in points)
    figures = (Figure(pictures.detection(points), "Fraction correctly named and located over effect size and noise,"
                                                  " with 95 % intervals."),
               *_visible(main["visible"], thresholds))
    return Chapter("detection", "Detection limit", "Fraction of hidden effects, sensor faults included, that were"
                   " correctly named and located, over the change that they cause in the sensor signals.",
                   "A small effect in strong noise is not named; abstaining is the correct answer there.", figures,
                   (Table(("noise", "size", "correctly named and located"), rows, "Detection", (2,)),))


def _visible(points, thresholds):
    if points:
        yield Figure(pictures.visible(points, thresholds), "Fraction correctly named and located over the residual of"
                     " the effect after refitting the nominal parameters; below"
                     f" {' or '.join(f'{t:g}' for t in thresholds)} standard deviations (line) an effect counts as too"
                     " faint, and abstaining is correct.")


def _systems(main):
    rows = tuple((name.replace("_", " "), _cell(system.get("named")), _cell(system.get("false_alarm")),
                  _cell(system.get("unknown")), number(system["cpu"], 3)) for name, system in main["systems"].items())
    head = ("system", "single effect: type and location correct", "false alarms",
            "outside the catalogue: reported as unknown", "CPU seconds per case")
    alarms = main["rates"].get("false alarms")
    sentence = f"False alarms: {in_words(alarms)}" if alarms else "The set has no controls."
    return Chapter("systems", "By system, and false alarms", "The same rates for every system of the set.", sentence,
                   (), (Table(head, rows, "By system", (1, 2, 3, 4)),))


def _calibration(main):
    calibration = main["calibration"]
    if not calibration["count"]:
        return None
    rows = tuple((f"{percent(b['low'], 3)} to {percent(b['high'], 3)}", percent(b["stated"], 3), _cell(b["so"]))
                 for b in calibration["bins"])
    return Chapter("calibration", "Are stated probabilities calibrated?",
                   f"{plural(calibration['count'], 'statement')} of the form 'this effect, at this location, with"
                   " this probability', alone or in a tie.",
                   f"Brier score {number(calibration['brier'], 3)} (0: always certain and correct; 0.25: a coin toss).",
                   (Figure(pictures.reliability(calibration["bins"]), "Reliability diagram: fraction correct over"
                           " stated probability, with 95 % intervals."),),
                   (Table(("stated", "mean", "correct"), rows, "Reliability", (1, 2)),))


def _held_out(result):
    rows = []
    for case in result["cases"].values():
        answer = case["answers"]["diagnosis"]
        fit = answer.get("fit", {}).get("held_out", {})
        if answer["verdict"] == "missing" and fit.get("noise_floor"):
            rows.append((fit["recalibrated"] / fit["noise_floor"], fit["after"] / fit["noise_floor"],
                         answer["judged"]["right"]))
    if not rows:
        return None
    rate = result["methods"]["diagnosis"]["rates"]["held out within 1.2 noise floors, named"]
    return Chapter("held_out", "Does the completed model predict?", "Error on held-out runs over the noise floor,"
                   " before and after the named effect is added.",
                   f"Within 1.2 noise floors: {in_words(rate)}",
                   (Figure(pictures.held_out(rows), "Below the diagonal the completed model predicts better than"
                           " the recalibrated nominal one; dashed: 1.2 noise floors."),))


def _parameters(main, errata):
    errors = main["parameters"]
    kinds = [(name, errors[key]) for key, name in _VALUES.items() if errors.get(key, {}).get("count")]
    if not kinds:
        return None
    rows = tuple((name, str(statistics["count"]), percent(statistics["median_error"], 2),
                  _cell(statistics["within_68"]), _cell(statistics["within_95"])) for name, statistics in kinds)
    head = ("parameters", "count", "median error", "within 1 standard deviation", "within 1.96")
    excluded = "".join(f" Excluded: {', '.join(erratum['parameters'])} of {erratum['system'].replace('_', ' ')}:"
                    f" {erratum['reason']}." for erratum in errata)
    return Chapter("parameters", "Are fitted parameters correct?", "Fitted parameters of the correctly diagnosed cases,"
                   f" compared with the truth where the set gives it.{excluded}", "Of calibrated errors 68 % lie within"
                   " one stated standard deviation and 95 % within 1.96. Where an effect is too faint to be named, or"
                   " outside the catalogue, parameters compensate for what the model lacks.", tuple(
                       Figure(pictures.distances(statistics["distances"]), f"Deviation of {name} from the truth in"
                              " stated standard deviations (cut at 8).") for name, statistics in kinds),
                   (Table(head, rows, "Fitted parameters", (1, 2, 3, 4)),))


def _cost(result):
    rows = tuple((method.replace("_", " "), name.replace("_", " "), str(cost["count"]), number(cost["median"], 3),
                  number(cost["largest"], 3)) for method, numbers in result["methods"].items()
                 for name, cost in numbers["cost"]["systems"].items())
    totals = "; ".join(f"{m.replace('_', ' ')} {number(n['cost']['total'] / 60, 3)} CPU minutes"
                       for m, n in result["methods"].items())
    return Chapter("cost", "Cost", "CPU seconds per case, including program start.", f"Total: {totals}.", (),
                   (Table(("method", "system", "cases", "median", "largest"), rows, "CPU seconds", (2, 3, 4)),))


def _failures(result):
    wrong = {n: case for n, case in result["cases"].items() if "why" in case["answers"]["diagnosis"]}
    rows = tuple((number_, _CLASSES[case["class"]], _hidden(case["truth"]),
                  _verdict(case["answers"]["diagnosis"]), case["answers"]["diagnosis"]["why"][0])
                 for number_, case in wrong.items())
    if not rows:
        return Chapter("failures", "Failures", "Every case of this set was diagnosed correctly.", "There is nothing to"
                                                                                                  " show.")
    head = ("case", "class", "truth", "verdict", "what went wrong")
    return Chapter("failures", "Failures", f"{plural(len(wrong), 'case')} not diagnosed correctly; each has a section"
                                           " below.",
                   "brakechain run cases/NNN/nominal.yaml writes the full report of a case.", (),
                   (Table(head, rows, "Cases not diagnosed correctly", (), (4,)),
                    *(_case_page(n, case) for n, case in wrong.items())))


def _case_page(number_, case):
    truth, diagnosis = case["truth"], case["answers"]["diagnosis"]
    rows = [("system", truth.get("system", "").replace("_", " ")), ("truth", _hidden(truth)),
            ("size, noise", f"{percent(truth.get('size', 0), 2)}, {percent(truth.get('noise', 0), 2)}"),
            *((("residual after refitting", f"{number(truth['left'], 2)} standard deviations"),)
              if "left" in truth else ()), ("verdict", _verdict(diagnosis)),
            *(("why", sentence) for sentence in diagnosis["why"])]
    for part, fit in diagnosis.get("fit", {}).items():
        if fit.get("noise_floor"):
            rows.append((f"error, {part.replace('_', ' ')}", f"nominal {percent(fit['before'], 3)}, recalibrated"
                         f" {percent(fit['recalibrated'], 3)}, completed {percent(fit['after'], 3)}, noise"
                         f" {percent(fit['noise_floor'], 3)}"))
    rows += [("also considered", f"{_at(e)} ({percent(e['posterior'], 3)})")
             for e in diagnosis.get("alternatives", ())[:3] if "posterior" in e]
    rows += [(method.replace("_", " "), _verdict(answer)) for method, answer in case["answers"].items()
             if method != "diagnosis"]
    return Table(("", ""), tuple(rows), f"Case {number_}: {_hidden(truth)}; verdict {_verdict(diagnosis)}", (), (1,),
                 folded=True)


def _hidden(truth):
    return " and ".join(map(_at, truth["effects"])) or _CLASSES[truth["class"]]


def _verdict(answer):
    named = (" or " if answer["verdict"] == "tie" else " and ").join(map(_at, answer["effects"]))
    return f"{answer['verdict']}: {named}" if named else answer["verdict"]


def _at(effect):
    name = effect["name"].replace("_", " ")
    return f"{name} at {effect['place']}" if effect["place"] else name


def not_proven(result):
    """What the trial does not prove, in sentences."""
    sentences = ["No recording of a real squealing brake was available to it: none with an open licence was found.",
            "The hidden physics comes from generators that share no code with the diagnosis but were written by people"
            " who know it; physics that nobody thought of is not included.",
            "Nominal models have the right structure: one or two terms are missing, and parameter values are off."
            " Models that are wrong throughout were not tried.",
            "The rates hold for the sampled effect sizes, noise levels, systems and sensors."]
    alarms = result["methods"]["diagnosis"]["rates"].get("false alarms")
    if alarms:
        sentences.append(f"With {plural(alarms['hits'], 'false alarm')} in {plural(alarms['count'], 'control')} the"
                         f" true rate may still be as high as {percent(alarms['high'], 2)}.")
    if result["set"]["kind"] != "sealed":
        sentences.append("The set is open: methods may have been tuned on it.")
    sentences.append("The solving process was given no key and no path of the set, but it did not run in a sandbox.")
    return sentences
