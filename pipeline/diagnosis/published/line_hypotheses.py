"""What makes a brake squeal, as hypotheses that predict tones: from the YAML to the tones of every draw.

    line_evidence:
      hypotheses:
        one_way: {disc: rigid, harmonics: true, joint_factors: {abutment: 0.34}}
        flexible_disc: {disc: flexible}
        falling_friction: {disc: flexible, falling: [0, 0.1]}
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pipeline.case_models.scatter import Source, check_sources, draw_values, factors_of
from pipeline.contract import ConfigError, Quantity, Section, option
from pipeline.diagnosis.published.line_tests import grouped
from pipeline.inference.decision.line_evidence import Tones

FLEXIBLE, RIGID = "flexible", "rigid"
#: columns of the drawn values beside those of the sources
FALLING, LOADING = "falling friction", "growth by changing load"
_TWO_PI = 2 * np.pi


class Hypothesis(Section):
    """One explanation of the tones: whether the disc is flexible in the loop, and what else differs."""

    disc: Literal[FLEXIBLE, RIGID] = option(..., "flexible: modes of the whole brake; rigid: of pads and caliper on a"
                                            " disc that does not move")
    harmonics: bool = option(False, "multiples of each unstable mode are tones as well: its motion saturates")
    multiples: int = option(24, "highest of these multiples", ge=2)
    sources: tuple[Source, ...] = option((), "replace the sources of the same name")
    joint_factors: dict[str, float] = option(
        {}, "factors on the stiffness of joints, by part of their name; of several, the longest part counts")
    falling: tuple[float, float] | None = option(
        None, "range of -dmu/dln(speed) that is added, uniformly distributed")
    load_rate: Quantity("Hz", ge=0) = option(
        "0 Hz", "frequency f of a changing load, under which modes may grow by up to 2 pi f faster")


@dataclass(frozen=True)
class Drawn:
    """Draws of a Hypothesis: ``name`` of each column of ``values`` (d, s), and ``factors``, d Factors."""

    name: tuple
    values: np.ndarray
    factors: tuple

    def column(self, name):
        """(d,) of one column."""
        return self.values[:, self.name.index(name)]


def check_hypotheses(hypotheses, sources, where):
    """ConfigError at ``where`` for hypotheses that cannot be drawn."""
    check_sources(sources, f"{where}.sources")
    for name, hypothesis in hypotheses.items():
        here = f"{where}.hypotheses.{name}"
        check_sources(hypothesis.sources, f"{here}.sources")
        falling = hypothesis.falling
        if falling is not None and not 0 <= falling[0] < falling[1]:
            raise ConfigError(f"{here}.falling", "two rising values from 0", str(list(falling)))
        if any(factor <= 0 for factor in hypothesis.joint_factors.values()):
            raise ConfigError(f"{here}.joint_factors", "factors above 0", str(hypothesis.joint_factors))


def drawn(hypothesis, sources, errors, model, count, seed):
    """Drawn of a Hypothesis on the ``sources`` of the case, in a product ReducedModel.

    The same ``seed`` gives sources that two hypotheses share the same values. ConfigError for joints that the model
    does not have.
    """
    replaced = {s.name: s for s in (*sources, *hypothesis.sources)}
    rng = np.random.default_rng(seed)
    values = draw_values(replaced.values(), errors, count, rng)
    unit = rng.uniform(size=(2, count))
    low, high = hypothesis.falling or (0.0, 0.0)
    falling, loading = low + (high - low) * unit[0], _TWO_PI * hypothesis.load_rate * unit[1]
    joints = _joint_factors(hypothesis.joint_factors, [str(n) for n in model.joint_name])
    factors = [factors_of(replaced.values(), row, model) for row in values]
    factors = tuple(replace(f, joint_stiffness=f.joint_stiffness * joints, speed_slope=f.speed_slope - drop)
                    for f, drop in zip(factors, falling, strict=True))
    return Drawn((*replaced, FALLING, LOADING), np.column_stack((values, falling, loading)), factors)


def _joint_factors(stated, names):
    """(j,) factor of each joint."""
    for part in stated:
        if not any(part in name for name in names):
            raise ConfigError("line_evidence: joint_factors", f"part of one of {', '.join(names)}", repr(part))
    chosen = [max((part for part in stated if part in name), key=len, default=None) for name in names]
    return np.array([stated.get(part, 1.0) for part in chosen])


def on_rigid_disc(family, bodies):
    """The Family with the ``bodies`` of its disc rigid and held. ConfigError for bodies that it does not have."""
    names = [str(name) for name in family.model.body_name]
    unknown = [body for body in bodies if body not in names]
    if unknown:
        raise ConfigError("line_evidence.disc", f"bodies among {', '.join(names)}", ", ".join(unknown))
    if set(bodies) >= set(names):
        raise ConfigError("line_evidence.disc", f"not every body, of {', '.join(names)}", ", ".join(bodies),
                          "name the bodies of the disc alone: the others must move where it is rigid")
    kept = np.flatnonzero(~np.isin(family.model.coordinate_body, [names.index(body) for body in bodies]))
    block = np.ix_(kept, kept)
    return replace(family, model=family.model.held(*bodies), loss=family.loss[block],
                   lining=None if family.lining is None else family.lining[block])


def same_solution(hypothesis):
    """What the unstable modes of a Hypothesis depend on: those of equal keys are solved for once."""
    return (hypothesis.disc, tuple(map(str, hypothesis.sources)), tuple(sorted(hypothesis.joint_factors.items())),
            hypothesis.falling)


def tone_set(roots, growth, test, count, highest, multiples, apart):
    """Tones of a draw from its ``roots`` [(r,)] at o operating points: frequencies (k,) Hz, ascending, and the tests
    (k, t) in which they grow, of ``count`` tests.

    Modes whose growth rate and ``growth`` (o,) 1/s exceed 0, at the operating points of each ``test`` (o,), and their
    ``multiples`` up to this one (1: none) and up to ``highest`` Hz. Modes of several operating points closer than the
    share ``apart`` of their frequency are one tone, at their mean.
    """
    owner = np.repeat(test, [len(r) for r in roots]).astype(int)
    more = np.repeat(growth, [len(r) for r in roots])
    root = np.concatenate([np.empty(0, complex), *roots])
    unstable = root.real > -more
    frequency, owner = abs(root[unstable].imag) / _TWO_PI, owner[unstable]
    groups = grouped(frequency, apart)
    base = np.array([frequency[group].mean() for group in groups])
    grows = np.array([np.isin(np.arange(count), owner[group]) for group in groups], bool).reshape(-1, count)
    orders = [max(1, int(min(multiples, highest // f))) if f > 0 else 1 for f in base]
    tones = np.concatenate([np.empty(0), *(f * np.arange(1, n + 1) for f, n in zip(base, orders, strict=True))])
    order = np.argsort(tones, kind="stable")
    return tones[order], np.repeat(grows, orders, axis=0)[order]


def tones_of(sets, count, shares, error, reading):
    """Tones of d draws, whose ``sets`` [((k,) Hz, (k, t))] are those of ``tone_set``, in ``count`` tests.

    One row for each draw and each of the ``shares`` (m,) of growing tones that are heard, (d m,), those of a draw
    together. ``error``: relative standard deviation of a predicted frequency; ``reading`` Hz that of a heard one.
    """
    widest = max((len(f) for f, _ in sets), default=0)
    frequency, grows = np.ones((len(sets), widest)), np.zeros((len(sets), widest, count))
    for row, (tones, tests) in enumerate(sets):
        frequency[row, :len(tones)], grows[row, :len(tones)] = tones, tests
    frequency, grows = (np.repeat(part, len(shares), axis=0) for part in (frequency, grows))
    return Tones(frequency, np.hypot(error * frequency, reading), grows, np.tile(shares, len(sets)))
