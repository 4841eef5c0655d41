"""Chapter: what the recordings say is missing from the model, as a colleague would report it."""

import numpy as np

from pipeline.views.chapters.bench.hypotheses import (
    all_refused,
    combination_table,
    first_up,
    hypothesis_table,
    led_by,
    listed,
    named_effects,
    of_no_law,
    refusal_table,
    sentence,
    unnamed,
    words,
)
from pipeline.views.chapters.bench.model_errors import changes, differs, error_table, held_out_stops, stop_table
from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.squeal_check import squeal_note, squeal_tables
from pipeline.views.figures.bench import diagnosis as pictures
from pipeline.views.figures.bench import latent_force
from pipeline.views.figures.number_format import number, percent, quantity, scale

#: location axes that are bins of the motion, and all axes in reading order
REGIMES = ("amplitude", "velocity", "time")
AXES = ("stage", "substitution", "place", "run", "band", *REGIMES)
#: verdict of a tie with one member: a single run, or a list alone, cannot confirm an effect
_PROPOSED = "Proposed, not confirmed"
#: values that are listed on the first screen; the table holds all
_VALUES = 8


def headline(product):
    """(sentence, tone) of the first screen."""
    named = named_effects(product)
    verb = "is" if " and " not in named else "are"
    tie = "Missing effect identified up to ambiguity" if len(product.named) > 1 else _PROPOSED
    sentences = {
        "missing": (f"{first_up(named)} {verb} missing{_in_part(product)} ({_sure(product)})", "warning"),
        "tie": (f"{tie}: {named}{_in_part(product)}", "warning"),
        "sensor": (f"{_measured(product)}: {named} ({_sure(product)})", "warning"),
        "numerics": (f"The solver, not the physics: {named}", "warning"),
        "parameters": ("Parameter values are off; no physics is missing", "warning"),
        "consistent": ("Nothing is missing: the model explains the recordings", "quiet"),
        "unknown": (unnamed(product, _at(product)), "squeal")}
    return sentences[product.verdict.item()]


def note(product):
    """(question, answer) pairs that the first screen shows."""
    return (("What differs", differs(product)), ("Where", _where(product)), ("What is missing", _missing(product)),
            ("How certain", _how_certain(product)), ("What it changes", changes(product)),
            ("Held-out squeal", held_out_stops(product)), ("What is left", _left(product)),
            ("Measure next", _next(product)))


def chapter(product, look):
    """Chapter of the product Diagnosis."""
    answers = dict(note(product))
    return Chapter(
        "diagnosis", "What the recordings say is missing", f"{answers['What differs']} {answers['Where']}",
        " ".join(filter(None, (answers["What is missing"], answers["What it changes"], answers["Held-out squeal"],
                               answers["What is left"], answers["Measure next"]))),
        tuple(_figures(product)), tuple(filter(None, (
            error_table(product), stop_table(product), _with_force(product), *squeal_tables(product),
            _parameters(product), _starts(product), hypothesis_table(product),
            refusal_table(product), combination_table(product), _location(product), _thresholds(product)))),
        tuple(_notes(product)))


def key_figures(product):
    """The mismatch map, and above it what the models make of a held-out run, for the first screen."""
    name, held_out = _shown_run(product)
    overlay = [_overlay(product, name, held_out)] if pictures.sampled(product.runs[name]) else []
    return *overlay, _map(product)


def _map(product):
    parts = "octave" if all(map(pictures.sampled, product.runs.values())) else "channel"
    return Figure(pictures.mismatch_map(product),
                  f"Mismatch map: residual of each run in each {parts} over its noise, assumed white; 1 (dark) is noise"
                  " alone.")


def _measured(product):
    """Whether the fault lies in the measurement alone."""
    physics = any(str(product.kind[k]) == "physics" for k in product.known)
    return "The measurement, and physics too" if physics else "The measurement, not the physics"


