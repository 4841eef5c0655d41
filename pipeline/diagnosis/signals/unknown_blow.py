"""Blows of a hammer whose force was not recorded: size and time of one pulse a run, fitted with everything else.

Before the blow the rig is at rest. The pulse of the input has the impulse J and the time t of the blow, in the three
samples about it the weights of a quadratic B-spline,

    F_(k-1), F_k, F_(k+1) = J f ((1/2 - u)^2 / 2, 3/4 - u^2, (1/2 + u)^2 / 2),     u = f t - k in -1/2 to 1/2,

f the sample rate. Wherever the blow lies between samples, the pulse has one shape, of variance 5/12 intervals^2 with
the straight lines between samples: a rig of n samples a period answers by the factor ``answered`` less, 2 % at 20. The
estimate that fits begin from is the pulse that explains most of the period behind it and leaves least before it.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import ConfigError
from pipeline.diagnosis.problem import parameter_name
from pipeline.inference.priors import Normal, Parameter

#: owner of the parameters, and what they are
BLOW, _IMPULSE, _TIME = "blow", "impulse on", "time of the blow on"
#: samples by which a pulse lies off the ends of its run
_MARGIN = 2
#: part of a run before which the blow must have begun to ring: held-out runs tell it there
_EARLY = 0.25
#: standard deviation of the time of a blow, over the slowest period
_UNSURE = 0.1


@dataclass(frozen=True)
class Blow:
    """Estimate of a blow on ``input``: ``impulse`` N s at ``time`` s, and the standard deviation of its time, s."""

    input: str
    impulse: float
    time: float
    unsure: float

    @property
    def strength(self):
        """The size of the motion."""
        return abs(self.impulse)

    def parameters(self, bench, run, remembers):
        """Parameters of a Run about the estimate: the impulse may have either sign and another size."""
        return (Parameter(_name(run.name, _IMPULSE, self.input), "N s", self.impulse,
                          Normal(self.impulse, abs(self.impulse)), run=run.name),
                Parameter(_name(run.name, _TIME, self.input), "s", self.time, Normal(self.time, self.unsure),
                          run=run.name))


def struck(run, values, instead=None):
    """The Run with the blows that ``values`` {name: value} hold for it on top of its inputs, ``instead`` of others."""
    for name in run_blows(run.name, values):
        force, before = (0.0 if given is None else pulse(run, *(given[_name(run.name, part, name)]
                                                                for part in (_IMPULSE, _TIME)))
                         for given in (values, instead))
        run = replace(run, inputs={**run.inputs, name: run.inputs.get(name, 0.0) + force - before})
    return run


def run_blows(run, values):
    """[input] of the blows that ``values`` {name: value} hold for the run of this name."""
    begin = _name(run, _IMPULSE, "")
    return [name.removeprefix(begin) for name in values if name.startswith(begin)]


def pulse(run, impulse, time):
    """Force (samples,) in N of an impulse in N s at ``time`` s of a Run, two samples off its ends at least."""
    force = np.zeros(run.samples)
    at = min(max(time * run.sample_rate, _MARGIN), run.samples - 1.0 - _MARGIN)
    k = round(at)
    u = at - k
    force[k - 1:k + 2] = impulse * run.sample_rate * np.array([(0.5 - u) ** 2 / 2, 0.75 - u**2, (0.5 + u) ** 2 / 2])
    return force


def answered(samples):
    """Answer of a vibration of ``samples`` a period to a pulse, over that to a blow of no length."""
    return float(np.sinc(1 / samples) ** 2 * (0.75 + 0.25 * np.cos(2 * np.pi / samples)))


def with_blow(bench, recorded, name, period, shown):
    """The Recorded run with its unknown Blow on the input ``name``, at its estimate.

    ``shown(run)`` (c, n): what the channels show of a Run.

    ``period``: number of samples of the slowest one. ConfigError where the input does not take a force, and where
    nothing is struck early enough.
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
    early = {_name(run.name, _IMPULSE, name): 1.0, _name(run.name, _TIME, name): _MARGIN / run.sample_rate}
    answer = np.roll(shown(struck(run, early)) - still, -_MARGIN, axis=1)         # as of a pulse at sample 0
    last = int(_EARLY * run.samples) - period // 2
    scores = [_score(left, weight, answer, k, period) for k in range(max(last, 0))]
    if not scores or not max(scores)[0] > 0:
        raise ConfigError(where, f"a blow within the first {max(last, 0) / run.sample_rate:.3g} s, at rest before it",
                          "none", "let the run begin shortly before the blow, and end several periods after it")
    k = int(np.argmax([score for score, _ in scores]))
    found = Blow(name, scores[k][1], k / run.sample_rate, _UNSURE * period / run.sample_rate)
    estimate = {p.name: p.nominal for p in found.parameters(bench, run, False)}
    return replace(recorded, run=struck(run, estimate), unknown=found)


def _score(left, weight, answer, k, period):
    """(What a pulse at sample ``k`` explains of the ``period`` behind it less what is before it, its impulse)."""
    behind, expected = left[:, k:k + period], weight[:, k:k + period] * answer[:, :period]
    size = np.sum(expected**2)
    overlap = np.sum(behind * expected)
    return (overlap**2 / size - np.sum(left[:, :k] ** 2), overlap / size) if size > 0 else (-np.inf, 0.0)


def _name(run, part, name):
    return parameter_name(BLOW, run, f"{part} {name}")
