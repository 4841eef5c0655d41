"""A bench: what makes a recording, from the moving bodies to the numbers that its sensors write.

    respond(bench, run) -> {channel: samples at the run's rate}
"""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped, changed
from pipeline.physics.friction.dry_friction import Friction, under
from pipeline.physics.sliding.model import SlidingModel
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import History, Start, stepper
from pipeline.physics.virtual_rig.inputs import holding, resolved, run_inputs
from pipeline.physics.virtual_rig.normal_load import loaded
from pipeline.physics.virtual_rig.sensor import SimulatedRun, known

#: relative excess at which a step counts as the one that was stated: nine digits may be all that is
_EVEN = 1e-6
#: of the first four of equal distance on a cubic, what adds up to the one before
_ONE_MORE = np.array([4.0, -6.0, 4.0, -1.0])


@dataclass(frozen=True)
class Run:
    """What was done: ``inputs`` {name: N, or m where it moves the end of a joint, one value or samples}, ``drive``
    rad/s (None: that of the model).

    Samples are at ``sample_rate`` Hz from time 0, linear between; those of inputs named in ``held`` are held until the
    next, those named in ``band_limited`` hold nothing above half that rate. ``conditions`` {name: value} stand in for
    inputs of their names, ``speed`` for the drive, ``normal_load`` for the loads of friction joints; friction may
    depend on others. ``start``: where the bodies are at time 0, else as the bench says. ``pulses`` {input: HalfSine}
    act on top of the inputs. Steps of the bench resolve pulses and what is band-limited.
    """

    name: str
    duration: float
    sample_rate: float
    inputs: dict = field(default_factory=dict)
    drive: object = None
    conditions: dict = field(default_factory=dict)
    start: Start | None = None
    held: tuple = ()
    band_limited: tuple = ()
    pulses: dict = field(default_factory=dict)

    def __post_init__(self):
        if not (self.sample_rate > 0 and self.duration * self.sample_rate >= 1):
            raise ConfigError(f"run {self.name}", "a sample rate above 0 and at least one interval",
                              f"{self.sample_rate:g} Hz for {self.duration:g} s")

    def until(self, kept):
        """The run cut to its first ``kept`` samples, at least two."""
        def cut(history):
            return history[:kept] if np.ndim(history) else history

        return replace(self, duration=(kept - 1) / self.sample_rate, drive=cut(self.drive),
                       inputs={name: cut(history) for name, history in self.inputs.items()})

    @property
    def samples(self):
        """Number of samples, both ends counted."""
        return round(self.duration * self.sample_rate) + 1

    def step(self, longest):
        """Time step in s that divides the time between samples evenly and is, but for rounding, at most ``longest``."""
        return 1 / self.sample_rate / max(1, int(np.ceil(1 / (self.sample_rate * longest) * (1 - _EVEN))))

    @property
    def time(self):
        """Instants (samples,) in s."""
        return np.arange(self.samples) / self.sample_rate


