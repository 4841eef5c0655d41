"""Stage motion_scatter: one motion with several formulations, steps and seeds, because it may be chaotic."""

from functools import partial
from itertools import product as combinations
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.signals.bursts import bursts, harmonic_lines
from pipeline.physics.signals.spectra import power_spectrum
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.time_stepping.initial_state import random_kick, steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import Forward, Hard, Lagrange, simulate
from pipeline.products import MotionScatter, ReducedModel

#: multiples of the fundamental that are told
_ORDERS = 4


class Settings(Section):
    """Runs and their evaluation."""

    formulations: tuple[Literal["hard", "forward", "lagrange"], ...] = option(
        ("hard", "forward"), "hard: impulses on velocities (Moreau-Jean); forward: multipliers on displacements a step"
        " ahead, as explicit codes set them; both with exact linear part; lagrange: multipliers under Newmark's rule",
        min_length=1)
    steps: Quantities("s", gt=0) = option(("1 us", "2 us"), "time steps")
    seeds: tuple[int, ...] = option((1, 2, 3), "seeds of the random start velocity", min_length=1)
    gamma: float = option(0.5, "lagrange: Newmark's gamma; 0.5 trapezoidal, more damps the highest modes", ge=0.5, le=1)
    friction: float = option(0.2, "coefficient of friction", ge=0)
    speed: Quantity("rad/s") = option("-0.002 rad/s", "speed of the drive, either sign")
    highest_frequency: Quantity("Hz", gt=0) = option("60 kHz", "modes with open contacts above it are left out")
    kick: Quantity("m/s", ge=0) = option("0.1 mm/s", "effective value of the start velocity at the sensors")
    duration: Quantity("s", gt=0) = option("0.5 s", "length of each motion")
    settling: Quantity("s", ge=0) = option("0.1 s", "begin of the motion that is not judged")
    sampling: Quantity("s", gt=0) = option("10 us", "time between samples that are kept")
    resolution: Quantity("Hz", gt=0) = option("20 Hz", "distance of the lines of the spectra")
    lowest_frequency: Quantity("Hz", ge=0) = option("50 Hz", "lines are sought above it")
    low_band: Quantities("Hz", gt=0) = option(("250 Hz", "650 Hz"), "band whose highest line is told beside the"
                                                  " strongest")
    frame: Quantity("s", gt=0) = option("2 ms", "frame in which vibration is told from rest")
    threshold: float = option(0.3, "a frame vibrates above this share of the largest effective value", gt=0, lt=1)


def _check(sections):
    """Refuse motions shorter than their settling time, and empty frequency bands."""
    settings = sections["motion_scatter"]
    if settings.settling + 8 * settings.frame > settings.duration:
        raise ConfigError("motion_scatter.duration", f"at least {settings.settling + 8 * settings.frame:g} s, settling"
                          " and"
                          " eight frames", f"{settings.duration:g} s")
    if len(settings.low_band) != 2 or settings.low_band[0] >= settings.low_band[1]:
        raise ConfigError("motion_scatter.low_band", "two rising frequencies", str(settings.low_band))


@stage(check=_check)
def motion_scatter(model: ReducedModel, settings: Settings, context: Context) -> MotionScatter:
    """Repeat the motion over formulations, steps and seeds, and report what is reproducible.

    The waveform of a chaotic motion depends on rounding; its spectral lines, peaks and contact status fractions scatter
    about reproducible values. Evaluated are the first sensor and the first contact.

    Method:
    From steady sliding with a random initial velocity, the motion was integrated over {duration} for each of
    {formulations}, the steps {steps} and the seeds {seeds}, with friction coefficient {friction}. Reported are ranges
    over these runs after {settling}; forces are averaged over {sampling}.
    """
    runs = list(combinations(settings.formulations, settings.steps, settings.seeds))
    rows = context.map(partial(_run, model, settings), runs, "motions")
    return MotionScatter(
        formulation=[r[0] for r in runs], step=[r[1] for r in runs], seed=[r[2] for r in runs],
        duration=settings.duration - settings.settling, friction=settings.friction, speed=settings.speed,
        **{name: np.array([row[name] for row in rows]) for name in rows[0]})


def _run(model, settings, task):
    """Everything that is told of one motion."""
    formulation, step, seed = task
    sliding = sliding_model(model, 0, settings.speed)
    law = {"hard": Hard(), "forward": Forward(), "lagrange": Lagrange(settings.gamma)}[formulation]
    friction, inputs = constant(settings.friction), model.pressure[0] * model.input_area
    system = modal_system(sliding, highest=settings.highest_frequency)
    every = max(1, round(settings.sampling / step))
    start = steady_start(sliding, law, friction, inputs)
    kick = random_kick(system, sliding.sensor_rows, settings.kick, seed)
    motion = simulate(sliding, law, friction, step=step, duration=settings.duration, inputs=inputs,
                      record_every=every, system=system, start=start.kicked(kick))
    return _judged(motion, step * every, settings)


def _judged(motion, interval, settings):
    late = motion.time >= settings.settling
    velocity, status = motion.velocity[0, late], motion.status[0, late]
    fundamental, level, height = harmonic_lines(velocity, interval, settings.resolution, settings.lowest_frequency,
                                                _ORDERS)
    events = bursts(velocity, interval, settings.frame, settings.threshold)
    return {
        "fundamental": fundamental, "harmonic_level": np.maximum(level, -200.0), "harmonic_height": height,
        "low_level": _low_level(velocity, interval, fundamental, settings),
        "peak_force": motion.normal_force[0, late].max(), "peak_slip": abs(motion.slip[0, late]).max(),
        "peak_velocity": abs(velocity).max(), "status_share": [np.mean(status == kind) for kind in range(3)],
        "vibrating_share": events.share, "burst_length": events.burst, "pause_length": events.pause,
        "imbalance": motion.imbalance}


def _low_level(velocity, interval, fundamental, settings):
    """Highest line in the low band over the strongest line, dB; 0 where that is itself in the band."""
    frequency, density = power_spectrum(velocity, 1 / interval, settings.resolution)
    low, high = settings.low_band
    band, above = (frequency >= low) & (frequency <= high), frequency >= settings.lowest_frequency
    return 10 * np.log10(max(density[band].max(), np.finfo(float).tiny) / density[above].max())
