"""Stage limit_cycle: what the unstable modes of complex_modes grow into, with all bodies flexible in the loop.

The small motion is that of the complex modes, root by root, in a frame at rest: disc, pads and caliper move with their
gyroscopic terms, and the contacts answer with the laws of the case instead of their slopes. What stops the growth is
therefore contact: points that open or stiffen, patches that stick, friction that changes with load and slip.
"""

from functools import partial
from typing import Literal

import numpy as np

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.operating_points import Speeds, StabilitySettings, selected_speeds
from pipeline.case_models.pads import kept
from pipeline.case_models.steady_sliding import branch_stiffness, mapped_friction, posed
from pipeline.case_models.unstable_roots import nearly
from pipeline.contract import ConfigError, Context, ConvergenceError, Quantity, Section, option, stage
from pipeline.physics.signals.limit_cycle import harmonic_levels
from pipeline.physics.signals.listening import RATE, audible, held
from pipeline.physics.signals.oscillation import dominant_frequency
from pipeline.physics.sliding_motion import exudyn_motion
from pipeline.physics.sliding_motion.motion import sliding_motion
from pipeline.physics.sliding_motion.sliding_modes import sliding_modes
from pipeline.physics.time_stepping.element_forces import FRICTION
from pipeline.physics.time_stepping.elements import Turning, alone
from pipeline.products import ComplexModes, Effects, Excerpt, FrictionMap, LimitCycle, ReducedModel
from pipeline.views.pages.sound_file import sound_files

COMPILED, EXUDYN = "compiled", "exudyn"
STEP, PATCHES, STICK, MODES = CHECKS = "step", "patches", "stick speed", "modes"
#: share of the reach of the contact law at which motions begin: small, and for the way to the limit cycle
_SMALL, _LARGE = 1e-3, 0.5
#: share to which the small motion grows at most
_STILL_SMALL = 0.03
#: samples a second that are kept of the end of the motion
_RATE = 100e3


class Settings(Section):
    """Contact patches, time steps, and the recorded part of the motion."""

    duration: Quantity("s", gt=0) = option("60 ms", "length of the motion from half the reach of the contact law")
    window: Quantity("s", gt=0) = option("10 ms", "windows of the levels; spectra and cycle are those of the last two")
    onset: Quantity("s", gt=0) = option("4 ms", "length of the small motion from which growth rates are read")
    step: Quantity("s", gt=0) = option("2 us", "time step")
    solver: Literal[COMPILED, EXUDYN] = option(
        COMPILED, "what integrates: exponential steps in compiled code, or explicit Runge-Kutta steps of exudyn, on the"
        " same forces")
    patch: int = option(12, "contacts that move together, at most, as long as 'patches' are enough", ge=1)
    patches: int = option(64, "patches of a face at most: a finer mesh of the lining has no more of them", ge=1)
    stick_speed: Quantity("m/s", gt=0) = option("0.1 m/s", "slip below which friction is regularised; creep replaces"
                                                " sticking")
    smallest_correction: float = option(
        1e-2, "corrections for friction and damping below this share of the modal amplitude are left out", gt=0)
    damping_above: float = option(
        0.05, "damping ratio, at least, of the modes above those of complex_modes, which the model does not resolve",
        ge=0, lt=1)
    settled_within: float = option(0.5, "largest change of the level in dB over the last two windows", gt=0)
    harmonics: int = option(6, "harmonics of the strongest line that are reported", ge=1)
    checks: tuple[Literal[CHECKS], ...] = option(
        (STEP,), "what is halved (step, stick speed, smallest correction of the modes) or doubled (patches) at the"
        " strongest operating point, to see how far the limit cycle holds")
    speeds: Speeds = option(
        "all", "operating points that are simulated: those of all speeds, or of the middle one alone")
    without: tuple[str, ...] = option((), "effects of the case that this stage leaves out, as it cannot have them")


