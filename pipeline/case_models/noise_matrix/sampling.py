"""Draws of the declared scatter at the conditions of a schedule: in which bands is each brake application noisy?

Draw k is stop k % r of brake k // r: what belongs to the brake is drawn once for its r stops, what changes from stop to
stop for each. Every pair of pressure and speed that occurs is solved; nothing is interpolated.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.case_models.noise_matrix.schedule import STOP
from pipeline.case_models.scatter import draw_values, factors_of
from pipeline.contract import ConfigError, ConvergenceError
from pipeline.physics.stability.draws.draw_statistics import band_of
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import beside_whole

TWO_PI = 2.0 * np.pi
#: draws of one task of the fan-out
_CHUNK = 20
#: pressures of a model without a normal law are those of its preload within this share
_EQUAL = 0.01


@dataclass(frozen=True)
class Bands:
    """Third octaves by their ``middle`` (b,) Hz, of which frequencies from ``low`` to ``high`` Hz count; growth rates
    above ``least`` 1/s and above ``neutral`` times the angular frequency are unstable."""

    middle: np.ndarray
    low: float
    high: float
    least: float
    neutral: float

    def noisy(self, roots):
        """(b,) whether an unstable one of ``roots`` (r,) 1/s lies in each band."""
        size = abs(roots)
        counts = roots.real > np.maximum(self.neutral * size, self.least)
        return self.holding(size[counts] / TWO_PI)

    def holding(self, frequency):
        """(b,) whether one of the frequencies (n,) Hz lies in each band."""
        inside = frequency[(frequency >= self.low) & (frequency <= self.high)]
        held = np.zeros(len(self.middle), bool)
        held[np.clip(band_of(inside, self.middle), 0, len(self.middle) - 1)] = True
        return held


@dataclass(frozen=True)
class Draws:
    """Values (d, s) of the sources, and the Factors of each of the d draws."""

    values: np.ndarray
    factors: tuple

    @classmethod
    def of(cls, settings, errors, model, count, seed):
        """``count`` brakes of ``settings.repeats`` stops each."""
        rng, repeats = np.random.default_rng(seed), settings.repeats
        values = draw_values(settings.sources, errors, count * repeats, rng)
        of_brake = np.array([source.kind not in settings.varying for source in settings.sources], bool)
        values[:, of_brake] = np.repeat(values[::repeats][:, of_brake], repeats, axis=0)
        return cls(values, tuple(factors_of(settings.sources, row, model) for row in values))


@dataclass(frozen=True)
class Group:
    """What shares one basis: a pad ``pressure`` Pa, a ``temperature`` K (0 where it does not act) and one direction."""

    pressure: float
    temperature: float
    direction: int


def pad_speeds(condition, points, settings):
    """(Group, speeds (p,) rad/s) of a Condition."""
    group = Group(settings.pressure_factor * condition.pressure, condition.temperature, int(np.sign(condition.speed)))
    return group, condition.speeds(points) / settings.wheel_radius


def families(groups, model, friction_map, family, reference_temperature):
    """[Family] of the Groups; ``family(model, state, friction_map, direction)``: that of one preload. ConfigError for a
    pressure that a model without a normal law does not have."""
    made = []
    for group in groups:
        state = int(np.argmin(abs(model.pressure - group.pressure)))
        if not len(model.law_closure) and abs(model.pressure[state] / group.pressure - 1) > _EQUAL:
            raise ConfigError(
                "noise_matrix", "pressures that the model has a preload for, as its contacts have no normal law:"
                f" {', '.join(f'{p:g} Pa' for p in model.pressure)}", f"{group.pressure:g} Pa on the pads",
                "add it to the pressures of structure or the load factors of lumped, or change pressure_factor")
        warm = friction_map if not group.temperature else at_temperature(
            friction_map, group.temperature - reference_temperature)
        made.append(replace(family(model, state, warm, group.direction), input_force=group.pressure * model.input_area))
    return made


def at_temperature(friction_map, rise):
    """The FrictionMap of bodies that are ``rise`` K warmer than its temperature of reference; beyond its temperatures
    it is constant."""
    warm, own = friction_map.over_temperature["bodies"], float(friction_map.bulk_temperature)
    rises, first = np.unique(np.concatenate([[own], warm.temperature]), return_index=True)
    tables = np.concatenate([friction_map.friction[None], warm.friction])[first]
    weight = np.array([np.interp(rise, rises, row) for row in np.eye(len(rises))])
    return replace(friction_map, friction=np.tensordot(weight, tables, 1))


@dataclass(frozen=True)
class Solved:
    """``noisy`` (d, c, b): bands in which the draws are noisy under the conditions; ``refined`` and ``coarse`` (k, s):
    whether the first draws are noisy in the stops at twice as many points, and at those of ``noisy``; ``compared``:
    [(roots, the same of the whole model, number that only one has)]."""

    noisy: np.ndarray
    refined: np.ndarray
    coarse: np.ndarray
    compared: list


def solved(schedule, draws, training, model, friction_map, family, points, bands, settings, context):
    """Solved: the Draws under the conditions of a Schedule; ``family``: see ``families``."""
    where = [pad_speeds(condition, settings.points, settings) for condition in schedule.conditions]
    groups = list(dict.fromkeys(group for group, _ in where))
    speeds = {group: np.unique(np.concatenate([v for g, v in where if g == group])) for group in groups}
    tasks = list(zip(families(groups, model, friction_map, family, settings.reference_temperature),
                     speeds.values(), strict=True))
    cases = dict(zip(groups, context.map(
        partial(_sampled, points.frequency_max, (NOMINAL, *training.factors), settings.smallest_correction), tasks,
        "common bases"), strict=True))
    noisy = _noisy(where, cases, draws.factors, bands, context)
    stops = [k for k, condition in enumerate(schedule.conditions) if condition.kind == STOP]
    finer = [pad_speeds(schedule.conditions[k], 2 * settings.points, settings) for k in stops]
    checked = draws.factors[:settings.checked]
    refined = _noisy(finer, cases, checked, bands, context).any(axis=2)
    pairs = [(cases[group], speed) for group, speed_of in where for speed in speed_of]
    tasks = [(*pairs[-1 - k * (len(speeds[groups[-1]]) + 1) % len(pairs)], factors)
             for k, factors in enumerate(checked)]
    return Solved(noisy, refined, noisy[:len(checked)][:, stops].any(axis=2),
                  context.map(partial(_compared, points.frequency_max), tasks, "whole model"))


def _sampled(below, training, smallest, task):
    return sampled(*task, below, training, smallest)


def _compared(below, task):
    case, speed, factors = task
    return beside_whole(case, factors, speed, below)


def _noisy(where, cases, factors, bands, context):
    """(d, c, b): bands in which each draw is noisy at any speed of each condition [(Group, speeds)]."""
    speeds = {group: np.unique(np.concatenate([v for g, v in where if g == group]))
              for group in dict.fromkeys(group for group, _ in where)}
    chunks = [range(k, min(k + _CHUNK, len(factors))) for k in range(0, len(factors), _CHUNK)]
    tasks = [(cases[group].compact(), of, [(k, factors[k]) for k in chunk]) for group, of in speeds.items()
             for chunk in chunks]
    parts = context.map(partial(_held, bands), tasks, "draws")
    held = {group: np.concatenate(parts[k * len(chunks):(k + 1) * len(chunks)]) for k, group in enumerate(speeds)
            if chunks}
    noisy = np.zeros((len(factors), len(where), len(bands.middle)), bool)
    for k, (group, of) in enumerate(where):
        if group in held:
            noisy[:, k] = held[group][:, np.searchsorted(speeds[group], of)].any(axis=1)
    return noisy


def _held(bands, task):
    """(draws, speeds, b) of some draws of one Group."""
    case, speeds, drawn = task
    held = np.zeros((len(drawn), len(speeds), len(bands.middle)), bool)
    for row, (number, factors) in zip(held, drawn, strict=True):
        try:
            for k, speed in enumerate(speeds):
                row[k] = bands.noisy(case.roots(factors, speed))
        except ConvergenceError as error:
            raise ConvergenceError(f"noise_matrix, draw {number}: {error.where}", error.expected, error.found,
                                   error.remedy) from error
    return held
