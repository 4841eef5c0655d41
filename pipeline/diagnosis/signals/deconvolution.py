"""From residuals of a run back to the force along a row that would explain them, and to the motion there.

With H_c(w) the receptance of channel c from the row (small motions of the model), the residuals r give

    F = (sum_c |H_c|^2 / s_c^2)^-1 sum_c H_c* r_c / s_c^2

up to the highest frequency w whose residual rises above the noise s. Where channels hardly show a force, as
accelerations do not a slow one, that would be noise divided by next to nothing: what a force of the mean power of those
that are seen would show there counts against the noise (Wiener's filter). The motion along the row is that of the model
plus its answer to F.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract import BrakechainError
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import linearised
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, VELOCITY, Sensor

#: name of what is added to a bench: an input, or a sensor
EXTRA = "latent"
#: share of a run that fades in and out before it is transformed
FADE = 0.05
#: neighbouring frequencies over which power is averaged before it is compared with that of the noise
NEIGHBOURS = 15
#: samples of the cubic that gives the velocity of a measured displacement
_SMOOTHING = 7


@dataclass(frozen=True)
class Deconvolved:
    """Per sample (n,): ``force`` N on the row, ``displacement`` m, ``velocity`` m/s; ``highest`` frequency in Hz."""

    force: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    highest: float


def deconvolved(bench, row, run, observed, noise, above_noise=DEFAULTS.latent_force.above_noise):
    """Deconvolved of one run along a row (n,); None where no frequency rises above the noise or nothing is linear."""
    residual = np.where(observed.valid, observed.samples - shown(bench, run, observed.channels), 0.0)
    count = residual.shape[1]
    frequency = np.fft.rfftfreq(count, 1 / run.sample_rate)
    try:
        direct, transfer = receptances(bench, run, row, observed.channels, frequency)
    except BrakechainError:
        return None
    fade = scipy.signal.windows.tukey(count, 2 * FADE)
    spectrum, precision = np.fft.rfft(residual * fade, axis=1), 1 / noise.std[:, None] ** 2
    gain = np.sum(np.abs(transfer) ** 2 * precision, axis=0)
    seen, noise_power = np.sum(transfer.conj() * spectrum * precision, axis=0), np.sum(fade**2)
    power = np.abs(seen) ** 2 / np.maximum(gain, 1e-300) / noise_power
    width = min(NEIGHBOURS, len(power))
    loud = np.flatnonzero(np.convolve(power, np.ones(width) / width, "same") > above_noise)
    if not len(loud):
        return None
    force = seen / (gain + np.sum(gain[loud]) / np.sum(power[loud]))
    force[loud[-1] + 1:] = 0.0
    x, v = moved(bench, run, row)
    moves = direct * force
    return Deconvolved(np.fft.irfft(force, count), x + np.fft.irfft(moves, count),
                       v + np.fft.irfft(2j * np.pi * frequency * moves, count),
                       float(frequency[max(loud[-1], 1)]))


def motion(bench, row, run, observed, noise):
    """Displacement and velocity (n,) along a row (n,) in a recorded run: by what is known best of three.

    Displacement channels that span the row (velocity by a Savitzky-Golay filter), else the model corrected by
    ``deconvolved``, else the model.
    """
    known = {c.name: c for c in bench.channels}
    seen = [k for k, name in enumerate(observed.channels) if known[name].measurand == DISPLACEMENT]
    rows = np.array([bench.sensor(known[observed.channels[k]].source) for k in seen]).reshape(-1, bench.model.size)
    weight = np.linalg.lstsq(rows.T, row, rcond=None)[0] if seen else np.zeros(0)
    if seen and np.allclose(weight @ rows, row, atol=1e-6 * np.abs(row).max()) and observed.valid[seen].all():
        gain = np.array([known[observed.channels[k]].gain for k in seen])
        x = weight @ (observed.samples[seen] / gain[:, None])
        return x, _rate(x, 1 / run.sample_rate)
    corrected = deconvolved(bench, row, run, observed, noise)
    return moved(bench, run, row) if corrected is None else (corrected.displacement, corrected.velocity)


def _rate(x, step):
    """Slope (n,) of samples (n,): by cubics over a few of them, of fewer by differences."""
    if len(x) < _SMOOTHING:
        return np.gradient(x, step) if len(x) > 1 else np.zeros(len(x))
    return scipy.signal.savgol_filter(x, _SMOOTHING, 3, deriv=1, delta=step)


def moved(bench, run, row):
    """Displacement and velocity (samples,) along a row (n,) in a simulated run."""
    model = replace(bench.model, sensor_name=(EXTRA,), sensor_rows=np.atleast_2d(row))
    channels = (Sensor("x", DISPLACEMENT, EXTRA), Sensor("v", VELOCITY, EXTRA))
    shown_by = respond(replace(bench, model=model, channels=channels), run)
    return shown_by["x"], shown_by["v"]


def receptances(bench, run, row, channels, frequency):
    """Receptance (f,) of a row (n,) from itself, and (c, f) of channels from it; 0 for forces in contacts."""
    mass, damping, stiffness = linearised(bench, run)
    known, shown = {c.name: c for c in bench.channels}, np.zeros((len(channels), len(frequency)), complex)
    omega = 2 * np.pi * np.maximum(frequency, 1e-3 * frequency[1])
    dynamic = stiffness + 1j * omega[:, None, None] * damping - omega[:, None, None] ** 2 * mass
    moves = np.linalg.solve(dynamic, np.broadcast_to(row[:, None], (len(omega), len(row), 1)))[:, :, 0].T
    for k, name in enumerate(channels):
        shown[k] = known[name].response(bench, moves, 1j * omega)
    return row @ moves, shown
