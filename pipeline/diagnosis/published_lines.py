"""The diagnosis of published lines: mode tables, harmonics, squeal frequencies, each to the product Diagnosis."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis import harmonics, mode_table, squeal_lines
from pipeline.diagnosis.answer import answer
from pipeline.diagnosis.lines import diagnosed
from pipeline.diagnosis.question import label
from pipeline.inference import diagnose as course

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
    told = answer(asked, found)
    if isinstance(following, _Undecided):
        told, following = following.tied(told), following.conditions
    told = _capped(told)
    told = replace(told, reason=np.array([*told.reason, *_before(found), *reasons(found)], dtype=object))
    if not len(told.named):
        return told
    rivals = _rivals(told)
    return replace(told, next_condition=np.array(following, dtype=object), next_value=np.array(_entropy(told, rivals)),
                   next_separates=np.array([told.hypothesis[k] for k in rivals], dtype=object))


@dataclass(frozen=True)
class _Undecided:
    """Hypotheses ``names`` that meet all lines as lines at random would too; ``conditions`` of a better recording."""

    names: tuple
    conditions: tuple

    def tied(self, told):
        if told.verdict.item() != "unknown" or not self.names:
            return told
        rows = [k for k, name in enumerate(told.hypothesis) if str(name) in self.names]
        reason = (f"{', '.join(self.names)} would each sound at the recorded frequencies, as almost any list of modes"
                  " would: these lines cannot tell them apart")
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
    return asked, lambda found: mode_table.mode_reasons(rows, found), (
        "measured = shapes of the lines that differ, counted in nodal diameters and circles",
        "computed = all modes up to the highest line, with their shapes, on two meshes")


def _harmonics(recording, models, told, context):
    modes = models.needed("modes", "complex_modes")
    motions = harmonics.shown(models.needed("model", "reduced_model"), told,
                              lambda f, items: context.map(f, items, "mechanisms"))
    asked = harmonics.harmonics_question(recording, told, motions, modes)
    return asked, lambda found: harmonics.harmonics_reasons(recording, told, motions, modes), (
        "normal_load = twice that of the record", f"speed = {2 * told.speed:.4g} rad/s",
        "measured = levels of all lines with the range of the analyser, and the contact resistance (open or closed)")


def _squeal(recording, models, told, context):
    found = squeal_lines.claims(recording, told, models.needed("modes", "complex_modes"))
    asked = squeal_lines.squeal_question(recording, told, found)
    names = tuple(label(((found[k].effect, found[k].place),)) for k in squeal_lines.undecided(found, recording, told))
    conditions = (
        "growth phases = at three speeds and one load: falling friction makes growth depend on the speed, flutter"
        " does not",
        "growth phases = at three loads and one speed, and at a constant and a changing one",
        "measured = shapes in squeal over the whole ring, counted in nodal diameters, with their sense of rotation")
    return asked, lambda _: squeal_lines.squeal_reasons(
        recording, told, found, models.modes, models.structure), _Undecided(names, conditions)


#: kind of list -> (Question, reasons(found), conditions of the next recording)
_KINDS = {"modes": _modes, "harmonics": _harmonics, "squeal": _squeal}
