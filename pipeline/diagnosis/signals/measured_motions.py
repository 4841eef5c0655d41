"""Runs predicted along their measured motions: the equation of motion, solved once for what channels show.

With the linear part L of the nominal model, the measured motion x and all other forces F of a hypothesis,

    L q = f - F(x, x', history),    what channels show of q

so that the prediction is linear in every coefficient that the forces are linear in, however large they are, and its
error is that of the channels, not that of a second derivative (series-parallel model: K. S. Narendra & K.
Parthasarathy, IEEE Trans. Neural Networks 1 (1990) 4).

The motion is that of a simulated model, corrected by what its residual holds above the noise (Wiener's filter), which
is integrated where channels show velocities or accelerations.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.diagnosis.signals.forward_model import completed, shown
from pipeline.diagnosis.signals.start_states import begun
from pipeline.inference.problem import Problem
from pipeline.physics.virtual_rig.force_residual import forces_missing, moving
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor

#: names of the inputs along the coordinates
_ALONG = "force along coordinate {}"
#: share of its largest size at which the logarithm of a force ends
_FAINT = 1e-3
#: neighbouring frequencies over which the density of a residual is averaged before noise is taken off
_NEIGHBOURS = 45
#: samples of the line that tells where a residual begins and ends
_FIRST = 24
#: density over that of noise up to whose highest frequency a residual counts
_LOUD = 4.0
#: smallest share of the largest singular value at which rows of channels give all coordinates
_SMALLEST_SHARE = 1e-9


@dataclass(frozen=True)
class AlongMotions:
    """Picklable prediction along ``motions`` {run: (n, samples)} of the coordinates; ``runs`` {name: Run}."""

    bench: object
    runs: dict
    motions: dict

    def __call__(self, hypothesis, values, run):
        bench = completed(self.bench, hypothesis, values)
        begins = begun(self._run(run), hypothesis, values)
        return self._shown(bench, begins, run, self._forces(bench, run))

    def law_errors(self, hypothesis, values, run, effects):
        """[(c, n)] what channels show of ``shapes`` of the force of ``effects`` ((name, place), ...)."""
        others = tuple(pair for pair in hypothesis.effects if pair not in effects)
        force = self._forces(completed(self.bench, hypothesis, values), run) - self._forces(
            completed(self.bench, replace(hypothesis, effects=others), values), run)
        still = replace(self._run(run), inputs={}, conditions={}, start=None)
        motion = self.motions[run.name][:, :run.samples.shape[1]]
        return [self._shown(self.bench, still, run, each) for each in shapes(force, motion)]

    def _run(self, run):
        return self.runs[run.name].until(run.samples.shape[1])

    def _forces(self, bench, run):
        """Forces (n, samples) along the motion of a run that the linear part of the nominal model does not hold."""
        motion, linear = self.motions[run.name][:, :run.samples.shape[1]], self._linear
        if bench.model.size != linear.model.size:
            raise ConfigError("measured motions", f"an effect within the {linear.model.size} measured coordinates",
                              f"{bench.model.size} coordinates")
        motion = moving(motion, 1 / self._run(run).sample_rate)
        return forces_missing(linear, self._run(run), motion) - forces_missing(bench, self._run(run), motion)

    @property
    def _linear(self):
        return replace(self.bench, model=replace(self.bench.model, elements=()))

    def _shown(self, bench, begins, run, force):
        """(c, n) what channels, as ``bench`` reads them, show of the linear part under further ``force`` (n, n)."""
        linear = self._linear
        rows = np.vstack((linear.model.input_rows.reshape(-1, linear.model.size), np.eye(linear.model.size)))
        names = tuple(_ALONG.format(k) for k in range(linear.model.size))
        model = replace(linear.model, input_name=(*linear.model.input_name, *names), input_rows=rows)
        pushed = replace(begins, inputs={**begins.inputs, **dict(zip(names, force, strict=True))})
        return shown(replace(linear, model=model, channels=bench.channels), pushed, run.channels)


@dataclass(frozen=True)
class MeasuredMotions:
    """Motions of {name: Run} ``runs`` of a Bench whose channels show all coordinates, under {run: Noise} ``budget``."""

    bench: object
    runs: dict
    budget: dict

    def along(self, null):
        """The Problem of the fitted runs along the motions that the Fit ``null`` shows, corrected by what was measured.
        """
        bench = completed(self.bench, null.hypothesis, null.values)
        runs = {run.name: self.runs[run.name].until(run.samples.shape[1]) for run in null.runs}
        motions = {run.name: motion(bench, begun(runs[run.name], null.hypothesis, null.values), run,
                                    self.budget[run.name]) for run in null.runs}
        return Problem(null.runs, AlongMotions(self.bench, runs, motions), null.hypothesis)


def measured(bench, channels):
    """Whether motions of all coordinates of a Bench without contacts are measured by its ``channels`` (names)."""
    rows = _rows(bench, channels)[0]
    share = np.linalg.svd(rows, compute_uv=False) if len(rows) else np.zeros(0)
    return not len(bench.model.contacts.area) and len(rows) >= bench.model.size and bool(
        share[-1] > _SMALLEST_SHARE * share[0])


def motion(bench, run, observed, noise):
    """Displacements (n, samples) of the coordinates: those of the model, corrected by what its residual holds."""
    rows, order, seen = _rows(bench, observed.channels)
    model = replace(bench.model, sensor_name=tuple(map(str, range(bench.model.size))),
                    sensor_rows=np.eye(bench.model.size))
    names = model.sensor_name
    sensors = tuple(Sensor(name, DISPLACEMENT, name) for name in names)
    simulated = shown(replace(bench, model=model, channels=sensors), run, names)
    residual = np.where(observed.valid, observed.samples - shown(bench, run, observed.channels), 0.0)[seen]
    gain = np.array([c.gain for c in _moving(bench, observed.channels)])
    corrected = np.array([_corrected(r / g, s / abs(g), o, run.sample_rate) for r, g, s, o in zip(
        residual, gain, noise.std[seen], order, strict=True)])
    return simulated + np.linalg.pinv(rows) @ corrected


def shapes(force, motion):
    """[(n, samples)] a ``force`` (n, samples) along a ``motion`` times shapes that tell other laws of its kind from it.

    The logarithm of its size (another exponent), its sign (other values either way), and the size and the direction of
    the displacement and of the speed along it.
    """
    direction = np.linalg.svd(force, full_matrices=False)[0][:, 0]
    x, f = direction @ motion, direction @ force
    v = np.gradient(x)
    relative = np.abs(f) / max(np.abs(f).max(), 1e-300)
    factors = [np.log(np.maximum(relative, _FAINT)), np.sign(f)]
    factors += [shape(q) / max(np.abs(q).max(), 1e-300) for q in (x, v) for shape in (np.abs, np.asarray)]
    return [force * factor for factor in factors]


def _corrected(residual, std, order, rate):
    """Displacement (samples,) that a residual of a derivative of this ``order`` holds above white noise of ``std``.

    Wiener's filter on the residual continued to both sides, point by point mirrored about its ends.
    """
    count = len(residual)
    first, last = _end(residual), _end(residual[::-1])
    whole = np.concatenate((2 * first - residual[:0:-1], residual, 2 * last - residual[-2::-1]))
    spectrum, frequency = np.fft.rfft(whole), np.fft.rfftfreq(len(whole), 1 / rate)
    power = scipy.ndimage.uniform_filter1d(np.abs(spectrum) ** 2, _NEIGHBOURS)
    noise = len(whole) * std**2
    spectrum *= np.maximum(1 - noise / np.maximum(power, 1e-300), 0.0)
    spectrum[np.max(np.flatnonzero(power > _LOUD * noise), initial=-1) + 1:] = 0.0
    if order:
        spectrum[0] = 0.0
        spectrum[1:] /= (2j * np.pi * frequency[1:]) ** order
    return np.fft.irfft(spectrum, len(whole))[count - 1:2 * count - 1]


def _end(series):
    """Where a series begins: the straight line through its first few samples."""
    few = series[:_FIRST]
    return np.polynomial.polynomial.polyfit(np.arange(len(few)), few, 1)[0]


def _rows(bench, channels):
    """(rows (k, n), order of derivative (k,), index among ``channels`` (k,)) of the channels that show a motion."""
    moving = _moving(bench, channels)
    rows = np.array([bench.sensor(c.source) for c in moving]).reshape(-1, bench.model.size)
    return rows, [c.measurand.order for c in moving], [list(channels).index(c.name) for c in moving]


def _moving(bench, channels):
    return [c for c in bench.channels if c.name in channels and c.moves]
