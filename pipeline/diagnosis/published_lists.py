"""The problem of published lines: mode tables, harmonics, squeal frequencies."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis.experiment_design.next_lists import best_check, best_outcome
from pipeline.diagnosis.experiment_design.next_run import Rival
from pipeline.diagnosis.problem import DiagnosisProblem, label
from pipeline.diagnosis.published import harmonics, mode_table, squeal_frequencies
from pipeline.diagnosis.rules import ListRules, rules_stated
from pipeline.inference.decision.second_effect import NAMING
from pipeline.inference.problem import FanOut


@dataclass(frozen=True)
class Models:
    """Products of the chain that a list is compared with; None where the chain has none."""

    model: object = None
    structure: object = None
    modes: object = None

    def needed(self, name, what):
        """The product ``name``, or ConfigError."""
        model = getattr(self, name)
        if model is None:
            raise ConfigError("diagnosis.lines.kind", f"a chain with {what} before it", "none")
        return model


def published_problem(recording, models, settings, fan_out=map):
    """DiagnosisProblem of the lists that ``settings.lines`` names, from a product Recording and the Models."""
    if settings.lines is None:
        raise ConfigError("diagnosis.lines", "which lists are compared, because forward is lines", "nothing")
    builder = {"modes": _modes, "harmonics": _harmonics, "squeal": _squeal}[settings.lines.kind]
    problem = builder(recording, models, settings.lines, rules_stated(settings), fan_out)
    return replace(problem, settings=replace(problem.settings, draws=settings.draws, seed=settings.seed))


@dataclass(frozen=True)
class ListRevision(ABC):
    """Revision of what one published list says: at most a tie, with its reasons and what would decide next.

    ``conditions`` of a better recording in words; ``undecided``: hypotheses that meet all lines as lines at random
    would too.
    """

    rules: ListRules
    conditions: tuple
    undecided: tuple = ()

    @abstractmethod
    def reasons(self, diagnosis):
        """Sentences from the numbers of the lists."""

    def best(self, rivals):
        """Expected of the record that separates the Rivals best; None where none is computed."""
        return

    def revised(self, product, diagnosis):
        product = _capped(self._tied(product))
        reasons = [*product.reason, *self._chosen_before(diagnosis), *self.reasons(diagnosis)]
        product = replace(product, reason=np.array(reasons, dtype=object))
        return replace(product, **self._next(product, diagnosis)) if len(product.named) else product

    def _tied(self, product):
        """The product; a tie of the undecided hypotheses where nothing else is known."""
        if product.verdict.item() != "unknown" or not self.undecided:
            return product
        rows = [k for k, name in enumerate(product.hypothesis) if str(name) in self.undecided]
        reason = (f"{', '.join(self.undecided)} would each sound at the recorded frequencies, as almost any list of"
                  " modes would: these lines cannot tell them apart")
        return replace(product, verdict=np.array("tie", dtype=object), named=np.array(rows),
                       reason=np.array([reason, *product.reason[1:]], dtype=object))

    def _chosen_before(self, diagnosis):
        """What a pair takes as known was itself chosen among alternatives."""
        if diagnosis.base is None:
            return []
        alternatives = ", ".join(f"{w.candidate.name} ({w.statistics.posterior:.0%})" for w in diagnosis.base.weighed
                                 if w.statistics.posterior > self.rules.worth_telling)
        return [f"named beside {diagnosis.nominal.name}, for which alone there were: {alternatives}"]

    def _next(self, product, diagnosis):
        """Fields of the next experiment: the record that is expected to separate best; where none is computed, what
        would decide in words, and as its value what a decision would tell."""
        rows = _rivals(product)
        conditions, separates = self.conditions, [product.hypothesis[k] for k in rows]
        value, fits = _entropy(product, rows), {w.candidate.name: w.fit for w in diagnosis.weighed}
        rivals = [Rival(str(product.hypothesis[k]), product.posterior[k], fits.get(product.hypothesis[k]))
                  for k in rows]
        best = self.best(rivals) if len(rivals) > 1 else None
        if best is not None:
            conditions, separates, value = [best.condition], best.separates, best.value
        return {"next_condition": np.array(conditions, dtype=object),
                "next_separates": np.array(separates, dtype=object), "next_value": np.array(value)}


def _capped(product):
    """One published list, nothing held out: what it names is at most a tie."""
    if product.verdict.item() not in NAMING:
        return product
    reason = "one published record and nothing held out: what it names is a proposal, and the verdict at most a tie"
    return replace(product, verdict=np.array("tie", dtype=object),
                   reason=np.array([*product.reason, reason], dtype=object))


def _rivals(product):
    """Rows of the hypotheses that another recording has to separate: those named; one alone beside its runner-up."""
    if len(product.named) > 1:
        return [int(k) for k in product.named]
    others = [k for k in range(1, len(product.hypothesis)) if k not in (*product.named, *product.known)]
    return [int(product.named[0]), *sorted(others, key=lambda k: -product.posterior[k])[:1]]


def _entropy(product, rows):
    """What a recording that decides between these hypotheses tells at most, in nats."""
    probability = product.posterior[rows] / max(product.posterior[rows].sum(), 1e-300)
    probability = probability[probability > 0]
    return abs(float(np.sum(probability * np.log(probability))))


@dataclass(frozen=True)
class ModeRevision(ListRevision):
    """Of a Table ``rows`` of modes; ``problem`` is its DiagnosisProblem, ``checks`` what would undo alternatives."""

    rows: mode_table.Table | None = None
    problem: DiagnosisProblem | None = None
    checks: dict = field(default_factory=dict)

    def reasons(self, diagnosis):
        return mode_table.mode_reasons(self.rows, diagnosis, self.rules)

    def best(self, rivals):
        return best_check(self.problem, rivals, self.checks, self.rules) if all(r.fit for r in rivals) else None


def _modes(recording, models, section, rules, fan_out):
    rows = mode_table.table(recording, section, rules.lists)
    problem = mode_table.mode_problem(rows, models.structure, section, rules)
    known = {c.effects[0][0] for c in problem.candidates}
    checks = {name: check for name, check in mode_table.CHECKS.items() if known & set(check.effects)}
    return replace(problem, revision=ModeRevision(rules.lists, tuple(checks), (), rows, problem, checks))


@dataclass(frozen=True)
class HarmonicsRevision(ListRevision):
    """Of harmonics beside computed ``motions`` of a ``model``; ``effects`` {hypothesis: effect}."""

    recording: Any = None
    section: harmonics.Harmonics | None = None
    model: Any = None
    modes: Any = None
    motions: dict = field(default_factory=dict)
    effects: dict = field(default_factory=dict)
    fan_out: FanOut = map

    def reasons(self, diagnosis):
        return harmonics.harmonics_reasons(self.recording, self.section, self.motions, self.modes)

    def best(self, rivals):
        if any(r.fit and len(r.fit.hypothesis.effects) > 1 for r in rivals):
            return None         # no motion of two mechanisms beside one another was computed
        effects = {r.name: self.effects[r.name] for r in rivals}
        outcomes = harmonics.outcomes(self.model, self.section, self.motions, list(effects.values()), self.fan_out)
        return best_outcome(rivals, {condition: {name: shown[effect] for name, effect in effects.items()}
                                     for condition, shown in outcomes.items()}, self.rules)


def _harmonics(recording, models, section, rules, fan_out):
    modes, model = models.needed("modes", "complex_modes"), models.needed("model", "reduced_model")
    motions = harmonics.shown(model, section, fan_out)
    problem = harmonics.harmonics_problem(recording, section, motions, modes, rules)
    conditions = (
        "normal_load = twice that of the record", f"speed = {2 * section.speed:.4g} rad/s",
        "measured = levels of all lines with the range of the analyser, and the contact resistance (open or closed)")
    effects = {c.name: c.effects[0][0] for c in problem.candidates}
    return replace(problem, revision=HarmonicsRevision(
        rules.lists, conditions, (), recording, section, model, modes, motions, effects, fan_out))


@dataclass(frozen=True)
class SquealRevision(ListRevision):
    """Of squeal frequencies beside ``claims`` on them."""

    recording: Any = None
    section: squeal_frequencies.SquealLines | None = None
    claims: tuple = ()
    models: Models = Models()

    def reasons(self, diagnosis):
        return squeal_frequencies.squeal_reasons(self.recording, self.section, self.claims, self.models.modes,
                                                 self.models.structure, self.rules)


def _squeal(recording, models, section, rules, fan_out):
    claims = squeal_frequencies.claims(recording, section, models.needed("modes", "complex_modes"))
    problem = squeal_frequencies.squeal_problem(recording, section, claims, rules)
    undecided = tuple(label(((claims[k].effect, claims[k].location),))
                      for k in squeal_frequencies.undecided(claims, recording, section))
    conditions = (
        "growth phases = at three speeds and one load: falling friction makes growth depend on the speed, flutter"
        " does not",
        "growth phases = at three loads and one speed, and at a constant and a changing one",
        "measured = shapes in squeal over the whole ring, counted in nodal diameters, with their sense of rotation")
    return replace(problem, revision=SquealRevision(rules.lists, conditions, undecided, recording, section, claims,
                                                    models))