def _levels(product):
    """'unknown at half, missing (coulomb at guide) at 2 times the noise' where the level of noise decides."""
    verdicts = [(float(level), str(v), str(named)) for level, v, named in zip(
        product.noise_level, product.noise_verdict, product.noise_named, strict=True)]
    other = [(level, v, named) for level, v, named in verdicts if v != product.verdict.item()]
    error = "the error of the model" if product.model_error > 1 else ""
    if not verdicts:
        return ""
    if not other:
        same = listed([number(level, 2) for level, _, _ in verdicts])
        return f"The verdict is the same at {same} times {error or 'the noise'}."
    parts = [f"{v}{f' ({words(named)})' if named else ''} at {number(level, 2)} times" for level, v, named in other]
    return f"The verdict hangs on the level of noise: it would be {listed(parts)} {error or 'what is known of it'}."


def _in_part(product):
    """', in part: ...' of what is named and leaves more than noise."""
    if not product.in_part.item():
        return ""
    return f", in part: {percent(product.unexplained_share.item(), 2)} of the excess error stays"


def _left(product):
    """What is above the noise once all that is sure has been named."""
    if not len(product.named) or not product.left_sentence.item():
        return ""
    following = product.left_candidate.item()
    part = (f"The law holds in part: no model of one effect reaches the noise, and it is told from the others beside"
            f" an error of {number(product.model_error.item(), 2)} noise floors, which the best of them leave. "
            if product.model_error.item() > 1 else "")
    return (f"{part}{number(product.left_floors.item(), 3)} noise floors remain."
            f" {sentence(product.left_sentence.item())}"
            f"{f' Next candidate: {sentence(words(following))}' if following else ''}")


def _sure(product):
    return percent(min(sum(product.posterior[k] for k in product.named), 0.999), 3)


def _at(product):
    return f" at {product.latent_place.item()}" if product.latent_place.item() else ""


def _where(product):
    parts = []
    for axis, phrase in (("stage", "in stage {}"), ("substitution", "in stage {} (by substituting measurements)"),
                      ("place", "at {}"), ("run", "mainly in run {}"), ("band", "in {}"),
                      ("amplitude", "at amplitudes {}"), ("velocity", "at velocities {}"), ("time", "at times {}")):
        located = product.location.get(axis)
        if located is not None and (located.p_value[located.member > 0] <= 0.05).any():
            parts.append(phrase.format(_items(located)))
    if not parts:
        return "No stage, location, run or band is significant above the noise."
    return f"The mismatch lies {', '.join(parts)} (95 % confidence sets, each significant family-wise)."


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
        values_of_one = values if len(product.named) < 2 else ""      # otherwise they belong to the first alone
        return f"{first_up(named_effects(product))}{': ' + values_of_one if values_of_one else ''}."
    if verdict == "tie":
        alternatives = "One of these, which the recordings cannot distinguish"
        return f"{alternatives if len(product.named) > 1 else _PROPOSED}: {named_effects(product)}."
    if verdict == "unknown":
        force = product.latent_sentence.item() or "No latent force could be estimated."
        return f"{led_by(product)} {force}"
    if verdict == "parameters":
        every = range(len(product.parameter))
        moved = [k for k in every if _distance(product, k) > 2] or [max(every, key=lambda k: _distance(product, k))]
        return f"No physics; these values differ: {_most_changed(product, moved)}."
    return "Nothing that these recordings can reveal."


def _most_changed(product, moved):
    """Values ``moved`` (indices), those that changed most where they are many, and how far the others changed."""
    def change(k):
        given = product.parameter_nominal[k]
        return abs(product.parameter_value[k] / given - 1) if given else np.inf

    first = moved if len(moved) <= _VALUES else sorted(moved, key=change, reverse=True)[:_VALUES]
    told = "; ".join(_value(product, k, given=True) for k in first)
    rest = [change(k) for k in moved if k not in first]
    return f"{told}; {len(rest)} others by up to {percent(max(rest), 2)}" if rest else told


