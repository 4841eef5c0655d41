"""Chapters of the page of a trial."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import trial as pictures
from pipeline.views.figures.number_format import number, percent, plural

#: column of what was named as what it is
_SELF = "the same"
#: why a case may be wrong, and how its page is headed
_CLASSES = {"effect": "one effect", "pair": "two effects", "control": "nothing missing", "wrong_value": "a wrong value",
            "sensor": "a sensor", "solver": "the solver", "foreign": "not in the catalogue",
            "below": "below the threshold"}
#: which fitted values are compared with the truth, in words
_VALUES = {"nominal": "nominal values", "lacking": "nominal values of models that lack something",
           "effects": "values of named effects"}


def all_of(result):
    """Chapters of a result, in reading order."""
    main = result["methods"]["diagnosis"]
    found = (_rates(result), _confusion(main), _detection(main, result["thresholds"]), _systems(main),
             _calibration(main), _held_out(result), _parameters(main, result.get("errata", ())), _cost(result),
             _failures(result))
    return [chapter for chapter in found if chapter]


def reached(one):
    """Whether a rate reaches its goal: [at least | at most | interval around, value]."""
    sense, goal = one["goal"]
    share = one["hits"] / one["count"]
    return {"at least": share >= goal, "at most": share <= goal, "interval around": one["low"] <= goal <= one["high"]
            }[sense]


def in_words(one):
    """'12 of 13, 92 % (95 %: 67 % to 99 %); goal: at least 85 %.'"""
    goal = f"; goal: {one['goal'][0]} {percent(one['goal'][1], 2)}" if one["goal"] else ""
    return (f"{one['hits']} of {one['count']}, {percent(one['hits'] / one['count'], 2)} (95 %: {percent(one['low'], 2)}"
            f" to {percent(one['high'], 2)}){goal}.")


def _cell(one):
    if one is None:
        return "—"
    return (f"{one['hits']} of {one['count']} = {percent(one['hits'] / one['count'], 3)}"
            f" ({percent(one['low'], 2)} to {percent(one['high'], 2)})")


def _rates(result):
    methods = result["methods"]
    main = methods["diagnosis"]["rates"]
    head = ("rate", *(m.replace("_", " ") for m in methods), "goal", "rate lies")
    rows = tuple((name, *(_cell(numbers["rates"].get(name)) for numbers in methods.values()),
                  f"{one['goal'][0]} {percent(one['goal'][1], 3)}" if one["goal"] else "",
                  ("within" if reached(one) else "outside") if one["goal"] else "") for name, one in main.items())
    others = plural(len(methods) - 1, "baseline")
    return Chapter("rates", "Rates", f"Every rate with its 95 % interval (Wilson), beside {others} on the same files.",
                   _beaten(methods), (), (Table(head, rows, "Rates", tuple(range(1, len(methods) + 1))),))


def _beaten(methods):
    """How baselines do on what the diagnosis is for."""
    name = "type and place, one effect"
    main = methods["diagnosis"]["rates"].get(name)
    others = {m: n["rates"].get(name) for m, n in methods.items() if m != "diagnosis" and n["rates"].get(name)}
    if not main or not others:
        return "No baseline was run on this set."
    better = [m.replace("_", " ") for m, one in others.items() if one["hits"] >= main["hits"]]
    best = max(others, key=lambda m: others[m]["hits"])
    told = f"The best baseline at naming one effect at its place is {best.replace('_', ' ')}: {in_words(others[best])}"
    return f"{told} {'As good or better than the diagnosis: ' + ', '.join(better) + '.' if better else ''}".strip()


def _confusion(main):
    named = main["names"]
    figures = [Figure(pictures.table(main["confusion"], "in truth", "told"),
                      "Cases of each class by what was told of them; colour: share of the class.")]
    if named:
        told = {hidden: {_SELF if name == hidden else name: count for name, count in row.items()}
                for hidden, row in sorted(named.items())}
        figures.append(Figure(pictures.table(told, "hidden", "named"),
                              "What was named where one thing was hidden, at whatever place: the same, or another law;"
                              " verdicts where nothing was named."))
    rows = tuple((_CLASSES[kind], verdict, str(count)) for kind, row in main["confusion"].items()
                 for verdict, count in sorted(row.items(), key=lambda r: -r[1]))
    return Chapter("confusion", "What was taken for what", "Rows are what was hidden, columns what was told.",
                   f"Beside '{_SELF}' stands what the diagnosis confuses or does not name.", tuple(figures),
                   (Table(("in truth", "told", "cases"), rows, "All verdicts", (2,), folded=True),))


def _detection(main, thresholds):
    points = main["detection"]
    if not points:
        return None
    rows = tuple((percent(p["noise"], 2), f"{percent(p['low'], 2)} to {percent(p['high'], 2)}", _cell(p["right"]))
                 for p in points)
    figures = (Figure(pictures.detection(points), "Named at its place, over size and noise, with 95 % intervals."),
               *_visible(main["visible"], thresholds))
    return Chapter("detection", "What size of an effect is found", "Share of hidden effects, sensors included, that"
                   " were named at their place, over the change that they make in what sensors show.",
                   "A small effect in much noise is not named; to abstain there is right.", figures,
                   (Table(("noise", "size", "named at its place"), rows, "Detection", (2,)),))


def _visible(points, thresholds):
    if points:
        yield Figure(pictures.visible(points, thresholds), "Named at its place, over what the change leaves once the"
                     f" nominal values are fitted to it; below {' or '.join(f'{t:g}' for t in thresholds)} standard"
                     " deviations (line) it counts as too faint, and abstaining is right.")


def _systems(main):
    rows = tuple((name.replace("_", " "), _cell(one.get("named")), _cell(one.get("false_alarm")),
                  _cell(one.get("unknown")), number(one["cpu"], 3)) for name, one in main["systems"].items())
    head = ("system", "one effect named at its place", "false alarms", "not in the catalogue: unknown",
            "CPU seconds a case")
    alarms = main["rates"].get("false alarms")
    told = f"False alarms: {in_words(alarms)}" if alarms else "The set has no controls."
    return Chapter("systems", "By system, and false alarms", "The same rates for every system of the set.", told,
                   (), (Table(head, rows, "By system", (1, 2, 3, 4)),))


def _calibration(main):
    found = main["calibration"]
    if not found["count"]:
        return None
    rows = tuple((f"{percent(b['low'], 3)} to {percent(b['high'], 3)}", percent(b["stated"], 3), _cell(b["so"]))
                 for b in found["bins"])
    return Chapter("calibration", "Do stated probabilities hold?",
                   f"{plural(found['count'], 'statement')} of the kind 'this effect, at this place, with this"
                   " probability', alone or among tied ones.",
                   f"Brier score {number(found['brier'], 3)} (0: always sure and right; 0.25: a coin).",
                   (Figure(pictures.reliability(found["bins"]), "Share that is so over the stated probability, with"
                           " 95 % intervals."),), (Table(("stated", "mean", "so"), rows, "Reliability", (1, 2)),))


def _held_out(result):
    rows = []
    for one in result["cases"].values():
        told = one["answers"]["diagnosis"]
        fit = told.get("fit", {}).get("held_out", {})
        if told["verdict"] == "missing" and fit.get("noise_floor"):
            rows.append((fit["recalibrated"] / fit["noise_floor"], fit["after"] / fit["noise_floor"],
                         told["judged"]["right"]))
    if not rows:
        return None
    found = result["methods"]["diagnosis"]["rates"]["held out within 1.2 noise floors, named"]
    return Chapter("held_out", "Does the completed model predict?", "Error on runs that were never fitted, over what"
                   " noise alone would leave: before and after the named effect is added.",
                   f"Within 1.2 noise floors: {in_words(found)}",
                   (Figure(pictures.held_out(rows), "Below the line the completed model predicts better than the"
                           " recalibrated nominal one; dashed: 1.2 noise floors."),))


def _parameters(main, errata):
    told = main["parameters"]
    kinds = [(name, told[key]) for key, name in _VALUES.items() if told.get(key, {}).get("count")]
    if not kinds:
        return None
    rows = tuple((name, str(found["count"]), percent(found["median_error"], 2), _cell(found["within_68"]),
                  _cell(found["within_95"])) for name, found in kinds)
    head = ("values", "count", "median error", "within 1 standard deviation", "within 1.96")
    apart = "".join(f" Not compared are {', '.join(one['parameters'])} of {one['system'].replace('_', ' ')}:"
                    f" {one['reason']}." for one in errata)
    return Chapter("parameters", "Are fitted values right?", "Fitted values of the cases that were told right, beside"
                   f" the truth where the set tells it.{apart}", "Of calibrated errors 68 % lie within one stated"
                   " standard deviation and 95 % within 1.96. Where something is too faint to be named, or in no"
                   " catalogue, values make up for what the model lacks.", tuple(
                       Figure(pictures.distances(found["distances"]), f"Distance of {name} from the truth in stated"
                              " standard deviations (cut at 8).") for name, found in kinds),
                   (Table(head, rows, "Fitted values", (1, 2, 3, 4)),))


def _cost(result):
    rows = tuple((method.replace("_", " "), name.replace("_", " "), str(one["count"]), number(one["median"], 3),
                  number(one["largest"], 3)) for method, numbers in result["methods"].items()
                 for name, one in numbers["cost"]["systems"].items())
    totals = "; ".join(f"{m.replace('_', ' ')} {number(n['cost']['total'] / 60, 3)} CPU minutes"
                       for m, n in result["methods"].items())
    return Chapter("cost", "Cost", "CPU seconds of a case, start of the program included.", f"In all: {totals}.", (),
                   (Table(("method", "system", "cases", "median", "largest"), rows, "CPU seconds", (2, 3, 4)),))


def _failures(result):
    wrong = {n: one for n, one in result["cases"].items() if "why" in one["answers"]["diagnosis"]}
    rows = tuple((number_, _CLASSES[one["class"]], _hidden(one["truth"]),
                  _told(one["answers"]["diagnosis"]), one["answers"]["diagnosis"]["why"][0])
                 for number_, one in wrong.items())
    if not rows:
        return Chapter("failures", "Failures", "No case of this set was told wrong.", "There is nothing to show.")
    head = ("case", "class", "in truth", "told", "what went wrong")
    return Chapter("failures", "Failures", f"{plural(len(wrong), 'case')} not told right; each has its page below.",
                   "brakechain run cases/NNN/nominal.yaml gives the whole report of one.", (),
                   (Table(head, rows, "Cases not told right", (), (4,)),
                    *(_case_page(n, one) for n, one in wrong.items())))


def _case_page(number_, one):
    truth, told = one["truth"], one["answers"]["diagnosis"]
    rows = [("system", truth.get("system", "").replace("_", " ")), ("in truth", _hidden(truth)),
            ("size, noise", f"{percent(truth.get('size', 0), 2)}, {percent(truth.get('noise', 0), 2)}"),
            *((("left beside the nominal values", f"{number(truth['left'], 2)} standard deviations"),)
              if "left" in truth else ()), ("told", _told(told)), *(("why", sentence) for sentence in told["why"])]
    for part, fit in told.get("fit", {}).items():
        if fit.get("noise_floor"):
            rows.append((f"error, {part.replace('_', ' ')}", f"nominal {percent(fit['before'], 3)}, recalibrated"
                         f" {percent(fit['recalibrated'], 3)}, completed {percent(fit['after'], 3)}, noise"
                         f" {percent(fit['noise_floor'], 3)}"))
    rows += [("also weighed", f"{_at(e)} ({percent(e['posterior'], 3)})") for e in told.get("alternatives", ())[:3]
             if "posterior" in e]
    rows += [(method.replace("_", " "), _told(answer)) for method, answer in one["answers"].items()
             if method != "diagnosis"]
    return Table(("", ""), tuple(rows), f"Case {number_}: {_hidden(truth)}; told {_told(told)}", (), (1,), folded=True)


def _hidden(truth):
    return " and ".join(map(_at, truth["effects"])) or _CLASSES[truth["class"]]


def _told(answer):
    named = (" or " if answer["verdict"] == "tie" else " and ").join(map(_at, answer["effects"]))
    return f"{answer['verdict']}: {named}" if named else answer["verdict"]


def _at(effect):
    name = effect["name"].replace("_", " ")
    return f"{name} at {effect['place']}" if effect["place"] else name


def not_proven(result):
    """What a reader must not take from the trial, in sentences."""
    told = ["No recording of a real squealing brake was available to it: none with an open licence was found.",
            "Truths come from programs of the makers of the set, apart from the diagnosis but thought of by people who"
            " know it; physics that nobody thought of is not among them.",
            "Nominal models have the right parts: what is missing is one or two terms, and values that are off. A model"
            " that is wrong throughout was not tried.",
            "Rates hold for the sizes, noises, systems and sensors that were drawn."]
    alarms = result["methods"]["diagnosis"]["rates"].get("false alarms")
    if alarms:
        told.append(f"With {plural(alarms['hits'], 'false alarm')} in {plural(alarms['count'], 'control')} the rate may"
                    f" still be as high as {percent(alarms['high'], 2)}.")
    if result["set"]["kind"] != "sealed":
        told.append("The set is open: methods may have been tuned on it.")
    told.append("The solver's process saw no key and no path of the set; it was not locked into a sandbox.")
    return told