def _check(sections):
    """Refuse windows that do not fit before anything is computed."""
    settings = sections["limit_cycle"]
    if settings.duration < 3 * settings.window:
        raise ConfigError("limit_cycle.duration", f"at least three windows of {settings.window:g} s",
                          f"{settings.duration:g} s")


@stage(check=_check, companions=sound_files)
def limit_cycle(model: ReducedModel, friction_map: FrictionMap, modes: ComplexModes, effects: Effects | None,
                settings: Settings, context: Context) -> LimitCycle:
    """Simulate unstable modes from onset to limit cycle.

    Every operating point with unstable modes is simulated twice: from a small motion in all of them, whose growth is
    compared with the complex modes, and from half the reach of the contact law to the limit cycle. Effects act as in
    complex_modes, memory and laws of contacts and joints included; 'without' leaves some out.

    Method:
    The motion about steady sliding was integrated in the complex modes of the sliding system with steps of {step}
    (solver: {solver}; compiled code does the linear part exactly), roots that grow or nearly do being those of the
    complex modes; contact laws and friction at patches of at most {patch} contacts, or {patches} of a face. Modes
    above those of the complex modes have a damping ratio of at least {damping_above}. The motion lasted {duration},
    levels are root mean squares over {window}. Where a motion outgrew all bounds, steps were halved.
    """
    for halved in range(_HALVINGS):
        shorter = settings.model_copy(update={"step": settings.step / 2**halved})
        try:
            return _simulated(model, friction_map, modes, effects, shorter, context)
        except _OutOfBounds as error:
            context.log(f"with steps of {shorter.step:.3g} s a motion reached {error.found}: half the step is tried")
    return _simulated(model, friction_map, modes, effects,
                      settings.model_copy(update={"step": settings.step / 2**_HALVINGS}), context)


#: how often steps are halved at most
_HALVINGS = 2


class _OutOfBounds(ConvergenceError):
    """A motion that no contact limits: of too long a step, or of too large patches."""


def _simulated(model, friction_map, modes, effects, settings, context):
    """LimitCycle with the step of the settings; ConvergenceError for a motion that nothing limits."""
    points = _points(modes, settings)
    terms = kept(physics_terms(effects), settings.without)
    simulate = partial(_simulate, model=model, friction_map=friction_map, modes=modes, terms=terms,
                       given=conditions(effects), settings=settings)
    finer, strongest = _checks(points, modes, settings)
    apart = [name for name in finer if name != STEP]
    tasks = [(points[strongest], finer[name], None) for name in apart]
    tasks += [(point, settings, finer.get(STEP) if k == strongest else None) for k, point in enumerate(points)]
    motions = context.map(simulate, tasks, "limit cycles")
    others, results = dict(zip(apart, motions, strict=False)), motions[len(apart):]
    if STEP in finer:
        others[STEP] = results[strongest]["finer"]
    for result in results:
        if result["imbalance"] > _TOLERATED:
            context.log(f"energy balances only within {100 * result['imbalance']:.2g} %; a shorter step would help")
    fields = {name: np.array([r[name] for r in results]) for name in _FIELDS} if results else _nothing(model, settings)
    onset = [(k, root, seen) for k, r in enumerate(results) for root, seen in zip(*r["onset"], strict=True)]
    return LimitCycle(
        pressure=modes.operating_pressure[points], speed=modes.operating_speed[points],
        onset_operating=[o[0] for o in onset], onset_root=np.array([o[1] for o in onset], complex),
        onset_simulated=np.array([o[2] for o in onset], complex), sensor_name=model.sensor_name, window=settings.window,
        settled_within=settings.settled_within, step=settings.step, **_axes(results, settings), **fields,
        listen=_listen(results, model.sensor_name),
        **_changes({name: others[name] for name in finer}, results[strongest] if finer else None))


#: largest error of the energy balance that passes without a message
_TOLERATED = 0.01
#: m/s at a sensor that no brake reaches
_UNBOUNDED = 100.0
#: fields of one operating point
_FIELDS = ("level", "open_share", "stick_share", "settled", "imbalance", "added_loss", "velocity", "spectrum",
           "cycle_frequency", "harmonic_amplitude")


