"""Stage transient: motion of the sliding model with unilateral contact and dry friction."""

from functools import partial
from typing import Literal

import numpy as np

from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.laws import Laws
from pipeline.case_models.virtual_rig import about
from pipeline.contract import ConfigError, Context, Quantities, Quantity, option, stage
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.signals.limit_cycle import cycle, harmonic_levels
from pipeline.physics.signals.spectra import power_spectrum
from pipeline.physics.time_stepping.initial_state import random_kick, steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import History, Start, simulate
from pipeline.products import Effects, ReducedModel, Transient


class Settings(Laws):
    """Contact, friction, operating points, and the recorded part of the motion."""

    speeds: Quantities("rad/s") = option(("1 rad/s",), "speeds of the drive, either sign, for each pressure")
    step: Quantity("s", gt=0) = option("1 us", "time step")
    duration: Quantity("s", gt=0) = option("0.5 s", "length of the motion")
    record_every: int = option(10, "steps between samples that are kept", ge=1)
    highest_frequency: Quantity("Hz", gt=0) = option("100 kHz", "modes with open contacts above it are left out")
    damping: Literal["full", "diagonal"] = option("full", "diagonal: what couples the modes through damping is dropped")
    start: Literal["sliding", "pressed", "rest"] = option(
        "sliding", "sliding: steady sliding; pressed: equilibrium without friction, which sets in with the drive; rest:"
        " unloaded and at rest")
    kick: Quantity("m/s", ge=0) = option("0.1 mm/s", "effective value of a random start velocity at the sensors")
    seed: int = option(1, "seed of the kick", ge=0)
    window: Quantity("s", gt=0) = option("0.1 s", "end of the motion from which spectra and cycles are taken")
    settled_within: float = option(0.02, "largest spread of the amplitude over quarters of the window", gt=0)
    lowest_frequency: Quantity("Hz", ge=0) = option("50 Hz", "dominant frequencies are sought above it")
    harmonics: int = option(8, "number of harmonics of the dominant frequency that are reported", ge=1)


def _check(sections):
    """Refuse windows longer than the motion before anything is computed."""
    settings = sections["transient"]
    if settings.window > settings.duration:
        raise ConfigError("transient.window", f"at most the duration, {settings.duration:g} s",
                          f"{settings.window:g} s")
    if settings.step * settings.record_every * 40 > settings.window:
        raise ConfigError("transient.record_every", "at least 40 samples in the window",
                          f"{settings.window / (settings.step * settings.record_every):.3g}", "keep more samples")


@stage(check=_check)
def transient(model: ReducedModel, effects: Effects | None, settings: Settings, context: Context) -> Transient:
    """Integrate the sliding model with opening contacts, sticking and sliding.

    The model is reduced to its real modes with open contacts. The linear part is integrated exactly; contact and
    friction forces are constant or linear over a step. A motion that is not steady in the window is stored and marked.

    Method:
    The equations of motion of the real modes below {highest_frequency} (contacts open, damping {damping}) were
    integrated over {duration} in steps of {step}; the linear part exactly, except with Lagrange multipliers or
    Newmark's method (rule: {rule}). Contact: {contact}; friction coefficient {friction} (none: that of the interface
    law at the static load), at rest {friction_at_rest} (none: the same); sticking: {description}. Spectra and limit
    cycles refer to the last {window}.
    """
    points = [(state, speed) for state in range(len(model.pressure)) for speed in settings.speeds]
    results = context.map(partial(_move, model, effects, settings), points, "operating points")
    motions, highest = [motion for motion, _ in results], max(frequency for _, frequency in results)
    interval = settings.step * settings.record_every
    late = motions[0].time >= motions[0].time[-1] - settings.window
    velocity = np.array([m.velocity for m in motions])
    frequency, spectrum = power_spectrum(velocity[..., late], 1 / interval, 1 / settings.window)
    _report(context, points, motions)
    if highest > 0.5 / interval:
        context.log(f"modes up to {highest:.4g} Hz move, samples tell {0.5 / interval:.4g} Hz at most: what sounds"
                    " above shows folded below; lower record_every or highest_frequency")
    return Transient(
        pressure=[model.pressure[state] for state, _ in points], speed=[speed for _, speed in points],
        time=motions[0].time, sensor_name=model.sensor_name, sensor_position=model.sensor_position,
        displacement=_kept(m.displacement - m.displacement[:, :1] for m in motions),
        velocity=velocity.astype(np.float32), gap=_kept(m.gap for m in motions),
        normal_force=_kept(m.normal_force for m in motions), friction_force=_kept(m.friction_force for m in motions),
        slip=_kept(m.slip for m in motions), status=np.array([m.status for m in motions]),
        status_share=[m.status_share for m in motions], stored_energy=[m.stored for m in motions],
        **{name: [getattr(m, name) for m in motions]
           for name in ("input_work", "damping_loss", "normal_work", "friction_work", "sliding_loss", "imbalance")},
        step=settings.step, window=settings.window, frequency=frequency, velocity_spectrum=spectrum,
        **_cycles(velocity, late, interval, settings))