@dataclass(frozen=True)
class Bench:
    """Moving bodies, laws of contact and friction (of all contacts, or Grouped), and Sensors as its ``channels``.

    ``step`` s is the longest step taken; ``groups`` {name: indices} names contacts, all of them ``contact`` by default;
    ``doublets`` {name: (i, j)} names pairs of coordinates that are two modes of (nearly) one frequency; ``settled``:
    runs start in steady sliding under their first inputs, else at rest in the origin. ``stated``: what a case states
    that it lacks or has beside the model, and what it was without, for those who change the values.
    """

    model: SlidingModel
    law: object
    friction: Friction | Grouped
    step: float
    channels: tuple
    groups: dict = field(default_factory=dict)
    settled: bool = False
    doublets: dict = field(default_factory=dict)
    stated: object = None

    def contacts(self, group):
        """Indices (k,) of the contacts of ``group``."""
        groups = {"contact": np.arange(len(self.model.contacts.area)), **self.groups}
        return np.asarray(groups[known(group, groups, "contact group")], int)

    def joint(self, name):
        """(row (n,), stiffness, damping) of a joint."""
        joints = self.model.joints
        k = joints.name.index(known(name, joints.name, "joint"))
        return joints.rows[k], float(joints.stiffness[k]), float(joints.damping[k])

    def sensor(self, name, where="sensor"):
        """Displacement row (n,) of a sensor; ``where`` for messages."""
        model = self.model
        return model.sensor_rows[model.sensor_name.index(known(name, model.sensor_name, where))]

    def with_law(self, group, change):
        """The bench with ``change(law)`` as the law of contact of ``group``."""
        return replace(self, law=changed(self.law, len(self.model.contacts.area), self.contacts(group), change))

    def with_friction(self, group, change):
        """The bench with ``change(friction)`` as the friction of ``group``."""
        count = len(self.model.contacts.area)
        return replace(self, friction=changed(self.friction, count, self.contacts(group), change))

    def input(self, name):
        """(row (n,), stiffness, damping) along an input, those of the supported bodies."""
        row = self.model.input_rows[self.model.input_name.index(known(name, self.model.input_name, "input"))]
        _, damping, stiffness = self.model.supported()
        return row, float(row @ stiffness @ row), float(row @ damping @ row)

    def doublet(self, name):
        """(mass (2,), stiffness (2,)) and indices of the two coordinates of a doublet, the others held."""
        pair = list(self.doublets[known(name, self.doublets, "doublet")])
        mass, _, stiffness = self.model.supported(gyroscopic=False, centrifugal=False)
        return mass[pair, pair], stiffness[pair, pair], pair

    def with_elements(self, *elements):
        """The bench with these elements added to its model."""
        return replace(self, model=replace(self.model, elements=(*self.model.elements, *elements)))

    def with_channels(self, change):
        """The bench with ``change(channel)`` in place of each channel."""
        return replace(self, channels=tuple(change(c) for c in self.channels))


def respond(bench, run, system=None):
    """{channel: (samples,)} of one run; ``system`` is the ModalSystem of the model, where runs share it.

    Gyroscopic and centrifugal terms follow the speed of the drive; ``system`` holds those of its first value. Raises
    ConfigError for sources that the model does not have, and what ``simulate`` raises.
    """
    return Responder(bench, system).respond(run)


@dataclass(frozen=True)
class Measured:
    """``parts`` [(values (steps + 1,), [(factor, part)])] of channels at every ``step`` s, before sensors write them;
    see ``Measurand.parts``."""

    step: float
    parts: tuple

    @property
    def size(self):
        """Bytes of its values."""
        return sum(values.nbytes for values, _ in self.parts)

    def between(self, parts):
        """The same at every of so many ``parts`` of its step as well: on the cubic through the four steps about them.
        """
        if parts == 1 or len(self.parts[0][0]) < len(_ONE_MORE):
            return self
        at = np.arange(parts) / parts
        weights = np.array([-at * (at - 1) * (at - 2) / 6, (at + 1) * (at - 1) * (at - 2) / 2,
                            -(at + 1) * at * (at - 2) / 2, (at + 1) * at * (at - 1) / 6])

        def finer(values):
            beyond = [end[:len(_ONE_MORE)] @ _ONE_MORE for end in (values, values[::-1])]
            about = sliding_window_view(np.concatenate((beyond[:1], values, beyond[1:])), 4)
            return np.append((about @ weights).ravel(), values[-1])

        return Measured(self.step / parts, tuple((finer(values), sharp) for values, sharp in self.parts))


