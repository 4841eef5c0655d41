"""The result of a trial: every number of its page, from truths and answers alone."""

import numpy as np

from pipeline.blind_trial.metrics.criteria import EMPTY, class_of, judged, same, threshold
from pipeline.blind_trial.metrics.failure_reasons import why
from pipeline.blind_trial.metrics.rates import calibration, rate

FORMAT = "brakechain-trial-result/1"
#: held-out error over the noise floor that a completed model may have
_NEAR_NOISE = 1.2
#: edges of the bins of effect size, relative change of what sensors show
SIZES = (0.0, 0.05, 0.1, 0.2, 0.4, np.inf)
#: edges of the bins of what the change leaves beside the nominal values, standard deviations of the noise
LEFT = (0.0, 2.0, 4.0, 8.0, 16.0, 32.0, np.inf)
#: classes whose hidden effect is to be named
_NAMED = ("effect", "pair", "sensor")
#: classes in which one thing is hidden that has a name
_ALONE = ("effect", "sensor", "below")
#: what is to be reached: at least, at most, or an interval that contains it
GOALS = {
    "type and place, one effect": ("at least", 0.85), "type and place, one effect, forced": ("at least", 0.95),
    "type and place, one effect, self-excited": ("at least", 0.75), "both of a pair": ("at least", 0.6),
    "false alarms": ("at most", 0.03), "not in the catalogue: unknown": ("at least", 0.85),
    "sensor and solver called so": ("at least", 0.85), "stated with about 90 %: right": ("interval around", 0.9),
    "held out within 1.2 noise floors, named": ("at least", 0.85),
}


def result(about, truth, answers, errata=()):
    """All numbers of a scored set.

    about : what the set says of itself; truth : {case: truth}; answers : {method: {case: answer}}; errata : [{system,
    parameters: [name, ...], reason}], true values of a system that are known to be wrong, and are not compared.
    ``thresholds`` of the result: what hidden physics must leave in its cases to count as visible.
    """
    truth = {number: _without_errata(case_truth, errata) for number, case_truth in truth.items()}
    judgements = {method: {number: judged(truth[number], method_answers[number]) for number in truth}
             for method, method_answers in answers.items()}
    return {"format": FORMAT, "set": about, **({"errata": errata} if errata else {}),
            "thresholds": sorted({threshold(t) for t in truth.values() if "left" in t}),
            "methods": {method: _numbers(truth, answers[method], judgements[method]) for method in answers},
            "cases": {number: {"class": class_of(truth[number]), "truth": truth[number], "answers": {
                method: {**_brief(answers[method][number]), "judged": judgements[method][number],
                         **why(truth[number], answers[method][number], judgements[method][number])}
                for method in answers}} for number in sorted(truth)}}


def _without_errata(truth, errata):
    wrong = {name for erratum in errata if erratum["system"] == truth.get("system") for name in erratum["parameters"]}
    right = {name: value for name, value in truth.get("parameters", {}).items() if name not in wrong}
    return {**truth, "parameters": right} if wrong else truth


def _numbers(truth, answers, judgements):
    cases = [(truth[n], answers[n], judgements[n]) for n in sorted(truth)]
    return {"rates": rates(cases), "confusion": confusion(cases), "names": names(cases),
            "detection": detection(cases), "visible": visible(cases), "calibration": calibration(claims(cases)),
            "systems": systems(cases), "parameters": parameters(cases), "cost": cost(cases)}


def rates(cases):
    """{name: rate, with its goal} of [(truth, answer, judged)]."""
    def of(what, *kinds, only=lambda t, a: True):
        return rate([j[what] for t, a, j in cases if class_of(t) in kinds and only(t, a)])

    def moved(motion):
        return lambda t, a: t.get("motion", "forced") == motion

    by_name = {
        "type and place, one effect": of("right", "effect"),
        "type and place, one effect, forced": of("right", "effect", only=moved("forced")),
        "type and place, one effect, self-excited": of("right", "effect", only=moved("self_excited")),
        "type alone, one effect": of("type", "effect"),
        "truth among the tied, one effect": of("among_tied", "effect"),
        "truth among the first three, one effect": of("top", "effect"),
        "both of a pair": of("right", "pair"),
        "false alarms": of("false_alarm", *EMPTY),
        "nothing missing told so": of("right", *EMPTY),
        "not in the catalogue: unknown": of("right", "foreign"),
        "sensor and solver called so": of("called", "sensor", "solver"),
        "sensor: which and where": of("right", "sensor"),
        "below the threshold: nothing wrong named": of("right", "below"),
        "held out within 1.2 noise floors, named": rate(list(_near_noise(cases))),
        "stated with about 90 %: right": rate([right for p, right in claims(cases) if 0.85 <= p < 0.95]),
        "refused": rate([a["verdict"] == "refused" for _, a, _ in cases]),
    }
    return {name: {**row, "goal": list(GOALS.get(name, ()))} for name, row in by_name.items() if row["count"]}


def _near_noise(cases):
    """Whether each completed model predicts held-out runs down to their noise, of those that name physics."""
    for _, answer, _ in cases:
        fit = answer.get("fit", {}).get("held_out", {})
        if answer["verdict"] == "missing" and fit.get("noise_floor"):
            yield fit["after"] <= _NEAR_NOISE * fit["noise_floor"]


def confusion(cases):
    """{class: {verdict: count}}; 'missing' is split into right and wrong, as is 'sensor'."""
    counts = {}
    for truth, answer, judgement in cases:
        verdict = answer["verdict"]
        if verdict in ("missing", "sensor") and class_of(truth) in (*_NAMED, "below"):
            verdict += ", right" if judgement["right"] else ", other place" if judgement.get("type") else ", wrong"
        row = counts.setdefault(class_of(truth), {})
        row[verdict] = row.get(verdict, 0) + 1
    return counts