def _simulate(task, model, friction_map, modes, terms, given, settings):
    """Fields of one operating point; ``task``: (its index in complex modes, settings of this simulation, the same with
    another step for a check on the same system, or None)."""
    point, settings, finer = task
    system, unstable, (starts, settled), rows = _system(point, model, friction_map, modes, terms, given, settings)
    linear = np.log(_STILL_SMALL / _SMALL) / unstable.real.max()
    small = partial(_grown, system, settings, max(min(settings.onset, linear), settings.step))
    # what friction remembers of one mode drives the others, whose growth would not be their own
    apart = [[k] for k in range(len(unstable))] if _remembers(system) else [[*range(len(unstable))]]
    seen = np.concatenate([small(starts[:, each], settled[:, each]) for each in apart])
    start = _LARGE * starts.sum(axis=1)
    return {"onset": (unstable, seen), "patches": len(system.patches.load),
            "modes": len(system.modes.root), **_cycle(system, start, rows, settings),
            "finer": finer and _cycle(system, start, rows, finer, book=False)}


def _remembers(system):
    """Whether friction of a SlidingMotion remembers."""
    return len(system.patches.states.kind) + len(system.attached.branch) > 0


def _grown(system, settings, duration, starts, settled):
    """(g,) 1/s with which small motions of a SlidingMotion grow and turn along ``starts`` (m, g), all at once, with
    what is ``settled`` (k, g) beside them."""
    memory = {"settled": _SMALL * settled.sum(axis=1)} if _remembers(system) else {}
    small = _advanced(system, settings, _SMALL * starts.sum(axis=1), duration, **memory)
    along = small.state @ starts.conj()
    logarithm = np.log(abs(along)) + 1j * np.unwrap(np.angle(along), axis=0)
    ahead = small.time - small.time.mean()      # of a line through all: what turns the other way cancels
    return ahead @ logarithm / (ahead @ ahead)


def _advanced(system, settings, start, duration, *options, **others):
    """Run of a SlidingMotion by the solver of the settings."""
    run = system.run if settings.solver == COMPILED else partial(exudyn_motion.run, system)
    return run(start, settings.step, duration, *options, **others)


def _points(modes, settings):
    """Operating points of complex modes that have unstable modes and are simulated."""
    points = np.unique(modes.unstable_operating)
    return points[np.isin(modes.operating_speed[points], selected_speeds(settings.speeds, modes.operating_speed))]


def _system(point, model, friction_map, modes, terms, given, settings):
    """(SlidingMotion at one operating point of complex modes, the unstable roots (g,) there, how to start in them, see
    ``_starts``, rows (s, n) of the sensors).

    Its roots are those of complex modes; where friction remembers, they are those without what it remembers, which acts
    beside them.
    """
    linear, pressure = StabilitySettings.of(modes), modes.operating_pressure[point]
    state = int(np.argmin(abs(model.pressure - pressure)))
    case = posed(model, state, float(modes.operating_speed[point]), linear.damping_speed, terms, given)
    _refuse_sticking(case.bench.model.elements)
    friction, plain = mapped_friction(friction_map, linear.sliding_distance)
    steady = case.seeking.slide(case.response(linear.centrifugal), pressure * model.input_area, friction, plain, linear)
    about, limit = steady.about(case.bench.model), linear.frequency_max
    beside = steady.beside(about, linear.friction_slopes)
    remembers, elements = beside is not None, case.bench.model.elements
    if (remembers or elements) and settings.solver == EXUDYN:
        raise ConfigError("limit_cycle.solver", f"{COMPILED}, whose steps carry memory and elements of effects", EXUDYN,
                          "leave it out")
    root, reduced = _roots(point, modes, linear)
    whole = sliding_modes(
        about, steady.acting(linear.friction_slopes), limit, settings.smallest_correction, () if remembers else reduced,
        branch_stiffness(about), steady.friction, friction_damping=linear.friction_damping,
        gyroscopic=linear.gyroscopic, centrifugal=linear.centrifugal)
    whole = whole if remembers else whole.with_roots(root, reduced)
    unstable = modes.unstable_root[modes.unstable_operating == point]
    system = sliding_motion(about, steady.contact.closure, case.friction(friction), case.bench.law,
                            whole.damped_above(limit, settings.damping_above), model.contact_body,
                            (settings.patch, settings.patches), settings.stick_speed, steady.slopes,
                            steady.rest, linear.friction_damping or any(isinstance(e.law, Turning) for e in elements))
    return system, unstable, _starts(system, unstable, about.mass, beside), about.sensor_rows


