"""From a reduced model and the section ``bench`` of a case to a Bench: laws, sensors, corrected values, effects."""

from dataclasses import replace
from typing import Literal

import numpy as np

from pipeline.case_models import corrections
from pipeline.case_models.laws import Laws, friction_law, normal_law
from pipeline.contract import ConfigError, Quantities, Quantity, Section, option
from pipeline.physics.sliding.doublets import doublets
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.virtual_rig.response import Bench
from pipeline.physics.virtual_rig.sensor import MEASURANDS, Sensor, measurand

#: what positive values of channels mean, in the words of the schema
SIGNS = ("positive: a motion along the sensor, joint_force in tension (between: [a, b], a beyond b), normal_force in"
         " compression, friction_force on the rubbing mass along tangent, element_force against the elongation, input"
         " as it acts")
#: most contacts of a group that an answer lists by name
_READABLE = 6


class ChannelSettings(Section):
    """What a recorded channel shows of the model; gain -1 for one that counts the other way."""

    quantity: str = option(..., f"one of {', '.join(MEASURANDS)}; {SIGNS}")
    source: str = option(..., "sensor, joint, contact group, element or input whose quantity it shows")
    gain: float | None = option(None, "in SI units shown per SI unit; none = 1, of a channel in the unit of its"
                                      " quantity")
    delay: Quantity("s", ge=0) = option("0 s", "delay")
    corner: Quantity("Hz", gt=0) | None = option(None, "corner of its first-order low pass; none = no filter")
    limit: float | None = option(None, "SI value at which it clips; none = never", gt=0)


class Fed(Section):
    """A recorded channel that feeds an input."""

    channel: str = option(..., "recorded channel")
    gain: float | None = option(None, "in SI units of the input per SI unit of the channel; none = 1, of a"
                                      " channel in the unit of the input")
    derivative: bool = option(False, "the rate of change of the channel feeds it: a recorded position gives a speed")
    hold: Literal["linear", "step", "band_limited"] = option(
        "linear", "between samples; step: each is held until the next, as converters do; band_limited: nothing lies"
        " above half the sample rate (an anti-aliasing filter)")


class Course(Section):
    """Speeds through which the far end of a spring was led in one run: velocity steps, holds between slides."""

    at: Quantities("s", ge=0) = option(..., "instants, rising, from each of which its speed holds; before: at rest")
    speed: Quantities("m/s") = option(..., "speeds, one for each instant")


class Equation(Section):
    """How measured displacements are put into the equation of motion."""

    corner: Quantity("Hz", gt=0) | None = option(
        None, "corner of the low pass of displacements, Butterworth of order 4 run forth and back; none = no filter")
    decimation: int = option(1, "every so many samples are kept, behind a low pass", ge=1)
    trim: int = option(0, "samples left out at both ends of a run, where filters settle", ge=0)


class Onset(Section):
    """Stops that squeal: the mode that grows between noise floor and saturation is compared."""

    runs: tuple[str, ...] = option((), "runs that are such stops, also as patterns (stop_*), with their repeats; none"
                                       " = those whose drive turns and whose motions grow until they saturate")
    share: float = option(0.2, "fraction of the saturated amplitude up to which growth is fitted", gt=0, lt=1)
    held: dict[str, float] = option({}, "recorded channel that has to hold while it squeals, as pressure or speed:"
                                        " largest change within the window of growth, as a fraction of its mean")


class Poles(Section):
    """Free vibrations are compared by their poles: taps and growth phases, each recorded twice."""

    low: Quantity("Hz", gt=0) = option("200 Hz", "lowest frequency at which poles are looked for")
    high: Quantity("Hz", gt=0) = option("5 kHz", "highest frequency")
    saturation: float = option(0.12, "share of the largest amplitude up to which growth counts as free", gt=0, le=1)
    resolution: float = option(1e-3, "least standard deviation of a pole as a share of its frequency: what the modes"
                                     " that the model leaves out may do", gt=0)
    onset: Onset | None = option(None, "stops that squeal, compared by their growth; none = runs are taps")