def names(cases):
    """{hidden: {told: count}} of cases with one thing hidden that has a name, of whatever class."""
    counts = {}
    for truth, answer, _ in cases:
        if len(truth["effects"]) == 1:
            answered = sorted({e["name"] for e in answer["effects"]})
            said = answered[0] if len(answered) == 1 else f"{answer['verdict']}" if not answered else "several"
            row = counts.setdefault(truth["effects"][0]["name"], {})
            row[said] = row.get(said, 0) + 1
    return counts


def detection(cases):
    """[{noise, low, high, right: rate}] over sizes, of what is to be named, right type and place."""
    hidden = [(t, j) for t, _, j in cases if t["class"] in _ALONE and t.get("size") and "noise" in t]
    return [{"noise": noise, **row} for noise in sorted({t["noise"] for t, _ in hidden})
            for row in _binned([(t["size"], j["named"]) for t, j in hidden if t["noise"] == noise], SIZES, 1.0)]


def visible(cases):
    """[{low, high, right: rate}] over what hidden effects leave beside the nominal values, where the truth tells it."""
    return _binned([(t["left"], j["named"]) for t, _, j in cases if t["class"] in _ALONE and "left" in t], LEFT, 64.0)


def _binned(pairs, edges, last):
    """[{low, high, right: rate}] of [(value, hit)] in bins; the last ends at ``last`` for who draws it."""
    bins = ((low, high, [hit for value, hit in pairs if low <= value < high])
            for low, high in zip(edges[:-1], edges[1:], strict=True))
    return [{"low": low, "high": min(high, last), "right": rate(members)} for low, high, members in bins if members]


def systems(cases):
    """{system: {named, false_alarm, unknown: rate; cpu: median seconds}}; rates only of what the system has."""
    table = {}
    for system in sorted({t.get("system", "") for t, _, _ in cases}):
        members = [(t, a, j) for t, a, j in cases if t.get("system", "") == system]
        row = {what: rate([j[key] for t, _, j in members if class_of(t) in kinds]) for what, key, kinds in (
            ("named", "right", ("effect",)), ("false_alarm", "false_alarm", EMPTY), ("unknown", "right", ("foreign",)))}
        table[system] = {**{what: numbers for what, numbers in row.items() if numbers["count"]},
                         "cpu": float(np.median([a.get("cpu_seconds", 0.0) for _, a, _ in members]))}
    return table


def claims(cases):
    """[(stated probability, whether it is so)] of everything that was named, alone or among tied; of a solver that is
    named whether it is wrong at all."""
    pairs = []
    for truth, answer, _ in cases:
        true = truth["effects"] if truth["class"] != "foreign" else []
        for effect in answer["effects"]:
            if "posterior" in effect:
                right = (truth["class"] == "solver" if answer["verdict"] == "numerics"
                         else any(same(hidden, effect) for hidden in true))
                pairs.append((min(max(float(effect["posterior"]), 0.0), 1.0), right))
    return pairs


def parameters(cases):
    """{nominal, lacking, effects: how near fitted values are} where the verdict is right: relative errors and coverage.

    ``nominal``: values of models that hold all that acts; ``lacking``: of those without something that is in no
    catalogue or too faint to be named, whose fitted values make up for it.
    """
    right = [(t, a, j) for t, a, j in cases if j["right"]]

    def nominal(whole):
        return _compared([pair for t, a, j in right if _whole(t, j) == whole
                          for pair in _pairs(t.get("parameters", {}), a.get("parameters", {}))])

    return {"nominal": nominal(True), "lacking": nominal(False),
            "effects": _compared([pair for t, a, _ in right for true in t["effects"] for answered in a["effects"]
                                  if same(true, answered) for pair in _pairs(true.get("parameters", {}),
                                                                         answered.get("parameters", {}))])}


def _whole(truth, judged):
    """Whether the model of a right answer holds all that acts: nothing is hidden, or it is named."""
    return class_of(truth) in (*EMPTY, "solver") or judged.get("named", False)


def _pairs(true, answered):
    """[(true value, {value, std})] of the names that both have."""
    return [(value, answered[name]) for name, value in true.items()
            if value and name in answered and answered[name]["std"] > 0]


def _compared(pairs):
    """{count, median_error, within_68, within_95, distances} of [(true value, {value, std})]; distances over std."""
    if not pairs:
        return {"count": 0}
    errors = [abs(answered["value"] / value - 1) for value, answered in pairs]
    distances = [(answered["value"] - value) / answered["std"] for value, answered in pairs]
    return {"count": len(pairs), "median_error": float(np.median(errors)),
            "within_68": rate([abs(d) <= 1.0 for d in distances]),
            "within_95": rate([abs(d) <= 1.96 for d in distances]),
            "distances": [round(float(d), 3) for d in np.clip(distances, -8, 8)]}


def cost(cases):
    """CPU seconds of a case by system: count, median, largest; and the sum of all."""
    spent = {}
    for truth, answer, _ in cases:
        spent.setdefault(truth.get("system", ""), []).append(answer.get("cpu_seconds", 0.0))
    return {"total": float(sum(map(sum, spent.values()))),
            "systems": {name: {"count": len(s), "median": float(np.median(s)), "largest": float(max(s))}
                        for name, s in sorted(spent.items())}}


def _brief(answer):
    """What a result keeps of an answer."""
    kept = ("verdict", "effects", "alternatives", "fit", "unexplained_share", "cpu_seconds")
    return {key: answer[key] for key in kept if key in answer}