def _refuse_sticking(elements):
    """ConfigError for dry friction of joints."""
    if sticks := [each.name for each in elements if alone((each,)).kind[0] in FRICTION]:
        raise ConfigError("limit_cycle", "joints that slide or hold all along, from which small motions grow",
                          f"dry friction of a joint that rests in steady sliding, {', '.join(sticks)}",
                          "name it in limit_cycle.without, or take it in the stage transient")


def _starts(system, unstable, mass, beside):
    """((m, g) modal coordinates of a SlidingMotion in its ``unstable`` modes, as large as the contact law reaches,
    (k, g) what settles there)."""
    if beside is None:
        found = np.eye(len(system.modes.root), dtype=complex)[system.modes.nearest(unstable)]
        return np.array([system.reaching(each) for each in found]).T, np.zeros((0, len(found)))
    found, settled = zip(*(system.modes.coordinates(mass, beside, root) for root in unstable), strict=True)
    sizes = [system.reaching(each) for each in found]
    scale = [abs(size).max() / abs(each).max() for size, each in zip(sizes, found, strict=True)]
    return np.array(sizes).T, np.array(settled).T * scale


def _roots(point, modes, linear):
    """Roots at an operating point that grow or nearly do, and the same in the reduced model, where full matrices moved
    them."""
    root = modes.operating_root[point]
    root = root[(root.imag > 0) & nearly(root, linear)]
    reduced = root.copy()
    for full, before in zip(modes.unstable_root, modes.unstable_reduced, strict=True):
        reduced[root == full] = before
    return root, reduced


def _cycle(system, start, sensor_rows, settings, book=True):
    """Levels over windows, and the end of the motion; with a ``book`` of the last window its energy balance."""
    rows, count = system.velocity_rows(sensor_rows), round(settings.duration / settings.window)
    every = max(round(1 / (_RATE * settings.step)), 1)
    levels, opened, stuck, signals, end = [], [], [], [], start
    for number in range(count):
        run = _advanced(system, settings, end, settings.window, every,
                        book=book and number == count - 1)
        end, velocity = run.end, (rows @ run.state.T).real
        levels.append(np.sqrt((velocity**2).mean(axis=1)))
        if not levels[-1].max(initial=0.0) < _UNBOUNDED:
            raise _OutOfBounds("limit_cycle", "a motion that contact limits", f"{levels[-1].max():.3g} m/s after"
                               f" {(number + 1) * settings.window:.3g} s", "lower limit_cycle.patch and raise"
                               " limit_cycle.patches, so that more patches see the motion, or lower limit_cycle.step"
                               f" below {settings.step:.3g} s")
        opened.append(run.open.mean())
        stuck.append(run.stick.mean())
        signals.append(velocity)
    last = np.hstack(signals[-2:])
    frequency, harmonic, spectrum = _lines(last, every * settings.step, settings.harmonics)
    return {"level": np.array(levels).T, "open_share": opened, "stick_share": stuck,
            "settled": int(abs(_decibel(levels[-1], levels[-2])) <= settings.settled_within),
            "imbalance": run.imbalance, "added_loss": run.added[-1] / (run.added[-1] + run.loss[-1]) if book else 0.0,
            "velocity": signals[-1].astype(np.float32), "spectrum": spectrum, "cycle_frequency": frequency,
            "harmonic_amplitude": harmonic}