class Settings(Laws):
    """Sensors, laws and inputs of the bench that was recorded."""

    forward: Literal["simulation", "equation"] = option(
        "simulation", "simulation: runs are simulated; equation: measured displacements are put into the equation of"
        " motion, and its forces are compared with those applied")
    equation: Equation = option(Equation(), "how that is done")
    step: Quantity("s", gt=0) = option("0.1 ms", "longest time step; samples are divided evenly; not needed where"
                                                " forward is equation")
    speed: Quantity("rad/s") = option("1 rad/s", "speed of the drive where a run tells none")
    channels: dict[str, ChannelSettings] = option({}, "recorded channel: what it shows")
    inputs: dict[str, Fed] = option({}, "input of the model: the recorded channel that feeds it")
    courses: dict[str, dict[str, Course]] = option({}, "input of the model that displaces a spring: by run, the speeds"
                                                       " of its far end, where no channel recorded its motion")
    drive: Fed | None = option(None, "recorded channel with the speed of the drive in rad/s (belts: m/s)")
    settled: bool = option(False, "runs start in steady sliding under their first inputs, else at rest")
    settle: Quantity("s", ge=0) = option("0 s", "begin of every run that is not compared: an unknown start dies away")
    start: Literal["rest", "fitted"] | None = option(
        None, "state in which runs begin; rest: at rest, or as settled says; fitted: estimated with its uncertainty"
        " from all channels of each run; none = fitted in runs that move where the model at rest would not, as free"
        " decays do")
    blow: str | None = option(None, "input on which a hammer of unknown force struck once in every run, at rest before:"
                                    " impulse, time and contact time of a half-sine pulse are fitted; none = no blow")
    measured_start: bool = option(False, "the same as start: fitted, in older cases")
    state: int = option(0, "state of the model whose preload is used", ge=0)
    poles: Poles | None = option(None, "compare poles, sensor ratios and order-locked forces; none = samples")
    corrections: dict[str, str | float] = option({}, "nominal values in place of those of the model, as in"
                                                 " joints.guide.damping: 220 N s/m")


def built(model, settings):
    """The Bench of a product ReducedModel and a filled section, without effects. ConfigError for unknown names."""
    channels = tuple(_sensor(name, given) for name, given in settings.channels.items())
    bench = about(model, settings, "bench", settings.state, settings.speed, settings.step)
    bench = replace(bench, channels=channels, settled=settings.settled)
    for sensor in bench.channels:
        _check_source(bench, sensor)
    return corrections.corrected(bench, corrections.read(bench, settings.corrections, "bench.corrections"))


def about(model, laws, where, state, speed, step):
    """The Bench of a product ReducedModel about one state and speed, under Laws, without sensors or effects.

    ``where`` is the stage that the laws belong to, for messages.
    """
    if state >= len(model.preload):
        raise ConfigError(f"{where}.state", f"a row of the preload table, 0 to {len(model.preload) - 1}", str(state))
    sliding = sliding_model(model, state, speed)
    return Bench(sliding, normal_law(model, sliding.contacts, laws, where),
                 friction_law(model, sliding.contacts, laws, where), step, (), groups(model),
                 doublets=doublets(sliding))


def groups(model):
    """Contacts of each body by its name, where several bodies rub; ``model`` is a product ReducedModel."""
    rubbed = [str(model.body_name[k]) for k in model.contact_body]
    names = dict.fromkeys(rubbed)
    return {name: tuple(k for k, g in enumerate(rubbed) if g == name) for name in names} if len(names) > 1 else {}


def contact_names(model):
    """{group: names that the case gives to its contacts} of a product ReducedModel; none where they are many."""
    members = {"contact": range(len(model.contact_name)), **groups(model)}
    named = {group: tuple(str(model.contact_name[k]) for k in rows) for group, rows in members.items()}
    return {group: names for group, names in named.items() if all(names) and 0 < len(names) <= _READABLE}


def _sensor(name, settings):
    gain = 1.0 if settings.gain is None else settings.gain
    return Sensor(name, measurand(settings.quantity, f"bench.channels.{name}.quantity"), settings.source,
                  gain, settings.delay, corner=np.inf if settings.corner is None else settings.corner,
                  limit=np.inf if settings.limit is None else settings.limit)


def _check_source(bench, sensor):
    names = sensor.measurand.sources(bench)
    if sensor.measurand.in_model and sensor.source not in names:
        raise ConfigError(f"bench.channels.{sensor.name}.source",
                          f"one of {', '.join(names)}" if names else "one that the model defines",
                          repr(sensor.source), "name a part of the model, or add it")


def only(bench, names):
    """The bench with the channels ``names`` alone, in that order."""
    known = {c.name: c for c in bench.channels}
    return replace(bench, channels=tuple(known[name] for name in names))
