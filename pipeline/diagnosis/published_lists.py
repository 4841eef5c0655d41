"""The diagnosis of published lines: mode tables, harmonics, squeal frequencies, each to the product Diagnosis."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis.experiment_design.next_lists import best_check, best_outcome
from pipeline.diagnosis.experiment_design.next_run import Rival
from pipeline.diagnosis.output.product import answer
from pipeline.diagnosis.published import harmonics, mode_table, squeal_frequencies
from pipeline.diagnosis.published.frequency_lists import diagnosed
from pipeline.diagnosis.question import label
from pipeline.inference import procedure as course

#: verdicts that name something, which needs a second list that nothing was chosen on
_NAMING = ("missing", "sensor", "numerics")
#: alternatives below this probability are not told beside the one taken as known
_WORTH_TELLING = 0.01


@dataclass(frozen=True)
class Models:
    """Products of the chain that a list is compared with; None where the chain has none."""

    model: object = None
    structure: object = None
    modes: object = None

    def needed(self, name, what):
        """The product ``name``, or ConfigError."""
        found = getattr(self, name)
        if found is None:
            raise ConfigError("diagnosis.lines.kind", f"a chain with {what} before it", "none")
        return found


def published_diagnosis(recording, models, settings, context):
    """Product Diagnosis of the lists that ``settings.lines`` names, from a product Recording and the Models."""
    if settings.lines is None:
        raise ConfigError("diagnosis.lines", "which lists are compared, because forward is lines", "nothing")
    asked, reasons, following = _KINDS[settings.lines.kind](recording, models, settings.lines, context)
    context.log(f"{len(asked.candidates)} alternatives over {len(asked.problem.runs)} lists")
    found = diagnosed(asked, course.Settings(kept=len(asked.candidates), draws=settings.draws, seed=settings.seed,
                                             rules=asked.rules), context.map)
    told = following.tied(answer(asked, found))
    told = _capped(told)
    told = replace(told, reason=np.array([*told.reason, *_before(found), *reasons(found)], dtype=object))
    return replace(told, **_next(told, found, following)) if len(told.named) else told


def _next(told, found, following):
    """Fields of the next experiment: the record that is expected to separate best; where none is computed, what would
    decide in words, and as its value what a decision would tell."""
    rows = _rivals(told)
    conditions, separates, value = following.conditions, [told.hypothesis[k] for k in rows], _entropy(told, rows)
    fits = {w.candidate.name: w.fit for w in found.weighed}
    rivals = [Rival(str(told.hypothesis[k]), told.posterior[k], fits.get(told.hypothesis[k])) for k in rows]
    best = following.best(rivals) if len(rivals) > 1 else None
    if best is not None:
        conditions, separates, value = [best.condition], best.separates, best.value
    return {"next_condition": np.array(conditions, dtype=object), "next_separates": np.array(separates, dtype=object),
            "next_value": np.array(value)}


def _nothing_computed(rivals):
    return None


@dataclass(frozen=True)
class _Following:
    """What decides next: ``best(rivals)`` -> Expected or None, and ``conditions`` in words where nothing is computed.

    ``undecided``: hypotheses that meet all lines as lines at random would too; ``conditions`` of a better recording.
    """

    conditions: tuple
    best: Callable = _nothing_computed
    undecided: tuple = ()

    def tied(self, told):
        """The product; a tie of the undecided hypotheses where nothing else is known."""
        if told.verdict.item() != "unknown" or not self.undecided:
            return told
        rows = [k for k, name in enumerate(told.hypothesis) if str(name) in self.undecided]
        reason = (f"{', '.join(self.undecided)} would each sound at the recorded frequencies, as almost any list of"
                  " modes would: these lines cannot tell them apart")
        return replace(told, verdict=np.array("tie", dtype=object), named=np.array(rows),
                       reason=np.array([reason, *told.reason[1:]], dtype=object))


def _capped(told):
    """One published list, nothing held out: what it names is at most a tie."""
    if told.verdict.item() not in _NAMING:
        return told
    said = "one published record and nothing held out: what it names is a proposal, and the verdict at most a tie"
    return replace(told, verdict=np.array("tie", dtype=object), reason=np.array([*told.reason, said], dtype=object))


def _before(found):
    """What a pair takes as known was itself chosen among alternatives."""
    if found.base is None:
        return []
    shares = ", ".join(f"{w.candidate.name} ({w.contender.posterior:.0%})" for w in found.base.weighed
                       if w.contender.posterior > _WORTH_TELLING)
    return [f"named beside {found.nominal.name}, for which alone there were: {shares}"]


def _rivals(told):
    """Rows of the hypotheses that another recording has to separate: those named; one alone beside its runner-up."""
    if len(told.named) > 1:
        return [int(k) for k in told.named]
    others = [k for k in range(1, len(told.hypothesis)) if k not in (*told.named, *told.known)]
    return [int(told.named[0]), *sorted(others, key=lambda k: -told.posterior[k])[:1]]


def _entropy(told, rows):
    """What a recording that decides between these hypotheses tells at most, in nats."""
    share = told.posterior[rows] / max(told.posterior[rows].sum(), 1e-300)
    share = share[share > 0]
    return abs(float(np.sum(share * np.log(share))))


def _modes(recording, models, told, context):
    rows = mode_table.table(recording, told)
    asked = mode_table.mode_question(rows, models.structure, told)
    known = {c.effects[0][0] for c in asked.candidates}
    checks = {name: check for name, check in mode_table.CHECKS.items() if known & set(check.effects)}

    def best(rivals):
        return best_check(asked, rivals, checks) if all(r.fit for r in rivals) else None

    return asked, lambda found: mode_table.mode_reasons(rows, found), _Following(tuple(checks), best)


def _harmonics(recording, models, told, context):
    def fan_out(f, items):
        return context.map(f, items, "mechanisms")

    def best(rivals):
        if any(r.fit and len(r.fit.hypothesis.effects) > 1 for r in rivals):
            return None         # no motion of two mechanisms beside one another was computed
        effects = {c.name: c.effects[0][0] for c in asked.candidates}
        computed = harmonics.outcomes(model, told, motions, [effects[r.name] for r in rivals], fan_out)
        return best_outcome(rivals, {condition: {r.name: one[effects[r.name]] for r in rivals}
                                     for condition, one in computed.items()})

    modes, model = models.needed("modes", "complex_modes"), models.needed("model", "reduced_model")
    motions = harmonics.shown(model, told, fan_out)
    asked = harmonics.harmonics_question(recording, told, motions, modes)
    return asked, lambda found: harmonics.harmonics_reasons(recording, told, motions, modes), _Following((
        "normal_load = twice that of the record", f"speed = {2 * told.speed:.4g} rad/s",
        "measured = levels of all lines with the range of the analyser, and the contact resistance (open or closed)"),
        best)


def _squeal(recording, models, told, context):
    found = squeal_frequencies.claims(recording, told, models.needed("modes", "complex_modes"))
    asked = squeal_frequencies.squeal_question(recording, told, found)
    names = tuple(label(((found[k].effect, found[k].place),))
                  for k in squeal_frequencies.undecided(found, recording, told))
    conditions = (
        "growth phases = at three speeds and one load: falling friction makes growth depend on the speed, flutter"
        " does not",
        "growth phases = at three loads and one speed, and at a constant and a changing one",
        "measured = shapes in squeal over the whole ring, counted in nodal diameters, with their sense of rotation")
    return asked, lambda _: squeal_frequencies.squeal_reasons(
        recording, told, found, models.modes, models.structure), _Following(conditions, undecided=names)


#: kind of list -> (Question, reasons(found), what to record next)
_KINDS = {"modes": _modes, "harmonics": _harmonics, "squeal": _squeal}