def _value(product, k, given=False):
    name = str(product.parameter[k]).partition("@")
    short = name[2].rpartition(".")[2].replace("_", " ") if name[1] else name[0]
    unit = str(product.parameter_unit[k])
    short = f"factor on {short}" if product.parameter_factor[k] else short
    text = f"{short} {_with_error(product.parameter_value[k], product.parameter_std[k], unit)}"
    return f"{text} (given {quantity(product.parameter_nominal[k], unit, 3)})" if given else text


def _with_error(value, std, unit):
    """'20.4 ± 0.3 N': as many digits as the error justifies."""
    name, size = scale(max(abs(value), std), unit)
    digits = int(np.clip(np.floor(np.log10(abs(value) / std)) + 2, 2, 6)) if std > 0 and value else 4
    text = f"{number(value / size, digits)} ± {number(std / size, 2)}"
    return text if name == "1" else f"{text}\u202f{name}"


def _distance(product, k):
    std = product.parameter_std[k]
    return abs(product.parameter_value[k] - product.parameter_nominal[k]) / std if std > 0 else 0.0


def _how_certain(product):
    if product.verdict.item() not in ("missing", "sensor", "numerics"):
        return " ".join(filter(None, (*map(sentence, of_no_law(product)), all_refused(product), _levels(product))))
    first = product.named[0]
    held_out = any(run.held_out for run in product.runs.values())
    agreed = not any("across them was not tested" in str(reason) for reason in product.reason)
    rules = ("posterior", "false alarms", *["held-out gain"] * held_out, *["agreement over runs"] * agreed, "bounds")
    return (f"Probability {_sure(product)} among {len(product.hypothesis) - 1} hypotheses. Family-wise p-value"
            f" {number(product.p_value[first], 2)}: the chance that some effect of the catalogue scores as high"
            f" although nothing is missing. Decision rules met: {', '.join(rules)}. {_levels(product)}").strip()


def _next(product):
    if not len(product.next_condition):
        return ""
    pair = " from ".join(words(s) for s in product.next_separates)
    return (f"{', '.join(str(c) for c in product.next_condition)}; expected to distinguish {pair} by"
            f" {number(product.next_value, 2)} nats.")


def _notes(product):
    if product.verdict.item() in ("missing", "sensor", "numerics"):     # of others all reasons are told
        yield from (sentence(reason) for reason in product.reason if "could not be" in str(reason))
    if not any(r.held_out for r in product.runs.values()):
        yield "No run was held out: nothing here is verified on unfitted recordings."
    if product.latent_sentence.item() and product.verdict.item() == "unknown":
        yield "The latent force is a description of this recording, not identified physics;" + (
            " the held-out runs were predicted with it as requested." if product.latent_predicted else
            " it is not used in any prediction.")
    if product.latent_use.item():
        yield product.latent_use.item()
    if sentence := squeal_note(product):
        yield sentence


def _figures(product):
    yield _map(product)
    if len(product.hypothesis) > 1:
        yield Figure(pictures.hypotheses(product), "Probabilities of the leading hypotheses; blue: named.")
    if any(product.stage):      # rivals of recordings, or of the model as a whole, are of no stage
        yield Figure(pictures.stage_place(product), "Probability by stage of the chain and location, summed over"
                     " hypotheses; empty: no hypothesis in the catalogue.")
    name, held_out = _shown_run(product)
    if pictures.sampled(product.runs[name]):
        yield from _signals(product, name, held_out)
    elif str(product.channel[0]) == "friction":
        yield Figure(pictures.points(product), "Friction of every run, point by point in the order of sliding: measured"
                     " (with measurement noise and model error), recalibrated and completed model.")
    if len(product.parameter):
        yield Figure(pictures.parameters(product), "Fitted values with their uncertainty (orange: nominal parameters,"
                     " blue: parameters of added effects); dashed: the given value, 0 for added effects.")
    axes = [a for a in REGIMES if a in product.location]
    if axes:
        yield Figure(pictures.regimes(product, axes), "Regimes in which the missing force is larger than on average, in"
                     " standard deviations over circular shifts; blue: significant.")
    if product.latent:
        first = name if name in product.latent else next(iter(product.latent))
        yield Figure(latent_force.latent_force(product, first),
                     f"The missing force of run {first}, estimated beside the recalibrated nominal model without"
                     " any hypothesis; red: mean over bins of all fitted runs. A description, not identified physics.")
    yield from _predicted_with_force(product)


