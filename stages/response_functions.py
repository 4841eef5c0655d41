"""Stage response_functions: frequency responses, from universal files or estimated from records."""

from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.contract.errors import first_of
from pipeline.diagnosis.experiment_design.overloaded_channels import overload_told
from pipeline.physics.signals import frequency_response as estimate
from pipeline.products import Recording, ResponseFunctions, TestResponses
from pipeline.recordings.samples import place_of

#: methods, and how the page calls them
METHODS = {"blows": "blows", "lasting_force": "lasting force", "motions_alone": "motions alone"}


class Settings(Section):
    """Which records are a modal test, and how its responses are estimated."""

    runs: tuple[str, ...] = option((), "runs of the test; none = all that hold frequency responses, else all")
    together: bool = option(False, "the runs are one test: a hammer at one place after the other, or sensors moved on")
    method: Literal["auto", *METHODS] = option("auto", "blows of a hammer, a lasting force, motions alone; auto: as the"
                                               " channels of force show")
    force: tuple[str, ...] = option((), "channels of force; none = all that measure one")
    motion: tuple[str, ...] = option((), "channels of motion; none = all displacements, velocities and accelerations")
    references: tuple[str, ...] = option((), "motions that all are correlated with where no force is measured; none ="
                                             " the one that moves most")
    resolution: Quantity("Hz", gt=0) | None = option(None, "distance of the lines; none = 16 segments of the record,"
                                                     " of motions alone a tenth of it; of blows it follows from them")
    phase: Literal["auto", "as_given", "conjugate"] = option(
        "auto", "sign of the phases of given responses; conjugate: the file has them in exp(-i w t), or S_fx for S_xf;"
        " auto: conjugate where responses would come before their force")
    window_decay: Quantity("1/s", gt=0) | None = option(
        None, "rate r of the exponential window exp(-r t) under which given responses were measured; it is taken off"
        " the decay rates of all modes; none = no window")
    window_end: float | None = option(None, "the same by the value of the window at the end of its frame, whose length"
                                      " is the inverse of the distance of the lines", gt=0, lt=1)
    rebound: Quantity("s", gt=0) = option("100 ms", "a second pulse within this time makes it a blow struck twice")


#: responses that are named in a sentence
_NAMED = 4
_FORCE, _MOTIONS = "N", ("m", "m/s", "m/s^2", "rad", "rad/s", "rad/s^2")


def _check(sections):
    """Refuse a window that is stated twice."""
    settings = sections["response_functions"]
    if settings.window_decay is not None and settings.window_end is not None:
        raise ConfigError("response_functions.window_end", "one of window_decay and window_end", "both",
                          "state the window once")


@stage(check=_check)
def response_functions(recording: Recording, settings: Settings, context: Context) -> ResponseFunctions:
    """Take frequency responses from the recording, or estimate them from records of force and motion.

    Method:
    Under a lasting force H1 = S_xf / S_ff over Hann segments, half overlapped, with the multiple coherence of all
    forces. Of blows of a hammer each is cut out up to the next one, its force zero beside its pulse, and both signals
    weighed by exp(-r t) where the motion does not decay by itself; r is taken off the decay rates again. Blows struck
    twice within {rebound}, clipped or cut off are left out. Without a measured force correlation functions with the
    references stand for the responses: their poles are those of the structure under a wide-band force, and its
    harmonics, where it has some, look like modes without damping. Responses that a file gives are taken as they are,
    or conjugate where their inverse transform shows that they would come before their force; a window that the case
    states is taken off the decay rates.
    """
    strange = sorted(set(settings.runs) - set(recording.runs))
    if strange:
        raise ConfigError("response_functions.runs", f"some of {', '.join(recording.runs)}", ", ".join(strange))
    chosen = settings.runs or [name for name, run in recording.runs.items() if run.frf] or list(recording.runs)
    items = [(name, recording.runs[name]) for name in chosen]
    tests = context.map(partial(_of_run, settings=settings), items, "frequency responses")
    for name, test in zip(chosen, tests, strict=True):
        for told in (*test.remark, *(f"left out: {blow}" for blow in test.left_out)):
            context.remark(f"{name}: {told}")
    if settings.together and len(tests) > 1:
        if any(str(one.method) == METHODS["blows"] for one in tests):
            tests = context.map(partial(_of_run, settings=settings, window=_common_window(tests)), items, "one window")
        return ResponseFunctions(tests={"all": _joined(dict(zip(chosen, tests, strict=True)))})
    return ResponseFunctions(tests=dict(zip(chosen, tests, strict=True)))


