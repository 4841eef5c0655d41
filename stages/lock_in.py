"""Stage lock_in: lock-in of the pin on disc over pin length, load, speed and angle."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.fem.supports import held_modes
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.friction.tangential_law import tangential_law
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.reduction.body import reduce_body
from pipeline.physics.signals.limit_cycle import cycle
from pipeline.physics.sliding.body_exchange import exchanged
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.stability.lock_in import KINDS, NONE, harmonic_levels
from pipeline.physics.stability.lock_in import lock_in as classified
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.simulate import Penalty, simulate
from pipeline.products import Effects, LockIn, PinOnDisc, ReducedModel
from pipeline.systems.fem_bodies import elastic_body
from pipeline.systems.pin_on_disc import reshaped

_GRAVITY = 9.81
#: sensors of the system that are classified: disc first, then the pin
_SENSORS = ("disc", "pin")
#: modes of the clamped pin that count, and harmonics of the base that are reported
_PIN_MODES, _MULTIPLES = 8, 8
_NO_LINE = -200.0
#: time between samples that are kept, highest line and length of what is drawn
_INTERVAL, _HIGHEST_LINE, _TRACE = 1e-5, 20e3, 5e-3
#: disc modes with less axial motion are not observed
_OUT_OF_PLANE = 0.5


class Case(Section):
    """One point compared with the paper."""

    length: Quantity("m", gt=0, le=0.2) = option(..., "free length of the pin")
    base_mass: Quantity("kg", gt=0) | None = option(None, "mass that moves with the clamp; none = that of the system")


class Settings(Section):
    """Points of the map, and the motion by which each is classified."""

    cases: tuple[Case, ...] = option(({"length": "146.5 mm"}, {"length": "151.5 mm"}, {"length": "181.5 mm"}),
                                     "points compared with the paper")
    shortest: Quantity("m", gt=0) = option("120 mm", "first length of the map")
    longest: Quantity("m", gt=0, le=0.2) = option("200 mm", "last length of the map")
    lengths: int = option(41, "lengths of the map", ge=1)
    loads: Quantities("kg", gt=0) = option(("0.5 kg", "1.5 kg", "5 kg"), "weights, at the length of the system")
    speeds: Quantities("rad/s") = option(("0.5 rpm", "2.4 rpm", "20 rpm", "95 rpm"), "speeds, at the length of the"
                                                                                     " system")
    tilts: Quantities("rad", gt=-1, lt=1) = option(("-8 deg", "-4 deg", "1 deg", "4 deg", "8 deg"),
                                                   "tilts, at the length of the system")
    load: Quantity("kg", gt=0) = option("1.5 kg", "weight where it is not varied")
    speed: Quantity("rad/s") = option("2.4 rpm", "speed of the disc where it is not varied")
    friction: float | None = option(None, "coefficient of friction; none = that of the interface law", ge=0)
    highest_mode: Quantity("Hz", gt=0) = option("12 kHz", "growing modes above it are not sought")
    contact_damping: Quantity("N s/m", ge=0) = option("1 kN s/m", "damping of the normal contact")
    step: Quantity("s", gt=0) = option("1 us", "time step of the motion")
    duration: Quantity("s", gt=0) = option("0.4 s", "length of the motion")
    window: Quantity("s", gt=0) = option("80 ms", "its end, which is classified")
    settled_within: float = option(0.05, "largest spread of the amplitudes over quarters of the window", gt=0)
    kick: Quantity("m/s", gt=0) = option("5 mm/s", "start velocity of the pin's accelerometer: the onset is not"
                                                   " waited for")
    dynamic_range: float = option(50.0, "lines this far below the base no longer count, dB", gt=0)
    highest_frequency: Quantity("Hz", gt=0) = option("60 kHz", "modes with open contact above it are left out")
    fixed_below: Quantity("Hz", gt=0) = option("15 kHz", "modes of the pin with its interface held")
    residual_below: Quantity("Hz", gt=0) = option("200 kHz", "residual shapes of the pin")


@dataclass(frozen=True)
class _Point:
    """One point of the map."""

    scan: str
    length: float
    load: float
    speed: float
    tilt: float
    base_mass: float


def _check(sections):
    """Refuse windows that the motion does not fill, before anything is computed."""
    settings = sections["lock_in"]
    if settings.window > settings.duration:
        raise ConfigError("lock_in.window", f"at most the duration, {settings.duration:g} s", f"{settings.window:g} s")
    if abs(_INTERVAL / settings.step - round(_INTERVAL / settings.step)) > 1e-6 or settings.step > _INTERVAL:
        raise ConfigError("lock_in.step", f"a whole part of {_INTERVAL:g} s, the time between samples",
                          f"{settings.step:g} s", "take 1 us, 2 us or 5 us")


@stage(check=_check)
def lock_in(pin_on_disc: PinOnDisc, model: ReducedModel, effects: Effects | None, settings: Settings,
            context: Context) -> LockIn:
    """Map lock-in over pin length, load, speed and angle.

    The disc is reduced once, the pin for each point. Points without an unstable mode are not integrated: they have no
    spontaneous lock-in, although a large disturbance might still cause one. Effects of the case do not act here.

    Method:
    At {lengths} free lengths, and over load, speed and angle, the pin was reduced and the complex modes were computed.
    Where one is unstable, the motion was integrated over {duration} with steps of {step} and the contact stiffness of
    the interface law at the static load. The spectrum of the last {window} was classified as classical, intermediate,
    multiple or dual-base lock-in.
    """
    if effects is not None and len(effects.effect):
        context.log(f"{', '.join(dict.fromkeys(map(str, effects.effect)))}: not part of this map, whose pins and loads"
                    " are those of the model alone")
    points = _points(pin_on_disc, settings)
    results = context.map(partial(_visit, pin_on_disc, model, settings, context.solver), points, "points")
    fields = {name: [getattr(p, name) for p in points] for name in _Point.__dataclass_fields__}
    answers = {name: [row[name] for row in results] for name in results[0]}
    pictures = {name: answers.pop(name)[:len(settings.cases)] for name in ("trace", "spectrum")}
    return LockIn(**fields, **answers, **_pictured(pictures, settings))


def _pictured(pictures, settings):
    """Traces and spectra of the cases with their axes; silence where nothing grows."""
    samples = round(settings.window / _INTERVAL)
    frequency = np.fft.rfftfreq(samples, _INTERVAL)
    frequency = frequency[frequency <= _HIGHEST_LINE]
    count, kept = len(settings.cases), min(round(_TRACE / _INTERVAL), samples)
    trace, spectrum = np.zeros((count, 2, kept)), np.full((count, 2, len(frequency)), _NO_LINE)
    for k in range(count):
        if pictures["trace"][k] is not None:
            trace[k], spectrum[k] = pictures["trace"][k][:, -kept:], pictures["spectrum"][k][:, :len(frequency)]
    return {"trace_time": settings.duration - _INTERVAL * np.arange(kept)[::-1], "frequency": frequency,
            "trace": trace, "spectrum": spectrum}


def _points(system, settings):
    """Cases, then the four scans."""
    length, tilt, base = float(system.pin_length[0]), float(system.tilt), float(system.base_mass)
    usual = _Point("case", length, settings.load, settings.speed, tilt, base)
    points = [replace(usual, length=c.length, base_mass=c.base_mass or base) for c in settings.cases]
    points += [replace(usual, scan="length", length=float(v))
               for v in np.linspace(settings.shortest, settings.longest, settings.lengths)]
    return points + [replace(usual, scan=name, **{name: float(v)}) for name, values in
                     (("load", settings.loads), ("speed", settings.speeds), ("tilt", settings.tilts)) for v in values]


def _visit(system, model, settings, solver, point):
    """The fields of one point."""
    body, pin_modes = _pin(system, point, solver)
    terms = reduce_body(body, settings.fixed_below, settings.residual_below, solver)
    sliding = exchanged(_pressed(system, model, settings, point), "pin", terms)
    friction = _friction(model, sliding) if settings.friction is None else settings.friction
    root = _growing(sliding, friction, settings)
    disc = system.disc_frequency[system.disc_out_of_plane > _OUT_OF_PLANE]
    answer = {"friction": friction, "root": root, "kind": KINDS[NONE], "base": 0.0, "second": 0.0,
            "settled": 1, "amplitude": [0.0, 0.0], "harmonics": [0, 0], "levels": np.full((2, _MULTIPLES), _NO_LINE),
            "open_share": 0.0, "trace": None, "spectrum": None}
    if root:
        answer |= _settled(sliding, friction, point, settings, (disc, pin_modes))
    around = answer["base"] or abs(root.imag) / (2 * np.pi)
    answer |= {"disc_mode": _nearest(disc, around), "pin_mode": _nearest(pin_modes, around)}
    return answer


def _pin(system, point, solver):
    """The pin of a point as an ElasticBody, and its own frequencies, rigidly clamped."""
    body = elastic_body(system, "pin")
    clamp = list(system.pin.material_name).index("clamp")
    density = body.density.copy()
    density[clamp] *= point.base_mass / float(system.base_mass)
    body = replace(body, node=_nodes(system, point), density=density)
    held = np.unique(body.element[body.material == clamp])
    return body, held_modes(*body.matrices(), held, solver, count=_PIN_MODES)[0]


def _nodes(system, point):
    """Nodes of the system's pin at the length and tilt of ``point``."""
    pin, length, tilt = system.pin, float(system.pin_length[0]), float(system.tilt)
    if (point.length, point.tilt) == (length, tilt):
        return pin.node
    return reshaped(pin.node, system.contact_position[0], pin.element, pin.element_material, length, tilt,
                    (point.length, point.tilt))


