"""A table of computed and measured modes: which rows differ, and whether pairing, a value or physics explains it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from pipeline.contract import ConfigError, Section, option
from pipeline.diagnosis.experiment_design.next_lists import Check
from pipeline.diagnosis.published.chance_agreement import assigned, chance, covered
from pipeline.diagnosis.published.frequency_lists import FACTOR, Alternative, Features, lines_of, list_problem
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.physics.modal.disc_modes import describe

#: what undoes an alternative: {record: Check}
CHECKS = {"measured = shapes of the lines that differ, counted in nodal diameters and circles":
          Check(("mis_paired", "unlisted_partner"), tells_which=True),
          "computed = all modes up to the highest line, on two meshes": Check(("rise_with_frequency",)),
          "measured = thickness of the disc and modulus of its material": Check(("axisymmetric_stiffness",)),
          "measured = lines of the disc held as it is computed": Check(("support",))}


class ModeTable(Section):
    """Measured modes beside computed ones."""

    kind: Literal["modes"] = "modes"
    measured: str = option(..., "run with the measured lines")
    computed: str = option(..., "run with the computed lines")
    list: str = option("disc", "name of the list in both runs")
    pairs: dict[str, tuple[str, ...]] = option(
        {}, "measured line: its computed partners, as published; none = smallest sum of logarithmic ratios")
    factor_spread: float = option(0.05, "prior of one factor on all frequencies: standard deviation of its logarithm;"
                                        " 0.05 is a modulus or a density 10 % off", gt=0)


@dataclass(frozen=True)
class Table:
    """Rows of measured frequencies ``test`` (n,) with ``std``, their partners ``model`` (n,), and modes without one.

    ``members`` (n,) tuples of line names, ``partners`` (n,) 1 single, 2 pair, 0 unknown, ``diameters`` (n,) or -1;
    ``spare`` [(names, frequency, partners)] computed modes that the table pairs with nothing.
    """

    name: tuple
    test: np.ndarray
    std: np.ndarray
    model: np.ndarray
    members: tuple
    partners: np.ndarray
    diameters: np.ndarray
    spare: tuple

    @property
    def difference(self):
        """Measured less computed, relative to the computed (n,)."""
        return self.test / self.model - 1


def table(recording, section, rules=DEFAULTS.lists):
    """Table of a product Recording under a section ModeTable; the tolerance of a line counts as two deviations."""
    test, model = (lines_of(recording, run, section.list) for run in (section.measured, section.computed))
    names, known = [str(n) for n in test.label], [str(n) for n in model.label]
    groups = _modes(model, rules.twins)
    pairs = section.pairs or _nearest(names, test, groups)
    wrong = [n for n in (*pairs, *(m for group in pairs.values() for m in group)) if n not in (*names, *known)]
    if wrong or set(pairs) != set(names):
        raise ConfigError("diagnosis.lines.pairs", f"every one of {', '.join(names)}, with lines of {section.computed}",
                          ", ".join(wrong or sorted(set(names) - set(pairs))))
    frequency = dict(zip(known, model.frequency, strict=True))
    taken = {m for group in pairs.values() for m in group}
    return Table(tuple(names), test.frequency, test.frequency_tolerance / 2,
                 np.array([np.mean([frequency[m] for m in pairs[n]]) for n in names]),
                 tuple(tuple(pairs[n]) for n in names), test.partners, test.diameters,
                 tuple(g for g in groups if not taken & set(g[0])))


def mode_problem(rows, structure, section, rules=DEFAULTS):
    """DiagnosisProblem of a Table: the printed pairs as nominal model, beside it other pairs, mesh, support, kind of
    mode."""
    features = {n: Features("frequency", "Hz", [t], [s])
                for n, t, s in zip(rows.name, rows.test, rows.std, strict=True)}
    factor = Parameter(FACTOR, "1", 1.0, LogNormal(1.0, section.factor_spread))
    others = alternatives(rows, structure, rules.lists)
    return list_problem(features, _shown(rows, rows.model), others, (factor,), rules)


def alternatives(rows, structure=None, rules=DEFAULTS.lists):
    """Alternatives to the printed pairs; those that need shapes only with a product Structure."""
    others = [Alternative("mis_paired", f"{rows.name[i]} as {'/'.join(g[0])}",
                         {rows.name[i]: np.array([g[1]])}, "sensor") for i, g in nearer(rows)]
    others += [Alternative("mis_paired", f"{rows.name[i]} exchanged with {rows.name[k]}",
                          {rows.name[i]: rows.model[[k]], rows.name[k]: rows.model[[i]]}, "sensor")
              for i, k in exchanges(rows)]
    others += [Alternative("unlisted_partner", name, {name: rows.test[[i]]}, "sensor", rules.anywhere)
              for i, name in enumerate(rows.name)]
    rising = rows.model / rows.model.max()
    others.append(Alternative("rise_with_frequency", "computed modes",
                             _shown(rows, rows.model * (1 - rules.change * rising)), "numerics"))
    single = rows.partners == 1
    if single.any() and not single.all():
        for change, sign in (("single modes too stiff", -1), ("single modes too soft", 1)):
            others.append(Alternative("axisymmetric_stiffness", change,
                                     _shown(rows, rows.model * (1 + sign * rules.change * single))))
    if structure is not None:
        others.append(Alternative("support", "computed disc held, measured free",
                                 _shown(rows, rows.model / held_ratio(rows, structure, rules))))
    return tuple(others)


def nearer(rows):
    """[(row, spare mode)] where a computed mode without a partner lies nearer to a measured one than the printed."""
    distance = np.abs(np.log(rows.test / rows.model))
    return [(i, g) for i in range(len(rows.name)) for g in rows.spare if abs(np.log(rows.test[i] / g[1])) < distance[i]]


def exchanges(rows):
    """[(i, k)] pairs of rows that lie nearer, both together, with their partners exchanged."""
    def far(i, k):
        return abs(np.log(rows.test[i] / rows.model[k]))
    count = len(rows.name)
    return [(i, k) for i in range(count) for k in range(i + 1, count) if far(i, k) + far(k, i) < far(i, i) + far(k, k)]


def held_ratio(rows, structure, rules=DEFAULTS.lists):
    """Frequency (n,) of each row's mode on its mount over that of the free disc, by our own shapes; 1 where unknown."""
    free = _kinds(structure.free_frequency, structure.free_diameters)
    shape = structure.disc.shape
    diameters, _ = describe(structure.disc.node, shape.reshape(len(shape), -1).T)
    held = _kinds(structure.disc.frequency, diameters)
    ratio = np.ones(len(rows.name))
    for i, test in enumerate(rows.test):
        count = 0 if rows.partners[i] == 1 else int(rows.diameters[i])
        series = free.get(count, np.empty(0))
        if len(series):
            apart = np.abs(np.log(series / test))
            order = int(np.argmin(apart))
            if apart[order] < np.log(rules.farthest) and order < len(held.get(count, ())):
                ratio[i] = held[count][order] / series[order]
    return ratio


