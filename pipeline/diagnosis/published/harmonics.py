"""Harmonics of a squeal: which mechanism of a sliding contact makes them, by transients with each one switched off.

A contact that neither opens nor reverses its slip is linear: small motion grows as one line, that of its fastest
growing mode, and this is the nominal model. Either mechanism is switched off by the operating point, with the linear
part as it is: a much larger load keeps the contact closed, a much faster drive keeps the slip from reversing. The
equations scale, so that either mechanism alone gives an amplitude in proportion to what switches it: loss of contact to
the load, stick and reversal to the speed.
"""

from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

import numpy as np
import scipy

from pipeline.case_models.laws import Laws
from pipeline.case_models.virtual_rig import about
from pipeline.contract import BrakechainError, ConfigError, Quantity, Section, option
from pipeline.diagnosis.published.frequency_lists import Alternative, Features, lines_of, list_problem
from pipeline.diagnosis.rules import DEFAULTS
from pipeline.effects import named
from pipeline.effects.effect import Term, compose
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.signals.limit_cycle import cycle, harmonic_levels
from pipeline.physics.time_stepping.initial_state import random_kick, steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import simulate

#: name of the recorded list of the base frequency
BASE = "base"
#: rise of friction at rest over that in sliding, and decay as a share of the sliding speed, of the falling alternative
_FALLING = (0.2, 1.0)
#: steps between samples that are kept
_EVERY = 5
#: standard deviations of what another record would show: levels in dB, share of time, logarithm of amplitudes (1 dB)
_LEVEL_STD, _SHARE_STD, _RATIO_STD = 3.0, 0.05, 0.115


class Spectrum(Section):
    """A recorded spectrum and the sensor of the model that shows it."""

    list: str = option(..., "list of lines in the recorded run")
    range: float = option(60.0, "lines within so many dB of the base are seen; an inferred number where none is given",
                          gt=0)
    quantity: Literal["velocity", "acceleration"] = option("velocity", "what the range refers to")


class Published(Section):
    """A computation of others: its step, window and band, whose share in its result is told."""

    run: str = option(..., "run with its line")
    list: str = option(..., "list with its line")
    step: Quantity("s", gt=0) = option(..., "time step of the trapezoidal rule")
    window: Quantity("s", gt=0) = option(..., "length of its motion")
    band: Quantity("Hz", gt=0) = option(..., "end of its spectra")


class Harmonics(Laws):
    """Base and multiples of a squeal against transients with mechanisms switched off."""

    kind: Literal["harmonics"] = "harmonics"
    run: str = option(..., "recorded run")
    spectra: dict[str, Spectrum] = option(..., "spectra by the sensor of the model", min_length=1)
    published: Published | None = option(None, "a computation of others that is judged with it")
    lines: int = option(5, "base and multiples that are compared", ge=2)
    speed: Quantity("rad/s", gt=0) = option("1 rad/s", "speed of the drive")
    step: Quantity("s", gt=0) = option("1 us", "time step")
    duration: Quantity("s", gt=0) = option("0.2 s", "length of the motion")
    window: Quantity("s", gt=0) = option("0.1 s", "end of the motion from which lines are taken")
    kick: Quantity("m/s", ge=0) = option("0.1 mm/s", "effective value of a random start velocity at the sensors")
    seed: int = option(1, "seed of the kick", ge=0)
    lowest_frequency: Quantity("Hz", gt=0) = option("200 Hz", "dominant frequencies are sought above it")
    highest_frequency: Quantity("Hz", gt=0) = option("100 kHz", "modes with open contacts above it are left out")
    closing_load: float = option(30.0, "factor on the load that keeps the contact closed", gt=1)
    one_way_speed: float = option(1000.0, "factor on the speed that keeps the slip from reversing", gt=1)


@dataclass(frozen=True)
class Variant:
    """A motion: may the contact open, may the slip reverse, does friction fall; ``as_published`` in step and window.

    ``load`` and ``speed`` are factors on those of the record.
    """

    name: str
    opens: bool = True
    reverses: bool = True
    falls: bool = False
    as_published: bool = False
    load: float = 1.0
    speed: float = 1.0


@dataclass(frozen=True)
class Shown:
    """What a motion shows: ``base`` Hz, ``levels`` {sensor: (k,) dB re its base}, shares of steps open and sticking.

    ``amplitude`` {sensor: m/s} of the base.
    """

    variant: Variant
    base: float
    levels: dict
    amplitude: dict
    open_share: float
    stick_share: float


#: each mechanism, both, and a friction that falls with the slip speed where the contact cannot open
MECHANISMS = (Variant("loss_of_contact", reverses=False), Variant("stick", opens=False),
              Variant("loss_of_contact_and_stick"), Variant("falling_friction", opens=False, falls=True))

#: mechanisms whose amplitudes are in proportion to the load or the speed, and independent of the other
_SCALING = {"loss_of_contact": "load", "stick": "speed"}