def _move(model, effects, settings, task):
    """(motion, highest frequency of its modes in Hz) at one operating point: (row of the preload table, speed)."""
    state, speed = task
    bench = with_effects(about(model, settings, "transient", state, speed, settings.step), effects, channels=False)
    sliding, law, friction = bench.model, bench.law, bench.friction
    inputs = model.pressure[state] * model.input_area
    system = modal_system(sliding, settings.damping, settings.highest_frequency)
    drawn = {"sliding": friction, "pressed": constant(0.0)}.get(settings.start)
    start = None if drawn is None else steady_start(sliding, law, drawn, inputs)
    kick = random_kick(system, sliding.sensor_rows, settings.kick, settings.seed)
    motion = simulate(sliding, law, friction, step=settings.step, duration=settings.duration,
                      inputs=_history(model, model.input_history, inputs),
                      drive=_history(model, speed * model.drive_history, None),
                      record_every=settings.record_every, system=system, start=_kicked(start, kick))
    return motion, system.highest / (2 * np.pi)


def _history(model, samples, constant):
    """``constant``, or the History of ``samples`` added to it where there are any."""
    if not len(samples):
        return constant
    return History(samples if constant is None else samples + constant, float(model.history_interval))


def _kicked(start, kick):
    return Start(np.zeros_like(kick), kick) if start is None else start.kicked(kick)


def _kept(signals):
    return np.array(list(signals), dtype=np.float32)


def _cycles(velocity, late, interval, settings):
    """The table of cycles, one row an operating point, one column a sensor."""
    lowest = max(settings.lowest_frequency, 2 / settings.window)
    rows = [[cycle(signal, interval, settings.window, settings.settled_within, lowest) for signal in sensors]
            for sensors in velocity]
    harmonic = [[harmonic_levels(signal[late], 1 / interval, result.frequency, settings.harmonics) if result.frequency
                 else np.zeros(settings.harmonics) for signal, result in zip(sensors, row, strict=True)]
                for sensors, row in zip(velocity, rows, strict=True)]
    shape = velocity.shape[:2]
    named = {"cycle_frequency": "frequency", "cycle_amplitude": "amplitude", "cycle_drift": "drift",
             "settled": "settled", "growth_rate": "growth", "growth_rate_std": "growth_std", "grew": "grew"}
    table = {name: np.array([[getattr(c, field) for c in row] for row in rows]).reshape(shape)
             for name, field in named.items()}
    counts = {name: table[name].astype(int) for name in ("settled", "grew")}
    return {**table, **counts, "harmonic_amplitude": np.reshape(harmonic, (*shape, settings.harmonics))}


def _report(context, points, motions):
    """Tell where energy does not balance as it should."""
    for (state, speed), motion in zip(points, motions, strict=True):
        if motion.imbalance > 0.005:
            context.log(f"state {state + 1}, {speed:g} rad/s: energy balances only within"
                        f" {100 * motion.imbalance:.2g} %; a shorter step would help")