def _decibel(level, other):
    """dB of one set of root mean squares over another, all sensors together."""
    return float(10 * np.log10((level**2).sum() / (other**2).sum()))


def _lines(velocity, interval, harmonics):
    """(frequency of the strongest line, amplitudes (s, harmonics), amplitude spectra (s, f)) of velocities (s, t)."""
    loudest = velocity[np.argmax((velocity**2).mean(axis=1))]
    frequency = dominant_frequency(loudest, interval, 0.0)
    harmonic = [harmonic_levels(signal, 1 / interval, frequency, harmonics) for signal in velocity]
    window = np.hanning(velocity.shape[1])
    return frequency, harmonic, 2 * abs(np.fft.rfft(window * velocity, axis=1)) / window.sum()


def _axes(results, settings):
    """Axes of the recorded end, and the size of the model."""
    every = max(round(1 / (_RATE * settings.step)), 1)
    interval = every * settings.step
    samples = round(settings.window / settings.step) // every
    return {"time": interval * np.arange(samples), "frequency": np.fft.rfftfreq(2 * samples, interval),
            "patches": results[0]["patches"] if results else 0, "modes": results[0]["modes"] if results else 0}


def _nothing(model, settings):
    """Fields of a system without unstable modes."""
    sensors, axes = len(model.sensor_name), _axes([], settings)
    windows = round(settings.duration / settings.window)
    shapes = {"level": (0, sensors, windows), "open_share": (0, windows), "stick_share": (0, windows), "settled": (0,),
              "imbalance": (0,), "added_loss": (0,), "velocity": (0, sensors, len(axes["time"])),
              "spectrum": (0, sensors, len(axes["frequency"])), "cycle_frequency": (0,),
              "harmonic_amplitude": (0, sensors, settings.harmonics)}
    return {name: np.zeros(shape, {"settled": int, "velocity": np.float32}.get(name, float))
            for name, shape in shapes.items()}


def _listen(results, sensors):
    """{'squeal': Excerpt} of the loudest limit cycle at its loudest sensor; {} where all motion decays."""
    if not results:
        return {}
    cycle = max(results, key=lambda result: (result["level"][:, -1] ** 2).sum())
    sensor = int(cycle["level"][:, -1].argmax())
    amplitude = np.asarray(cycle["harmonic_amplitude"])[sensor]
    frequency = cycle["cycle_frequency"] * np.arange(1, len(amplitude) + 1)
    if not audible(frequency[:1]).any():
        return {}
    sound = held(frequency, amplitude / np.sqrt(2.0))
    content = f"strongest line of the velocity at sensor {sensors[sensor]} and its multiples, held for 2 s"
    return {"squeal": Excerpt(samples=sound.samples, rate=RATE, full_scale=sound.full_scale, unit="m/s",
                              content=content, begin=0.0)}


def _checks(points, modes, settings):
    """({name: settings finer than the others}, place of their operating point): each check, where growth is fastest."""
    if not (len(points) and settings.checks):
        return {}, 0
    growth = [modes.unstable_root.real[modes.unstable_operating == point].max() for point in points]
    finer = {STEP: {"step": settings.step / 2},
             PATCHES: {"patch": max(settings.patch // 2, 1), "patches": 2 * settings.patches},
             STICK: {"stick_speed": settings.stick_speed / 2},
             MODES: {"smallest_correction": settings.smallest_correction / 2}}
    return {name: settings.model_copy(update=finer[name]) for name in settings.checks}, int(np.argmax(growth))


def _changes(finer, here):
    """Changes of level and frequency by each check {name: results} from the results ``here``."""
    level = [result["level"][:, -2:].mean(axis=1) for result in finer.values()]
    return {"check": list(finer),
            "check_level": [_decibel(each, here["level"][:, -2:].mean(axis=1)) for each in level],
            "check_frequency": [result["cycle_frequency"] / here["cycle_frequency"] - 1 for result in finer.values()]}
