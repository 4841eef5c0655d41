"""Families of hidden values that a case may declare as nuisances, of a bench and its runs.

    loads     a constant force along each joint: a weight, a cable that pulls
    zeros     the zero of each channel
    drifts    its drift with time
    cogging   amplitudes of ``effects.cogging``, whose period the case states
"""

import numpy as np

from pipeline.case_models import corrections
from pipeline.contract import ConfigError
from pipeline.effects.resolved import felt_mass
from pipeline.effects.typical import JOINT, locations, typical
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis

#: standard gravity, m/s^2
_GRAVITY = 9.80665
_COGGING = "cogging"


def declared(bench, runs, settings, recorded):
    """Hypotheses, each of parameters of one hidden value that ``diagnosis.nuisances`` declares and nothing else fits.

    ``runs``: nominal Runs of the fitted ones of ``recorded`` (Recorded, ...). ConfigError for cogging without a period.
    """
    made = {"loads": lambda: _loads(bench, runs), "zeros": lambda: _channels(bench, recorded, "offset"),
            "drifts": lambda: _channels(bench, recorded, "drift"), _COGGING: lambda: _cogging(bench, runs)}
    every = [one for family in dict.fromkeys(settings.nuisances) for one in made[family]()]
    return tuple(Hypothesis(each[0].name, parameters=each) for each in every
                 if not any(p.name in settings.parameters for p in each))


def _loads(bench, runs):
    for name in locations(JOINT, bench):
        row, turns = bench.joint(name)[0], f"joints.{name}" in bench.model.turning
        weight = 0.0 if turns or not row.any() else _GRAVITY * felt_mass(bench, row)
        size = max(typical(JOINT, bench, name, runs).force, weight)
        if size > 0:
            yield (_about(bench, f"loads.{name}", "N m" if turns else "N", size),)


def _channels(bench, recorded, what):
    """A zero may be off by what a channel shows, and drift by as much over the longest run."""
    longest, shown, units = max(record.run.duration for record in recorded), {}, {}
    for record in recorded:
        for channel, unit, samples, valid in zip(record.channels, record.unit, record.samples,
                                                 np.broadcast_to(record.valid, record.samples.shape), strict=True):
            size = float(np.sqrt(np.mean(np.square(samples[valid])))) if valid.any() else 0.0
            shown[channel], units[channel] = max(size, shown.get(channel, 0.0)), unit
    for channel, size in shown.items():
        if size > 0 and channel in {c.name for c in bench.channels}:
            each, per = (size, "") if what == "offset" else (size / longest, "/s")
            yield (_about(bench, f"channels.{channel}.{what}", f"{units[channel]}{per}", each),)


def _cogging(bench, runs):
    places = [place for effect, place in (bench.stated.pairs if bench.stated else ()) if effect == _COGGING]
    if not places:
        raise ConfigError("diagnosis.nuisances: cogging", "effects.cogging with the period of a joint", "none",
                          "state it with amplitudes of 0: effects: {cogging: {JOINT: {period: 15 deg, sine: 0 N,"
                          " cosine: 0 N}}}; a turning joint counts at a radius of 1 m")
    for place in places:
        size = 0.1 * typical(JOINT, bench, place, runs).force
        yield tuple(_about(bench, f"{_COGGING}@{place}.{what}", "N", size) for what in ("sine", "cosine"))


def _about(bench, name, unit, size):
    """Parameter about the value that the bench has, which is its null."""
    value = corrections.nominal(bench, name)
    return Parameter(name, unit, value, Normal(value, size), null=value)