def _predicted_with_force(product):
    """The first held-out run with the latent force."""
    for name in list(product.latent_predicted)[:1]:
        yield Figure(latent_force.with_latent_force(product, name),
                     f"Held-out run {name}: measured, recalibrated nominal model, and the same with the latent force as"
                     " a function of the state. A description, not identified physics.")


def _signals(product, name, held_out, channel=0):
    """Excerpt and spectrum of one channel of a run."""
    yield _overlay(product, name, held_out, channel)
    yield Figure(pictures.spectra(product, name, channel),
                 f"Residual spectra of {product.channel[channel]} in run {name}, with the noise assumed white.")


def _overlay(product, name, held_out, channel=0):
    return Figure(pictures.trace(product, name, channel),
                  f"Run {name}{' (held out)' if held_out else ''}: measured, nominal, recalibrated and completed"
                  f" around the largest {product.channel[channel]}; below, the residuals.")


def _shown_run(product):
    """(name, held out) of the run to plot: the first held-out run, else the worst fitted one."""
    for name, run in product.runs.items():
        if run.held_out:
            return name, True
    return max(product.runs, key=lambda n: product.runs[n].error[1]), False


def _with_force(product):
    """Errors of the held-out runs with and without the latent force."""
    if not product.latent_predicted:
        return None
    rows = tuple((name, percent(product.runs[name].error[1], 3), percent(float(prediction.error), 3),
                  percent(product.runs[name].error[3], 3)) for name, prediction in product.latent_predicted.items())
    return Table(("held-out run", "recalibrated", "with the latent force", "noise alone"), rows,
                 "Held-out runs with the latent force: a description, not identified physics", numeric=(1, 2, 3))


def _parameters(product):
    if not len(product.parameter):
        return None
    rows = tuple((("factor on " if product.parameter_factor[k] else "") + words(str(name).replace("@", " at ")),
                  quantity(product.parameter_nominal[k], unit, 4),
                  _with_error(product.parameter_value[k], product.parameter_std[k], unit),
                  number(_distance(product, k), 2)) for k, (name, unit) in enumerate(
                      zip(product.parameter, map(str, product.parameter_unit), strict=True)))
    return Table(("parameter", "given", "fitted", "deviation / sigma"), rows, "Fitted values", (1, 2, 3))


def _starts(product):
    """What is of single runs alone, as their start states."""
    rows = tuple((str(run), str(what), _with_error(value, std, str(unit))) for run, what, value, std, unit in zip(
        product.start_run, product.start_quantity, product.start_value, product.start_std, product.start_unit,
        strict=True))
    return Table(("run", "its start, or difference", "fitted"), rows, "Start states and differences of single runs",
                 (2,), folded=True) if rows else None


def _thresholds(product):
    """Every threshold between the recordings and the verdict, by its name in the settings."""
    units = ["" if str(unit) == "1" else f"\u202f{unit}" for unit in product.threshold_unit]
    rows = tuple((str(name), f"{value:g}{unit}", str(meaning)) for name, value, unit, meaning in zip(
        product.threshold, product.threshold_value, units, product.threshold_meaning, strict=True))
    return Table(("diagnosis.rules", "value", "meaning"), rows, "Rules by which it was decided", (1,), (2,),
                 folded=True) if rows else None


def _location(product):
    rows = []
    for name in AXES:
        axis = product.location.get(name)
        for k in range(0 if axis is None else len(axis.item)):
            rows.append((name, str(axis.item[k]), number(axis.score[k], 3), number(axis.p_value[k], 2),
                         "yes" if axis.member[k] else ""))
    head = ("axis", "item", "score", "family-wise p", "95 % set")
    return Table(head, tuple(rows), "Location of the mismatch", (2, 3), folded=True) if rows else None
