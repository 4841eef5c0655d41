"""Chapter: what recordings say is missing, as a colleague would write it down."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.squeal_check import squeal_tables
from pipeline.views.figures.bench import diagnosis as pictures
from pipeline.views.figures.bench import latent_force
from pipeline.views.figures.number_format import number, percent, quantity, scale

#: axes of the location that are bins of what moves, and all in the order of reading
REGIMES = ("amplitude", "velocity", "time")
AXES = ("stage", "substitution", "place", "run", "band", *REGIMES)
#: rows of the table of hypotheses that are shown unfolded
ROWS = 12
#: what a tie of one says: a single run, or a list alone, names nothing
_PROPOSED = "Proposed, not confirmed"


def headline(product):
    """(sentence, tone) of the first screen."""
    named = _named(product)
    said = {"missing": (f"{_first_up(named)} {'is' if ' and ' not in named else 'are'} missing ({_sure(product)})",
                        "warning"),
            "tie": (f"{'Missing, but not told apart' if len(product.named) > 1 else _PROPOSED}: {named}", "warning"),
            "sensor": (f"{_measured(product)}: {named} ({_sure(product)})", "warning"),
            "numerics": (f"The solver, not the physics: {named}", "warning"),
            "parameters": ("Values are off, no physics is missing", "warning"),
            "consistent": ("Nothing is missing: the model explains the recordings", "quiet"),
            "unknown": (f"Something is missing{_at(product)} that the catalogue does not hold", "squeal")}
    return said[product.verdict.item()]


def note(product):
    """(question, answer) pairs that the first screen shows."""
    return (("What differs", _differs(product)), ("Where", _where(product)), ("What is missing", _missing(product)),
            ("How sure", _how_sure(product)), ("What it changes", _changes(product)),
            ("Measure next", _next(product)))


def chapter(product, look):
    """Chapter of the product Diagnosis."""
    told = dict(note(product))
    return Chapter(
        "diagnosis", "What the recordings say is missing", f"{told['What differs']} {told['Where']}",
        " ".join(filter(None, (told["What is missing"], told["What it changes"], told["Measure next"]))),
        tuple(_figures(product)), tuple(filter(None, (
            _errors(product), _with_force(product), *squeal_tables(product), _parameters(product),
            _hypotheses(product), _location(product)))),
        tuple(_notes(product)))


def key_figure(product):
    """The mismatch map, for the first screen."""
    parts = "octave" if all(map(pictures.sampled, product.runs.values())) else "channel"
    return Figure(pictures.mismatch_map(product),
                  f"Mismatch map: what is left of each run in each {parts}, over its noise taken as white; 1 (dark)"
                  " is noise alone.")


def _named(product):
    """What is known, and what is named beside it: one, or several of which one."""
    parts = [_effect(product, k) for k in product.known]
    parts += [" or ".join(_effect(product, k) for k in product.named)] * bool(len(product.named))
    return (", and " if len(product.named) > 1 else " and ").join(parts)


def _measured(product):
    """Whether it is the measurement alone."""
    physics = any(str(product.kind[k]) == "physics" for k in product.known)
    return "The measurement, and physics too" if physics else "The measurement, not the physics"


def _effect(product, k):
    return f"{str(product.effect[k]).replace('_', ' ')} at {product.place[k]}" if product.effect[k] else "nothing"


def _first_up(text):
    return text[:1].upper() + text[1:]


def _sure(product):
    return percent(min(sum(product.posterior[k] for k in product.named), 0.999), 3)


def _at(product):
    return f" at {product.latent_place.item()}" if product.latent_place.item() else ""


def _differs(product):
    runs = list(product.runs.values())
    part = 1 if any(r.held_out for r in runs) else 0
    before, recalibrated, after, noise = product.fit[part]
    where = "On runs that were never fitted the" if part else "The"
    return (f"{where} nominal model misses the recordings by {percent(before, 2)} of their standard deviation; with the"
            f" best values of its own parameters by {percent(recalibrated, 2)}; noise alone would leave"
            f" {percent(noise, 2)}.")


def _where(product):
    parts = []
    for axis, say in (("stage", "stage {}"), ("substitution", "stage {}, by what was measured in its place"),
                      ("place", "at {}"), ("run", "most in run {}"), ("band", "in {}"),
                      ("amplitude", "amplitudes {}"), ("velocity", "velocities {}"), ("time", "times {}")):
        found = product.location.get(axis)
        if found is not None and (found.p_value[found.member > 0] <= 0.05).any():
            parts.append(say.format(_items(found)))
    if not parts:
        return "No stage, place, run or band stands out of the noise."
    return f"It lies in {'; '.join(parts)} (95 % sets, each significant over its whole axis)."


def _items(axis):
    """Members of a set in words; neighbouring bins as one range."""
    rows = np.flatnonzero(axis.member)
    if axis.unit.item():
        return quantity([axis.low[rows].min(), axis.high[rows].max()], axis.unit.item(), 3).replace(", ", " to ")
    return " or ".join(str(axis.item[k]) for k in rows)


def _missing(product):
    verdict = product.verdict.item()
    if verdict in ("missing", "sensor", "numerics"):
        values = "; ".join(_value(product, k) for k in range(len(product.parameter)) if product.parameter_owner[k])
        told = values if len(product.named) < 2 else ""      # else they are those of the first alone
        return f"{_first_up(_named(product))}{': ' + told if told else ''}."
    if verdict == "tie":
        several = len(product.named) > 1
        return f"{'One of these, which the recordings do not tell apart' if several else _PROPOSED}: {_named(product)}."
    if verdict == "unknown":
        return product.latent_sentence.item() or "Something that the catalogue does not hold; no force stands for it."
    if verdict == "parameters":
        every = range(len(product.parameter))
        moved = [k for k in every if _distance(product, k) > 2] or [max(every, key=lambda k: _distance(product, k))]
        return f"No physics; these values are others: {'; '.join(_value(product, k, given=True) for k in moved)}."
    return "Nothing that these recordings can show."


def _value(product, k, given=False):
    name = str(product.parameter[k]).partition("@")
    short = name[2].rpartition(".")[2].replace("_", " ") if name[1] else name[0]
    unit = str(product.parameter_unit[k])
    text = f"{short} {_with_error(product.parameter_value[k], product.parameter_std[k], unit)}"
    return f"{text} (given {quantity(product.parameter_nominal[k], unit, 3)})" if given else text


def _with_error(value, std, unit):
    """'20.4 ± 0.3 N': digits as the error carries."""
    name, size = scale(max(abs(value), std), unit)
    digits = int(np.clip(np.floor(np.log10(abs(value) / std)) + 2, 2, 6)) if std > 0 and value else 4
    told = f"{number(value / size, digits)} ± {number(std / size, 2)}"
    return told if name == "1" else f"{told}\u202f{name}"


def _distance(product, k):
    std = product.parameter_std[k]
    return abs(product.parameter_value[k] - product.parameter_nominal[k]) / std if std > 0 else 0.0


def _how_sure(product):
    if product.verdict.item() not in ("missing", "sensor", "numerics"):
        return " ".join(_sentence(r) for r in product.reason)
    first = product.named[0]
    held_out = any(run.held_out for run in product.runs.values())
    agreed = not any("across them was not tested" in str(reason) for reason in product.reason)
    rules = ("posterior", "false alarms", *["held-out gain"] * held_out, *["agreement over runs"] * agreed, "bounds")
    return (f"Probability {_sure(product)} among {len(product.hypothesis) - 1} hypotheses. Nothing missing would score"
            f" as high anywhere in the catalogue with probability {number(product.p_value[first], 2)}. It was named by"
            f" the rules of the case: {', '.join(rules)}.")


def _sentence(text):
    text = _first_up(str(text).strip())
    return text if text.endswith(".") else f"{text}."


def _changes(product):
    held_out = any(r.held_out for r in product.runs.values())
    before, recalibrated, after, noise = product.fit[1 if held_out else 0]
    where = "the held-out runs" if held_out else "the fitted runs"
    if product.verdict.item() == "parameters":
        return f"With the fitted values the model predicts {where} within {percent(recalibrated, 2)}" \
               f" (as given {percent(before, 2)}, noise {percent(noise, 2)})."
    if not len(product.named):
        return ""
    return (f"The completed model predicts {where} within {percent(after, 2)} (recalibrated without it"
            f" {percent(recalibrated, 2)}, noise {percent(noise, 2)}); {percent(product.unexplained_share, 2)} of the"
            " excess error stays unexplained.")


def _next(product):
    if not len(product.next_condition):
        return ""
    apart = " from ".join(_words(s) for s in product.next_separates)
    return (f"{', '.join(str(c) for c in product.next_condition)}: it is expected to tell {apart} apart by"
            f" {number(product.next_value, 2)} nats.")


def _words(text):
    return str(text).replace("_", " ")


def _notes(product):
    if not any(r.held_out for r in product.runs.values()):
        yield "No run was held out: nothing here is verified on a recording that was not fitted."
    if product.latent_sentence.item() and product.verdict.item() == "unknown":
        yield "The latent force is a description of this recording, not identified physics;" + (
            " the held-out runs were predicted with it because this was asked." if product.latent_predicted else
            " no prediction uses it.")
    if product.latent_use.item():
        yield product.latent_use.item()


def _figures(product):
    yield key_figure(product)
    if len(product.hypothesis) > 1:
        yield Figure(pictures.hypotheses(product), "Probabilities of the leading hypotheses; blue: named.")
        yield Figure(pictures.stage_place(product), "Probability by stage of the chain and place, all hypotheses"
                     " there together; empty: the catalogue has nothing there.")
    name, held_out = _shown_run(product)
    if pictures.sampled(product.runs[name]):
        yield from _signals(product, name, held_out)
    elif str(product.channel[0]) == "friction":
        yield Figure(pictures.points(product), "Friction of every run, point by point in the order of sliding: measured"
                     " (with its noise and the error of the model), with the best values of the nominal model, and"
                     " completed.")
    if len(product.parameter):
        yield Figure(pictures.parameters(product), "What the recordings say of the fitted values (orange: nominal"
                     " values, blue: of what was added); dashed: the value given, 0 for what was added.")
    axes = [a for a in REGIMES if a in product.location]
    if axes:
        yield Figure(pictures.regimes(product, axes), "Where the missing force is larger than on average, in standard"
                     " deviations of circular shifts; blue: significant.")
    if product.latent:
        first = name if name in product.latent else next(iter(product.latent))
        yield Figure(latent_force.latent_force(product, first),
                     f"The missing force of run {first}, beside the recalibrated nominal model and without any"
                     " hypothesis; red: mean over bins of all fitted runs. Description, not identified physics.")
    yield from _predicted_with_force(product)


def _predicted_with_force(product):
    """The first held-out run with the latent force."""
    for name in list(product.latent_predicted)[:1]:
        yield Figure(latent_force.with_latent_force(product, name),
                     f"Run {name}, never fitted: measured, with the best values of the nominal model, and with the"
                     " latent force as a function of what it follows. Description, not identified physics.")


def _signals(product, name, held_out, channel=0):
    """Excerpt and spectrum of one channel of a run."""
    yield Figure(pictures.trace(product, name, channel),
                 f"Run {name}{', never fitted' if held_out else ''}: measured, nominal, recalibrated and completed"
                 f" about the largest {product.channel[channel]}; below, what each leaves.")
    yield Figure(pictures.spectra(product, name, channel),
                 f"What the models leave of {product.channel[channel]} in run {name}, as a spectrum, with the noise"
                 " taken as white.")


def _shown_run(product):
    """(name, held out) of the run that is drawn: the first held out, else the worst fitted."""
    for name, run in product.runs.items():
        if run.held_out:
            return name, True
    return max(product.runs, key=lambda n: product.runs[n].error[1]), False


def _errors(product):
    rows = [(name, "held out" if run.held_out else "fitted", *(percent(e, 3) for e in run.error))
            for name, run in product.runs.items()]
    for row, title in enumerate(("all fitted", "all held out")):
        if product.fit[row].any():
            rows.append((title, "", *(percent(e, 3) for e in product.fit[row])))
    head = ("run", "", "nominal", "recalibrated", "completed", "noise alone")
    return Table(head, tuple(rows), "Error over standard deviation", numeric=(2, 3, 4, 5))


def _with_force(product):
    """Errors of the held-out runs with the latent force, beside those without."""
    if not product.latent_predicted:
        return None
    rows = tuple((name, percent(product.runs[name].error[1], 3), percent(float(one.error), 3),
                  percent(product.runs[name].error[3], 3)) for name, one in product.latent_predicted.items())
    return Table(("held-out run", "recalibrated", "with the latent force", "noise alone"), rows,
                 "Held out, with the latent force: description, not identified physics", numeric=(1, 2, 3))


def _parameters(product):
    if not len(product.parameter):
        return None
    rows = tuple((_words(str(name).replace("@", " at ")), quantity(product.parameter_nominal[k], unit, 4),
                  _with_error(product.parameter_value[k], product.parameter_std[k], unit),
                  number(_distance(product, k), 2)) for k, (name, unit) in enumerate(
                      zip(product.parameter, map(str, product.parameter_unit), strict=True)))
    return Table(("value", "given", "fitted", "apart, standard deviations"), rows, "Fitted values", (1, 2, 3))


def _hypotheses(product):
    order = np.argsort(-product.posterior, kind="stable")
    rows = tuple((_words(product.hypothesis[k]), str(product.kind[k]), percent(product.posterior[k], 3),
                  number(product.score[k], 3), number(product.p_value[k], 2), number(product.power[k], 3),
                  number(product.evidence_gain[k], 3) if product.refitted[k] else "—", _words(product.objection[k]))
                 for k in order)
    head = ("hypothesis", "kind", "probability", "score", "p over all", "could be seen", "ln evidence", "objection")
    return Table(head, rows, "Everything that was weighed", (2, 3, 4, 5, 6), (7,), folded=len(rows) > ROWS)


def _location(product):
    rows = []
    for name in AXES:
        axis = product.location.get(name)
        for k in range(0 if axis is None else len(axis.item)):
            rows.append((name, str(axis.item[k]), number(axis.score[k], 3), number(axis.p_value[k], 2),
                         "yes" if axis.member[k] else ""))
    head = ("axis", "item", "score", "p over the axis", "95 % set")
    return Table(head, tuple(rows), "Where it lies", (2, 3), folded=True) if rows else None
