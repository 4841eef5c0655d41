"""Blows of a hammer whose force was not recorded: one half-sine pulse a run, fitted with everything else.

Before the blow the rig is at rest. Impulse, time of the centre and contact time of the pulse are unknown. The contact
time decides in which ratios modes ring: a pulse of width w excites one of frequency f by the factor
cos(pi f w) / (1 - (2 f w)^2).

A tip is chosen that is hard enough for the modes of interest: the spectrum of the force may fall by 10 to 20 dB up to
the highest of them (Avitabile, Modal Testing, 2018). Hence 95 of 100 contact times of the prior are shorter than that
of the pulse that excites the fastest mode below half the sample rate to a tenth, 1.3 of its periods. Tips from steel to
soft rubber differ some fifty-fold, e^4, which holds 95 of 100 contact times about the median.

The course of the force is a half sine by convention only: while the hammer is in contact accelerations and velocities
do not count (``unseen``).

The estimate that fits begin from has the median contact time; it is the pulse that explains most of the period behind
its begin and leaves least before it. Where channels explain each other badly that way, as where one is reversed or in
other units, each counts by itself, and the hammer pushes as the input says.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import scipy

from pipeline.contract import ConfigError
from pipeline.diagnosis.problem import parameter_name
from pipeline.diagnosis.signals.unseen import without_course
from pipeline.inference.priors import LogNormal, Normal, Parameter
from pipeline.physics.virtual_rig.half_sine import SPREAD, HalfSine, spectrum

#: owner of the parameters, and what they are
BLOW, _IMPULSE, _TIME, _WIDTH = "blow", "impulse on", "time of the blow on", "contact time on"
#: part of a run before which the blow must have begun to ring: held-out runs tell it there
_EARLY = 0.25
#: what moves before a blow counts so many times what is explained behind it
_REST = 10
#: share of what channels by themselves explain that they must explain together to belong to one blow as they are
_TOGETHER = 0.5
#: standard deviation of the time of a blow, over the slowest period
_UNSURE = 0.1
#: standard deviation of the logarithm of a contact time
_SPREAD = 1.0
#: least answer of the fastest mode to a blow that was meant to excite it, over that to one of no length: 20 dB less
_LEAST = 0.1


@dataclass(frozen=True)
class Blow:
    """Estimate of a blow on ``input``: ``impulse`` N s about ``time`` s, ``width`` s long; ``unsure``: deviation of the
    time, s.
    """

    input: str
    impulse: float
    time: float
    width: float
    unsure: float

    @property
    def strength(self):
        """The size of the motion."""
        return abs(self.impulse)

    def parameters(self, bench, run, remembers):
        """Parameters of a Run about the estimate.

        The size of the impulse is logarithmic as those of masses and springs are: a motion does not tell a common
        factor of all of them.
        """
        return (Parameter(_name(run.name, _IMPULSE, self.input), "N s", self.impulse,
                          LogNormal(self.impulse, 1.0), run=run.name),
                Parameter(_name(run.name, _TIME, self.input), "s", self.time, Normal(self.time, self.unsure),
                          run=run.name),
                Parameter(_name(run.name, _WIDTH, self.input), "s", self.width, LogNormal(self.width, _SPREAD),
                          run=run.name))


def struck(run, values):
    """The Run with the blows that ``values`` {name: value} hold for it, in place of others on their inputs."""
    blows = {name: within(run, *(values[_name(run.name, part, name)] for part in (_IMPULSE, _TIME, _WIDTH)))
             for name in run_blows(run.name, values)}
    return replace(run, pulses={**run.pulses, **blows}) if blows else run


def run_blows(run, values):
    """[input] of the blows that ``values`` {name: value} hold for the run of this name."""
    begin = _name(run, _IMPULSE, "")
    return [name.removeprefix(begin) for name in values if name.startswith(begin)]


def within(run, impulse, time, width):
    """HalfSine of an impulse in N s about ``time`` s, ``width`` s long, moved and cut so that it lies within a Run."""
    width = min(width, max(run.duration - 2 * SPREAD / run.sample_rate, np.finfo(float).tiny))
    margin = _margin(run, width)
    return HalfSine(impulse, min(max(time, margin), run.duration - margin), width)


def _margin(run, width):
    """Least time in s between the ends of a Run and the centre of a pulse whose samples lie within it."""
    return width / 2 + SPREAD / run.sample_rate


def with_blow(bench, recorded, name, period, fastest, shown):
    """The Recorded run with its unknown Blow on the input ``name``, at its estimate.

    ``shown(run)`` (c, n): what the channels show of a Run.

    ``period``: number of samples of the slowest one; ``fastest``: highest natural frequency in Hz. ConfigError where
    the input does not take a force, and where nothing is struck early enough.
    """
    run, where = recorded.run, f"run {recorded.run.name}: blow"
    if name not in bench.model.input_name or name in bench.model.moved_ends or name in run.held:
        forces = [n for n in bench.model.input_name if n not in bench.model.moved_ends and n not in run.held]
        raise ConfigError("bench.blow", f"an input that is a force, without hold: step: one of {', '.join(forces)}",
                          repr(name))
    scale = np.sqrt(np.mean(np.where(recorded.valid, recorded.samples, 0.0) ** 2, axis=1))
    weight = recorded.valid / np.where(scale > 0, scale, np.inf)[:, None]
    still = shown(run)
    left = weight * (np.where(recorded.valid, recorded.samples, 0.0) - still)
    width = _cycles() / fastest
    first = _margin(run, width)
    blow = Blow(name, 1.0, first, width, _UNSURE * period / run.sample_rate)
    answer = shown(_hit(bench, run, blow)) - still
    last = int(_EARLY * run.samples - first * run.sample_rate) - period // 2
    scores = np.array([_scores(left, weight, answer, k, period) for k in range(max(last, 0))]).reshape(-1, 4)
    best = scores[:, :2].max(axis=0, initial=0.0)
    if not best[1] > 0:
        latest = max(last / run.sample_rate + first, 0)
        raise ConfigError(where, f"a blow within the first {latest:.3g} s, at rest before it", "none",
                          "let the run begin shortly before the blow, and end several periods after it")
    alone = int(best[0] < _TOGETHER * best[1])
    k = int(np.argmax(scores[:, alone]))
    blow = replace(blow, impulse=scores[k, 2 + alone], time=k / run.sample_rate + first)
    seen = without_course(bench, recorded, blow.time - blow.width / 2, blow.width)
    return replace(seen, run=_hit(bench, run, blow), unknown=blow)


def _hit(bench, run, blow):
    return struck(run, {p.name: p.nominal for p in blow.parameters(bench, run, False)})


def _scores(left, weight, answer, k, period):
    """What a pulse at sample ``k`` explains of the ``period`` behind it, less what is before it, by all channels
    together and by each by itself; its impulse by both.

    At rest there is nothing before it, while behind it a nominal model of another frequency explains half a period
    later as much, upside down.
    """
    behind, expected = left[:, k:k + period], weight[:, k:k + period] * answer[:, :period]
    size, overlap = np.sum(expected**2, axis=1), np.sum(behind * expected, axis=1)
    if not size.sum() > 0:
        return -np.inf, -np.inf, 0.0, 0.0
    alone = np.sum(overlap**2 / np.where(size > 0, size, np.inf))
    before = _REST * np.sum(left[:, :k]**2)
    return (overlap.sum()**2 / size.sum() - before, alone - before, overlap.sum() / size.sum(),
            abs(overlap).sum() / size.sum())


def _name(run, part, name):
    return parameter_name(BLOW, run, f"{part} {name}")


@cache
def _cycles():
    """Periods of the fastest mode in the median contact time: 95 % of contact times excite that mode."""
    longest = scipy.optimize.brentq(lambda cycles: spectrum(cycles) - _LEAST, 0.0, 1.5)
    return longest * np.exp(-_SPREAD * scipy.special.ndtri(0.95))