def _pressed(system, model, settings, point):
    """The sliding model at the speed of the point, its contact linearised about the weight."""
    sliding = sliding_model(model, 0, point.speed)
    force = point.load * _GRAVITY
    if not len(system.law_closure):
        raise ConfigError("lock_in", "a contact with the interface law", "a hard one", "pin_on_disc.contact.hard:"
                                                                                       " false")
    closure = np.interp(force / system.contact_area, system.law_pressure, system.law_closure)
    stiffness = force_at_rest(closure, system.contact_area, system.law_closure, system.law_pressure)[1]
    return replace(sliding, contacts=replace(sliding.contacts, preload=np.array([force]), stiffness=stiffness,
                                             damping=np.array([settings.contact_damping])))


def _friction(model, sliding):
    """Coefficient of the tangential law of the model at the pressure of the weight."""
    return float(tangential_law(model).at(sliding.contacts.pressure).friction[0])


def _growing(sliding, friction, settings):
    """The root with the largest growth rate below the limit, 0 where none grows."""
    roots = quadratic_roots(*sliding.linearised(friction))
    kept = roots[(roots.imag > 0) & (np.abs(roots) < 2 * np.pi * settings.highest_mode)]
    fastest = max(kept, key=lambda root: root.real, default=0j)
    return complex(fastest) if fastest.real > 0 else 0j