def _common_window(tests):
    """(Samples that every blow of several TestResponses has, largest decay in 1/s)."""
    blows = [one for one in tests if str(one.method) == METHODS["blows"]]
    return 2 * (min(len(one.line) for one in blows) - 1), max(float(one.decay) for one in blows)


def _of_run(item, settings, window=(None, None)):
    """TestResponses of one run (name, Run); ``window`` (samples, decay in 1/s) of blows."""
    name, run = item
    where = f"response_functions: {name}"
    if run.frf:
        return _given(where, run, settings)
    forces = _channels(where, run, settings.force, (_FORCE,), "force")
    motions = _channels(where, run, settings.motion, _MOTIONS, "motion")
    method = settings.method
    if method == "auto":
        blows = len(forces) == 1 and estimate.of_blows_alone(_samples(forces)[0])
        method = "motions_alone" if not forces else "blows" if blows else "lasting_force"
    if not motions or (not forces and method != "motions_alone"):
        raise ConfigError(where, "frequency responses, or channels of motion" + " and of force" * bool(motions),
                          ", ".join(f"{key} in {one.unit}" for key, one in run.channels.items()) or "no channel",
                          "name them in response_functions.motion and .force, or choose other runs")
    rate = _one_grid(where, {**forces, **motions})
    if method == "motions_alone":
        return _from_motions(where, motions, settings, rate)
    found = _estimated(where, method, forces, motions, settings, rate, window)
    return _test(found, METHODS[method], motions, forces, "{motion}/{reference}", "to")


def _test(found, method, motions, references, unit, link):
    """TestResponses of an Estimated of ``motions`` {name: Channel} per ``references``; ``unit`` of both units."""
    keys = [(motion, reference) for motion in motions for reference in references]
    return TestResponses(
        line=found.frequency, response=found.response.reshape(len(keys), -1),
        coherence=np.empty((0, len(found.frequency))) if found.coherence is None else found.coherence,
        label=[motion if len(references) == 1 else f"{motion} {link} {reference}" for motion, reference in keys],
        unit=[unit.format(motion=motions[m].unit, reference=references[r].unit) for m, r in keys],
        place=[place_of(motion, motions[motion]) for motion, _ in keys],
        reference=[place_of(reference, references[reference]) for _, reference in keys], method=method,
        averages=[found.averages], left_out=[f"{time:.4g} s: {why}" for time, why in found.left_out],
        decay=found.decay, remark=_overloaded({**references, **motions}) if method != METHODS["blows"] else [])


def _overloaded(channels):
    """Remarks on channels of a lasting record that are held at the end of their range; blows that are were left out."""
    return [f"{name}: {told}" for name, one in channels.items() if (told := overload_told(one))]


def _estimated(where, method, forces, motions, settings, rate, window):
    """Estimated of a run with measured forces."""
    force, motion = _samples(forces), _samples(motions)
    if method == "lasting_force":
        return _of(where, estimate.from_lasting_forces, force, motion, rate, settings.resolution)
    if len(forces) > 1:
        raise ConfigError(where, "one channel of force", ", ".join(forces), "name it in response_functions.force")
    return _of(where, estimate.from_blows, force[0], motion, rate, settings.rebound, *window)


def _of(where, estimator, *given):
    """Estimated by an ``estimator``, whose errors say of which run."""
    try:
        return estimator(*given)
    except ConfigError as error:
        raise ConfigError(f"{where}: {error.where}", error.expected, error.found, error.remedy) from None


def _from_motions(where, motions, settings, rate):
    samples, names = _samples(motions), list(motions)
    strange = sorted(set(settings.references) - set(names))
    if strange:
        raise ConfigError("response_functions.references", f"channels of motion: {', '.join(names)}",
                          ", ".join(strange))
    references = settings.references or (names[int(samples.std(axis=1).argmax())],)
    found = _of(where, estimate.from_motions, samples, [names.index(r) for r in references], rate, settings.resolution)
    return _test(found, METHODS["motions_alone"], motions, {r: motions[r] for r in references},
                 "{motion}*{reference}*s", "with")


def _given(where, run, settings):
    """TestResponses of the frequency responses that a run holds."""
    axes = {tuple(np.round(f.frequency, 9)) for f in run.frf.values()}
    if len(axes) > 1:
        raise ConfigError(where, "frequency responses on one frequency axis", f"{len(axes)} axes")
    line = np.asarray(next(iter(run.frf.values())).frequency, float)
    response, remark = _turned(where, run.frf, settings.phase)
    return TestResponses(
        line=line, response=response, coherence=np.empty((0, len(line))),
        label=list(run.frf), unit=[str(f.unit) for f in run.frf.values()],
        place=[str(f.place) or key for key, f in run.frf.items()],
        reference=[str(f.reference) for f in run.frf.values()], method="given", averages=[0], left_out=[],
        decay=_window(line, settings), remark=remark)