def shown(model, section, fan_out=map):
    """{name: Shown} of all variants of a product ReducedModel under a section Harmonics."""
    missing = set(section.spectra) - {str(n) for n in model.sensor_name}
    if missing:
        raise ConfigError("diagnosis.lines.spectra", f"sensors among {', '.join(map(str, model.sensor_name))}",
                          ", ".join(sorted(missing)))
    variants = (*MECHANISMS, *([Variant("published", as_published=True)] if section.published else []))
    return {motion.variant.name: motion for motion in fan_out(partial(_move, model, section), variants)}


def _move(model, section, variant):
    laws, step, duration, every = section, section.step, section.duration, _EVERY
    if variant.as_published:
        laws, step, duration, every = section.model_copy(update={"rule": "newmark"}), section.published.step, \
            section.published.window, 1
    bench = about(model, laws, "diagnosis.lines", 0, section.speed, step)
    if variant.falls:
        rise, share = _FALLING
        decay = share * section.speed * float(np.mean(model.contact_lever))
        bench = compose(bench, [Term(named("falling_friction"), "contact", {"rise": rise, "decay_speed": decay})])
    drive = section.speed * variant.speed * (1.0 if variant.reverses else section.one_way_speed)
    inputs = model.pressure[0] * model.input_area * variant.load * (1.0 if variant.opens else section.closing_load)
    system = modal_system(bench.model, "diagonal" if variant.as_published else "full", section.highest_frequency)
    start = steady_start(bench.model, bench.law, constant(0.0) if variant.as_published else bench.friction, inputs)
    kick = random_kick(system, bench.model.sensor_rows, 0.0 if variant.as_published else section.kick, section.seed)
    motion = simulate(bench.model, bench.law, bench.friction, step=step, duration=duration, inputs=inputs, drive=drive,
                      record_every=every, system=system, start=start.kicked(kick), book=False)
    return _shown(model, section, variant, motion, step * every)


def _shown(model, section, variant, motion, interval):
    names = [str(n) for n in model.sensor_name]
    window = section.published.window if variant.as_published else section.window
    signals = {name: motion.velocity[names.index(name)] for name in section.spectra}
    base = np.mean([cycle(s, interval, window, 1.0, section.lowest_frequency).frequency for s in signals.values()])
    levels, strength = {}, {}
    for name, signal in signals.items():
        amplitude = harmonic_levels(signal[-round(window / interval):], 1 / interval, base, section.lines)
        strength[name] = float(amplitude[0])
        if section.spectra[name].quantity == "acceleration":
            amplitude = amplitude * np.arange(1, section.lines + 1)
        levels[name] = 20 * np.log10(np.maximum(amplitude / amplitude[0], 1e-15))
    share = np.mean(np.reshape(motion.status_share, (-1, 3)), axis=0)
    return Shown(variant, float(base), levels, strength, float(share[0]), float(share[1]))


def growing(modes):
    """(root of the fastest growing mode, 1/s) of a product ComplexModes at its first operating point."""
    roots = modes.unstable_root[modes.unstable_operating == 0]
    if not len(roots):
        raise ConfigError("diagnosis.lines", "a model of which a mode grows", "none", "see stage complex_modes")
    return roots[np.argmax(roots.real)]


def harmonics_problem(recording, section, motions, modes, rules=DEFAULTS):
    """DiagnosisProblem over the recorded lines: which of them stand in each spectrum, and their base frequency.

    The nominal model is the small motion of ComplexModes ``modes``: its fastest growing mode and nothing else.
    """
    lists = {name: lines_of(recording, section.run, s.list) for name, s in section.spectra.items()}
    bases = {name: (lines.frequency[0], lines.frequency_tolerance[0]) for name, lines in lists.items()}
    frequency, tolerance = np.mean(list(bases.values()), axis=0)
    std = np.full(section.lines, rules.lists.half_std)
    features = {name: Features("line", "1", _stands(lines, frequency, section.lines), std)
                for name, lines in lists.items()}
    features[BASE] = Features("frequency", "Hz", [frequency], [tolerance / 2])
    alone = np.concatenate(([1.0], np.zeros(section.lines - 1)))
    nominal = {**dict.fromkeys(lists, alone), BASE: np.array([_hertz(growing(modes))])}
    return list_problem(features, nominal, [
        Alternative(m.name, "contact", _features(motions[m.name], section, rules.lists.soft)) for m in MECHANISMS],
        rules=rules)


def _stands(lines, base, count):
    """1 (k,) where a multiple of ``base`` was recorded, else 0."""
    order = np.arange(1, count + 1)
    near = np.abs(lines.frequency - order[:, None] * base) <= np.maximum(lines.frequency_tolerance, 0.02 * base)
    return near.any(axis=1).astype(float)


def _features(motion, section, soft):
    features = {name: scipy.special.ndtr((level + section.spectra[name].range) / soft)
             for name, level in motion.levels.items()}
    return {**features, BASE: np.array([motion.base])}