def mode_reasons(rows, diagnosis, rules=DEFAULTS.lists):
    """Sentences on a Table and the Diagnosis over it, from its numbers."""
    null = diagnosis.base.null if diagnosis.base else diagnosis.null
    off = np.array([r[0] for r in null.residuals])
    outlying = [int(i) for i in np.argsort(-np.abs(off)) if abs(off[i]) > rules.outlying]
    reasons = [f"{rows.name[i]}: {rows.test[i]:.1f} Hz measured beside {rows.model[i]:.1f} Hz computed"
               f" ({rows.difference[i]:+.1%}, {abs(off[i]):.1f} standard deviations; the tolerance of the row, an"
               " inferred number, counts as two)" for i in outlying]
    reasons.append(_of_factor(rows, null, rules))
    reasons += [_of_pair(rows, i, mode) for i, mode in nearer(rows)]
    other = {i for i, _ in nearer(rows)} | {i for pair in exchanges(rows) for i in pair}
    reasons += [f"{rows.name[i]}: no printed mode lies nearer than its partner, alone or exchanged: it is not"
                " mis-paired within the table" for i in sorted(outlying) if i not in other]
    if len({np.sign(off[i]) for i in outlying}) == 2:
        reasons.append("the rows that differ most do so in opposite directions: one added stiffness or mass moves all"
                       " modes the same way and cannot explain both")
    return reasons


def _of_factor(rows, null, rules):
    before = float(np.sum(((rows.test - rows.model) / rows.std) ** 2))
    enough = null.chi_square.sum() <= scipy.stats.chi2.isf(rules.factor_p, len(rows.name))
    factor, std, left = null.values[FACTOR], null.spread()[FACTOR], null.chi_square.sum()
    return (f"one factor on all frequencies, as a wrong modulus or density gives, is fitted as {factor:.3f} +-"
            f" {std:.3f} and takes the squared deviations from {before:.1f} to {left:.1f} over"
            f" {len(rows.name)} rows:"
            f" {'enough' if enough else 'it does not explain the rows that differ'}")


def _of_pair(rows, i, mode):
    names, frequency, partners = mode
    apart = abs(np.log(rows.test[i] / frequency))
    spare = np.log([g[1] for g in rows.spare])
    every = np.log(np.concatenate((rows.model, [g[1] for g in rows.spare])))
    share = covered(spare, apart, (every.min(), every.max()))
    kind = {1: "single", 2: "a pair"}
    sentence = (f"{rows.name[i]}: {frequency:.1f} Hz ({'/'.join(names)}), which the table pairs with nothing, lies"
            f" {rows.test[i] / frequency - 1:+.1%} away instead of {rows.difference[i]:+.1%}; a line at random finds a"
            f" spare mode as near with probability {share:.0%}, one of {len(rows.name)} with"
            f" {chance(share, len(rows.name)):.0%}, so that frequency alone does not prove it")
    if partners and rows.partners[i] and partners != rows.partners[i]:
        sentence += f"; against it: the mode is {kind[partners]}, the row is counted as {kind[int(rows.partners[i])]}"
    return sentence


def _modes(lines, twins):
    """[(names, frequency, partners)] of computed lines, those of one pair together."""
    groups = []
    for k in np.argsort(lines.frequency):
        near = groups and lines.partners[k] != 1 and np.log(lines.frequency[k] / groups[-1][1][-1]) < twins
        if near:
            groups[-1][0].append(str(lines.label[k]))
            groups[-1][1].append(lines.frequency[k])
        else:
            groups.append(([str(lines.label[k])], [lines.frequency[k]], int(lines.partners[k])))
    return tuple((tuple(names), float(np.mean(f)), partners) for names, f, partners in groups)


def _nearest(names, test, groups):
    partner = assigned(test.frequency, [g[1] for g in groups])
    if np.any(partner < 0):
        raise ConfigError("diagnosis.lines.computed", "at least as many modes as were measured", str(len(groups)))
    return {n: groups[k][0] for n, k in zip(names, partner, strict=True)}


def _kinds(frequency, diameters):
    """{nodal diameters: frequencies (k,)}, the two of a pair once."""
    kinds = {}
    for n in np.unique(diameters):
        frequencies = np.sort(frequency[diameters == n])
        kinds[int(n)] = frequencies[np.concatenate(([True], np.diff(np.log(frequencies)) > 1e-3))]
    return kinds


def _shown(rows, frequency):
    return {n: np.array([f]) for n, f in zip(rows.name, frequency, strict=True)}