def _turned(where, given, phase):
    """(responses (n, f) of FrequencyResponses ``given`` {name: one}, with phases that follow the force; remarks)."""
    response = np.array([one.response for one in given.values()])
    sense = estimate.sense_of_phase(response)
    sizes = [name for name, one in zip(given, sense, strict=True) if np.isnan(one)]
    if sizes:
        raise ConfigError(where, "complex responses", f"values of one phase, such as sizes alone, in"
                          f" {first_of(sizes, _NAMED)}",
                          "damping and shapes need the phase: export real and imaginary parts, or size and phase")
    turned = [name for name, one in zip(given, sense, strict=True) if one < 0]
    if phase == "conjugate":
        return response.conj(), ["phases were turned, as the case says: the conjugate of each response is used"]
    if phase == "as_given":
        return response, []
    if turned and np.any(sense > 0):
        raise ConfigError(where, "phases of one sign", f"the opposite sign in {first_of(turned, _NAMED)}: they would"
                          " come before their force", "export all responses alike, or choose runs of one sign")
    if turned:
        return response.conj(), ["phases have the opposite sign, as of exp(-i w t) or S_fx for S_xf: responses would"
                                 " come before their force, so the conjugate of each is used; response_functions.phase"
                                 " as_given leaves them"]
    return response, [] if sense.any() else [
        "the sign of the phases does not show, as lines are too far apart, or noise prevails: it is taken as given"]


def _window(line, settings):
    """Decay rate in 1/s of the exponential window that the case states of given responses."""
    if settings.window_end is None:
        return settings.window_decay or 0.0
    return float(-np.log(settings.window_end) * (line[1] - line[0]))


def _channels(where, run, asked, units, kind):
    """{name: Channel} of a run in one of the ``units``: those ``asked`` for, or all."""
    found = {name: one for name, one in run.channels.items() if str(one.unit) in units and (not asked or name in asked)}
    wrong = [f"{name} in {run.channels[name].unit}" if name in run.channels else name
             for name in asked if name not in found]
    if wrong:
        raise ConfigError(f"response_functions.{kind}", f"channels of {where.rpartition(' ')[2]} in"
                          f" {' or '.join(units)}", ", ".join(wrong))
    return found


def _one_grid(where, channels):
    """The sampling rate of channels that were sampled together, without gaps."""
    grids = {(float(one.rate), float(one.begin), len(one.samples)) for one in channels.values()}
    if len(grids) > 1:
        raise ConfigError(where, "force and motion sampled at the same instants",
                          f"{len(grids)} different rates, begins or lengths", "name channels that were")
    holes = [name for name, one in channels.items() if len(one.missing)]
    if holes:
        raise ConfigError(where, "records without gaps", f"gaps in {', '.join(holes)}",
                          "cut the record into runs beside them, or leave the channel out")
    return next(iter(grids))[0]


def _samples(channels):
    return np.array([np.asarray(one.samples, float) for one in channels.values()])


def _joined(tests):
    """TestResponses of several tests on one frequency axis, the axis of the shortest common one."""
    every = list(tests.values())
    grids = {(len(one.line), round(float(one.line[1] - one.line[0]), 9)) for one in every}
    decays = np.array([one.decay for one in every])
    if len(grids) > 1:
        raise ConfigError("response_functions.together", "runs on one frequency axis", f"{len(grids)} axes",
                          "cut the blows to one length, or state a resolution")
    if np.ptp(decays) > 1e-9:
        raise ConfigError("response_functions.together", "runs with one window", f"decays of {decays.min():.3g} to"
                          f" {decays.max():.3g} 1/s")
    coherence = [one.coherence for one in every]

    def listed(field):
        return [str(value) for one in every for value in getattr(one, field)]

    return TestResponses(
        line=every[0].line, response=np.concatenate([one.response for one in every]),
        coherence=np.concatenate(coherence), unit=listed("unit"), place=listed("place"),
        reference=listed("reference"), label=[f"{run}: {label}" for run, one in tests.items() for label in one.label],
        method=", ".join(dict.fromkeys(str(one.method) for one in every)), decay=decays[0],
        averages=np.concatenate([one.averages for one in every]), remark=list(dict.fromkeys(
            f"{run}: {told}" for run, one in tests.items() for told in map(str, one.remark))),
        left_out=[f"{run}, {told}" for run, one in tests.items() for told in one.left_out])