def outcomes(model, section, motions, effects, fan_out=map):
    """{condition: {effect: (m,), over their standard deviation}} of other records of the ``effects`` of MECHANISMS.

    Amplitudes at twice the load and at twice the speed over those of the record are computed by further motions, but
    where the equations scale; a condition under which one of them cannot be computed is left out.
    """
    computed = {
        "measured = levels of all lines, with the range of the analyser":
             {e: np.concatenate([np.maximum(level, -section.spectra[name].range) / _LEVEL_STD
                                 for name, level in motions[e].levels.items()]) for e in effects},
             "measured = share of the time that the contact is open, by its resistance":
             {e: np.array([motions[e].open_share / _SHARE_STD]) for e in effects}}
    for name, condition, factors in (("load", "normal_load = twice that of the record", {"load": 2.0}),
                                     ("speed", f"speed = {2 * section.speed:.4g} rad/s", {"speed": 2.0})):
        again = {m.name: replace(m, **factors) for m in MECHANISMS if m.name in effects and m.name not in _SCALING}
        moved = dict(zip(again, fan_out(partial(_tried, model, section), again.values()), strict=True))
        if None not in moved.values():
            computed[condition] = {e: _ratio(e, name, motions, moved) / _RATIO_STD for e in effects}
    return computed


def _tried(model, section, variant):
    try:
        return _move(model, section, variant)
    except BrakechainError:
        return None


def _ratio(effect, name, motions, moved):
    """Logarithms (sensors,) of amplitudes at twice the load or speed over those of the record."""
    before = motions[effect].amplitude
    if effect in _SCALING:
        return np.full(len(before), np.log(2.0) if _SCALING[effect] == name else 0.0)
    return np.array([np.log(moved[effect].amplitude[sensor] / a) for sensor, a in before.items()])


def harmonics_reasons(recording, section, motions, modes):
    """Sentences from the computed motions, and on the published computation where there is one."""
    root = growing(modes)
    reasons = [f"the nominal model, small motion in permanent contact, grows at {_hertz(root):.0f} Hz by"
               f" {root.real:.0f} 1/s: one line and no harmonic"]
    reasons += [_of_motion(motions[m.name], section) for m in MECHANISMS]
    reasons.append("with loss of contact alone amplitudes are proportional to the load and do not depend on the"
                   " speed, with stick and reversal alone they are proportional to the speed and do not depend on the"
                   " load (the equations scale): levels at two loads and two speeds tell them apart")
    return reasons + (_of_published(recording, section, motions, root) if section.published else [])


def _of_motion(motion, section):
    seen = " and ".join(f"{int((level > -section.spectra[name].range).sum())} of {len(level)} lines at the {name}"
                        f" ({', '.join(f'{v:.0f}' for v in level[1:])} dB)" for name, level in motion.levels.items())
    return (f"{motion.variant.name.replace('_', ' ')}: base {motion.base:.0f} Hz, {seen}; open {motion.open_share:.0%},"
            f" sticking {motion.stick_share:.0%} of the time")


def stepped(frequency, step):
    """Frequency [Hz] at which the trapezoidal rule with ``step`` s shows an undamped mode of ``frequency`` Hz."""
    return np.arctan(np.pi * frequency * step) / (np.pi * step)


def unstepped(frequency, step):
    """Frequency [Hz] of the mode that the trapezoidal rule shows at ``frequency`` Hz."""
    return np.tan(np.pi * frequency * step) / (np.pi * step)


def _hertz(root):
    return abs(root.imag) / (2 * np.pi)


def _of_published(recording, section, motions, root):
    p, motion = section.published, motions["published"]
    line = float(lines_of(recording, p.run, p.list).frequency[0])
    mode, base = _hertz(root), motions["loss_of_contact_and_stick"].base
    return [
        f"{line:.0f} Hz as published: if the trapezoidal rule stepped it by {1e6 * p.step:.3g} us, the mode behind it"
        f" lies at {unstepped(line, p.step):.0f} Hz and {line - unstepped(line, p.step):+.0f} Hz of it are the time"
        f" step; the growing mode of this model, {mode:.0f} Hz, would be shown at {stepped(mode, p.step):.0f} Hz"
        f" ({stepped(mode, p.step) - mode:+.0f} Hz); lines of {1e3 * p.window:.3g} ms are {1 / p.window:.0f} Hz apart",
        f"{1e3 * p.window:.3g} ms: small motion grows {np.exp(root.real * p.window):.3g} times in them; both"
        f" mechanisms, stepped and windowed as published, {_of_motion(motion, section).partition(': ')[2]}; nothing"
        " shows there that had to settle",
        f"spectra to {1e-3 * p.band:.3g} kHz hold {int(p.band // base)} of {section.lines} lines of {base:.0f} Hz: the"
        " others could not show, however long the motion"]