class Responder:
    """Answers of one Bench to many runs, which share what depends on speed, step and friction alone.

    ``system`` is the ModalSystem of the model, where there is one already; ``halvings``: how often the steps of the
    bench are halved; below 0 doubled, and what is measured is interpolated on those of the bench.
    """

    def __init__(self, bench, system=None, halvings=0):
        self.bench, self._system, self._steppers = bench, system, {}
        self._finer, self._longer = 2**max(halvings, 0), 2**max(-halvings, 0)
        self._rows, self._model = _watched(bench)

    def respond(self, run):
        """{channel: (samples,)} of a Run; errors as of ``respond``."""
        return self.written(run, self.measured(run))

    def written(self, run, measured):
        """{channel: (samples,)} of what was ``measured`` in a Run, here or on a bench that differs in the numbers of
        its channels alone."""
        parts, written = round(1 / run.sample_rate / measured.step), {}
        for sensor, (values, sharp) in zip(self.bench.channels, measured.parts, strict=True):
            begin = len(values) - 1 - (run.samples - 1) * parts     # steps of a way that leads to the run
            written[sensor.name] = sensor.written(values, measured.step, sharp, begin)[begin::parts]
        return written

    def measured(self, run):
        """Measured of the channels in a Run, the way included that leads to it; errors as of ``respond``."""
        bench, run = self.bench, led_in(self.bench, run)
        step = run.step(bench.step * self._longer) / self._finer
        parts = round(1 / run.sample_rate / step)
        driven, inputs = resolved(bench, run, parts)
        speed, first = at_begin(bench, run)
        under_load = loaded(bench, run)
        friction = run_friction(under_load, run)
        stepping = self._stepper(under_load, friction, speed, step)
        start, steps = run.start, (run.samples - 1) * parts
        if start is None and bench.settled:
            start = steady_start(stepping.model, bench.law, friction, first)
        motion = stepping.run(steps * step, start=start, inputs=_history(inputs, driven, holding(bench, run)),
                              drive=_history([run_drive(bench, run)], run), book=False)
        simulated = SimulatedRun(under_load, driven, motion, inputs, step, self._rows)
        measured = Measured(step, tuple(sensor.measurand.parts(simulated, sensor) for sensor in bench.channels))
        return measured.between(int(np.ceil(step / run.step(bench.step) - _EVEN)))

    def _stepper(self, bench, friction, speed, step):
        """Stepper of the bench under the load of a run; runs without one share that of their speed, step and friction.
        """
        if bench is not self.bench:
            return stepper(_watched(bench)[1].at_speed(speed), bench.law, friction, step, self._system)
        shared_friction, shared = self._steppers.get((speed, step), (None, None))
        if friction is not shared_friction:
            shared = stepper(self._model.at_speed(speed), bench.law, friction, step, self._system)
            self._steppers[speed, step] = friction, shared
        return shared


def led_in(bench, run):
    """The Run, or where a bench is settled and the end of a joint moves from the begin, that with a way of half its
    length before time 0 on which ends move as they begin: dry friction takes a way to settle."""
    moving = [u for name, u in run.inputs.items() if name in bench.model.moved_ends and np.ndim(u) and u[1] != u[0]]
    otherwise = run.start is not None or run.pulses or run.held or run.band_limited
    if not (bench.settled and moving) or otherwise or any(map(np.ndim, run.conditions.values())):
        return run
    way = -np.arange(run.samples // 2, 0, -1)

    def before(name, values):
        values = np.asarray(values)
        slope = values[1] - values[0] if name in bench.model.moved_ends else 0.0
        return np.concatenate((values[0] + slope * way, values))

    drive = before("", run.drive) if np.ndim(run.drive) else run.drive
    inputs = {name: before(name, u) if np.ndim(u) else u for name, u in run.inputs.items()}
    return replace(run, duration=run.duration + len(way) / run.sample_rate, inputs=inputs, drive=drive)


def at_begin(bench, run):
    """(speed of the drive in rad/s, inputs (i,) in N) with which a run begins."""
    return (float(np.ravel(run_drive(bench, run))[0]),
            np.array([float(np.ravel(i)[0]) for i in run_inputs(bench, run)]))


def run_drive(bench, run):
    """Speed of the drive in rad/s: one value or samples (samples,)."""
    return run.drive if run.drive is not None else run.conditions.get("speed", bench.model.speed)


def run_friction(bench, run):
    """Friction of the bench under the conditions of the run."""
    return under(bench.friction, run.conditions, f"run {run.name}")


def _history(values, run, held=False):
    for value in values:
        if np.ndim(value) and len(value) != run.samples:
            raise ConfigError(f"run {run.name}", f"{run.samples} samples of each history", f"{len(value)}")
    if not any(np.ndim(v) for v in values):
        return History(np.reshape(np.array(values, float), (1, -1)), 1.0)
    return History(np.stack([np.broadcast_to(v, run.samples) for v in values], axis=1), 1 / run.sample_rate, held)


def _watched(bench):
    """({sensor name: row}, model): the model with a row for every sensor that needs a motion."""
    model = bench.model
    rows = {sensor.name: row for sensor in bench.channels if (row := sensor.row(bench)) is not None}
    stacked = np.reshape(np.array(list(rows.values()), float), (-1, model.size))
    return {name: k for k, name in enumerate(rows)}, replace(model, sensor_name=tuple(rows), sensor_rows=stacked)
