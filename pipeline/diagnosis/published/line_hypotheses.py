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


def drawn(hypothesis, sources, deviations, model, count, seed):
    """Drawn of a Hypothesis on the ``sources`` of the case, in a product ReducedModel.

    The same ``seed`` gives sources that two hypotheses share the same values. ConfigError for joints that the model
    does not have.
    """
    replaced = {s.name: s for s in (*sources, *hypothesis.sources)}
    rng = np.random.default_rng(seed)
    values = draw_values(replaced.values(), deviations, count, rng)
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


def on_rigid_disc(family, disc):
    """The Family with its body ``disc`` rigid and held."""
    kept = np.flatnonzero(family.model.coordinate_body != family.model.body_name.index(disc))
    block = np.ix_(kept, kept)
    return replace(family, model=family.model.held(disc), loss=family.loss[block],
                   lining=None if family.lining is None else family.lining[block])


def same_solution(hypothesis):
    """What the unstable modes of a Hypothesis depend on: those of equal keys are solved for once."""
    return (hypothesis.disc, tuple(map(str, hypothesis.sources)), tuple(sorted(hypothesis.joint_factors.items())),
            hypothesis.falling)


def tone_frequencies(roots, growth, highest, harmonics, apart):
    """Tones (k,) Hz, ascending, of some ``roots`` [(r,)], one array for each operating point.

    Modes whose growth rate and ``growth`` 1/s exceed 0; with ``harmonics`` their multiples up to ``highest`` Hz. Modes
    of several operating points closer than the share ``apart`` of their frequency are one tone, at their mean.
    """
    root = np.concatenate([np.empty(0, complex), *roots])
    frequency = np.sort(abs(root[root.real > -growth].imag)) / _TWO_PI
    breaks = np.flatnonzero(np.diff(frequency) > apart * frequency[1:]) + 1
    fundamental = np.array([group.mean() for group in np.split(frequency, breaks) if len(group)])
    if not harmonics:
        return fundamental
    return np.sort(np.concatenate([np.empty(0), *(f * np.arange(1, highest // f + 1) for f in fundamental if f > 0)]))


def tones_of(cycle, constant, shares, error, reading):
    """Tones of d draws: ``cycle`` and ``constant`` [(k,)] Hz; of each draw one row for each of ``shares`` (m,).

    ``shares`` of tones leave a line; ``error``: relative standard deviation of a predicted frequency; ``reading`` Hz
    that of a heard one. Rows (d m,), those of one draw together.
    """
    widest = max((len(f) for f in cycle), default=0)
    mean = -np.log1p(-np.asarray(shares, float))
    frequency, there = np.ones((len(cycle), widest)), np.zeros((len(cycle), widest))
    for row, tones in enumerate(cycle):
        frequency[row, :len(tones)], there[row, :len(tones)] = tones, 1.0
    frequency = np.repeat(frequency, len(mean), axis=0)
    quiet = np.outer([len(f) for f in constant], mean).ravel()
    return Tones(frequency, np.hypot(error * frequency, reading), np.kron(there, mean[:, None]), quiet)