def _settled(sliding, friction, point, settings, modes):
    """Motion from a kick, and what it settles into."""
    system = modal_system(sliding, highest=settings.highest_frequency)
    load, names = np.array([point.load * _GRAVITY]), list(sliding.sensor_name)
    law, dry = Penalty(sliding.contacts.stiffness, settings.contact_damping), constant(friction)
    start = steady_start(sliding, law, dry, load)
    row = sliding.sensor_rows[names.index("pin")]
    shove = system.shape @ (system.shape.T @ row)
    motion = simulate(sliding, law, dry, step=settings.step, duration=settings.duration, inputs=load,
                      record_every=round(_INTERVAL / settings.step), system=system,
                      start=start.kicked(shove * settings.kick / (row @ shove)), book=False)
    late = slice(-round(settings.window / _INTERVAL), None)
    rate = 1 / (motion.time[1] - motion.time[0])
    signals = [motion.velocity[names.index(name)][late] for name in _SENSORS]
    result = classified(signals[0], rate, *modes, dynamic_range=settings.dynamic_range, count=_MULTIPLES)
    levels = np.full((2, _MULTIPLES), -np.inf)
    if result.base:
        levels = np.array([harmonic_levels(s, rate, result.base, _MULTIPLES, settings.dynamic_range) for s in signals])
    return {"kind": KINDS[result.kind], "base": result.base, "second": result.second,
            "settled": int(all(_steady(names, motion, settings))),
            "amplitude": [s.std() for s in signals], "harmonics": [_without_gap(row) for row in levels],
            "levels": np.maximum(levels, _NO_LINE), "open_share": motion.status_share[0, 0],
            "trace": np.array(signals), "spectrum": np.array([_level(s) for s in signals])}


def _level(signal):
    """Level (lines,) in dB re the highest line, under a Hann window."""
    power = np.abs(np.fft.rfft(np.hanning(len(signal)) * (signal - signal.mean()))) ** 2
    return np.maximum(10 * np.log10(np.maximum(power, 1e-300) / max(power.max(), 1e-300)), _NO_LINE)


def _steady(names, motion, settings):
    """For disc and pin: has the amplitude settled in the window?"""
    interval = motion.time[1] - motion.time[0]
    for name in _SENSORS:
        yield cycle(motion.velocity[names.index(name)], interval, settings.window, settings.settled_within).settled


def _without_gap(levels):
    """Number of multiples, the base included, before the first that is missing."""
    return int(np.argmin(np.append(np.isfinite(levels), False)))


def _nearest(modes, frequency):
    return float(modes[np.argmin(np.abs(modes - frequency))]) if frequency else 0.0
