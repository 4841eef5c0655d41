"""A bench: what makes a recording, from the moving bodies to the numbers that its sensors write.

    respond(bench, run) -> {channel: samples at the run's rate}

A channel shows clip(gain filtered(x(t - delay)) + offset + drift t), x being what it looks at. Contact forces, known
as means over steps, are brought to instants, so that nothing is late by half a step.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped, changed
from pipeline.physics.friction.dry_friction import Friction, under
from pipeline.physics.sliding.model import SlidingModel
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import History, Start, simulate
from pipeline.physics.virtual_rig.normal_load import loaded

MOTIONS = ("displacement", "velocity", "acceleration")
FORCES = ("joint_force", "normal_force", "friction_force", "element_force", "input")


@dataclass(frozen=True)
class Channel:
    """A sensor: ``source`` is the sensor, joint, contact group, element or input whose ``quantity`` it shows.

    ``gain`` in units shown per SI unit, ``delay`` s, ``offset`` and ``drift`` (per s) in units shown, ``corner`` Hz of
    a first-order low pass, ``limit`` in units shown, at which it clips.
    """

    name: str
    quantity: str
    source: str
    gain: float = 1.0
    delay: float = 0.0
    offset: float = 0.0
    drift: float = 0.0
    corner: float = np.inf
    limit: float = np.inf

    def __post_init__(self):
        if self.quantity not in MOTIONS + FORCES:
            raise ConfigError(f"channel {self.name}: quantity", f"one of {', '.join(MOTIONS + FORCES)}",
                              repr(self.quantity))
        if not (self.delay >= 0 and self.corner > 0 and self.limit > 0):
            raise ConfigError(f"channel {self.name}", "delay >= 0, corner > 0 and limit > 0",
                              f"{self.delay:g} s, {self.corner:g} Hz, {self.limit:g}")


@dataclass(frozen=True)
class Run:
    """What was done: ``inputs`` {name: N, one value or samples}, ``drive`` rad/s (None: that of the model).

    Samples are at ``sample_rate`` Hz from time 0. ``conditions`` {name: value} stand in for inputs of their names,
    ``speed`` for the drive, ``normal_load`` for the loads of friction joints; friction may depend on others. ``start``:
    where the bodies are at time 0, else as the bench says.
    """

    name: str
    duration: float
    sample_rate: float
    inputs: dict = field(default_factory=dict)
    drive: object = None
    conditions: dict = field(default_factory=dict)
    start: Start | None = None

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

    @property
    def time(self):
        """Instants (samples,) in s."""
        return np.arange(self.samples) / self.sample_rate


@dataclass(frozen=True)
class Bench:
    """Moving bodies, laws of contact and friction (of all contacts, or Grouped), and the sensors.

    ``step`` s is the longest step taken; ``groups`` {name: indices} names contacts, all of them ``contact`` by default;
    ``doublets`` {name: (i, j)} names pairs of coordinates that are two modes of (nearly) one frequency; ``settled``:
    runs start in steady sliding under their first inputs, else at rest in the origin.
    """

    model: SlidingModel
    law: object
    friction: Friction | Grouped
    step: float
    channels: tuple
    groups: dict = field(default_factory=dict)
    settled: bool = False
    doublets: dict = field(default_factory=dict)

    def contacts(self, group):
        """Indices (k,) of the contacts of ``group``."""
        groups = {"contact": np.arange(len(self.model.contacts.area)), **self.groups}
        return np.asarray(groups[_known(group, groups, "contact group")], int)

    def joint(self, name):
        """(row (n,), stiffness, damping) of a joint."""
        joints = self.model.joints
        k = joints.name.index(_known(name, joints.name, "joint"))
        return joints.rows[k], float(joints.stiffness[k]), float(joints.damping[k])

    def sensor(self, name, where="sensor"):
        """Displacement row (n,) of a sensor; ``where`` for messages."""
        model = self.model
        return model.sensor_rows[model.sensor_name.index(_known(name, model.sensor_name, where))]

    def with_law(self, group, change):
        """The bench with ``change(law)`` as the law of contact of ``group``."""
        return replace(self, law=changed(self.law, len(self.model.contacts.area), self.contacts(group), change))

    def with_friction(self, group, change):
        """The bench with ``change(friction)`` as the friction of ``group``."""
        count = len(self.model.contacts.area)
        return replace(self, friction=changed(self.friction, count, self.contacts(group), change))

    def input(self, name):
        """(row (n,), stiffness, damping) along an input, those of the supported bodies."""
        row = self.model.input_rows[self.model.input_name.index(_known(name, self.model.input_name, "input"))]
        _, damping, stiffness = self.model.supported()
        return row, float(row @ stiffness @ row), float(row @ damping @ row)

    def doublet(self, name):
        """(mass (2,), stiffness (2,)) and indices of the two coordinates of a doublet, the others held."""
        pair = list(self.doublets[_known(name, self.doublets, "doublet")])
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

    Gyroscopic and centrifugal terms are those of the speed with which the run begins, also in ``system``. Raises
    ConfigError for sources that the model does not have, and what ``simulate`` raises.
    """
    bench = loaded(bench, run)
    parts = max(1, int(np.ceil(1 / (run.sample_rate * bench.step) * (1 - 1e-12))))
    step = 1 / run.sample_rate / parts
    seen, model = _watched(bench)
    inputs, drive = run_inputs(bench, run), run_drive(bench, run)
    speed, first = at_begin(bench, run)
    model, start, friction = model.at_speed(speed), run.start, run_friction(bench, run)
    if start is None and bench.settled:
        start = steady_start(model, bench.law, friction, first)
    steps = (run.samples - 1) * parts
    motion = simulate(model, bench.law, friction, step=step, duration=steps * step, system=system, start=start,
                      inputs=_history(inputs, run), drive=_history([drive], run), book=False)
    return {channel.name: shown(channel, _looked_at(bench, run, channel, motion, seen, inputs, step), step)[::parts]
            for channel in bench.channels}


def shown(channel, values, step):
    """What a channel writes of ``values`` at equal steps (s)."""
    time = step * np.arange(len(values))
    if np.isfinite(channel.corner):
        values = low_pass(values, step, channel.corner)
    if channel.delay > 0:
        values = np.interp(time - channel.delay, time, values)
    return np.clip(channel.gain * values + (channel.offset + channel.drift * time), -channel.limit, channel.limit)


def low_pass(values, step, corner):
    """y' = w (x - y) with w = 2 pi ``corner``, exact where x is linear over the steps; y settled at the begin."""
    reach = 2 * np.pi * corner * step
    keep = np.exp(-reach)
    ramp = 1 - (1 - keep) / reach
    first, last = 1 - keep - ramp, ramp
    filtered, _ = scipy.signal.lfilter([last, first], [1.0, -keep], values, zi=[(1 - last) * values[0]])
    return filtered


def at_begin(bench, run):
    """(speed of the drive in rad/s, inputs (i,) in N) with which a run begins."""
    return (float(np.ravel(run_drive(bench, run))[0]),
            np.array([float(np.ravel(i)[0]) for i in run_inputs(bench, run)]))


def run_inputs(bench, run):
    """[one value or samples (samples,)] of each input of the model, in its order; 0 N where nothing is said."""
    unknown = set(run.inputs) - set(bench.model.input_name)
    if unknown:
        raise ConfigError(f"run {run.name}: input", f"one of {', '.join(bench.model.input_name)}",
                          ", ".join(sorted(unknown)))
    return [run.inputs.get(n, run.conditions.get(n, 0.0)) for n in bench.model.input_name]


def run_drive(bench, run):
    """Speed of the drive in rad/s: one value or samples (samples,)."""
    return run.drive if run.drive is not None else run.conditions.get("speed", bench.model.speed)


def run_friction(bench, run):
    """Friction of the bench under the conditions of the run."""
    return under(bench.friction, run.conditions, f"run {run.name}")


def _history(values, run):
    for value in values:
        if np.ndim(value) and len(value) != run.samples:
            raise ConfigError(f"run {run.name}", f"{run.samples} samples of each history", f"{len(value)}")
    if not any(np.ndim(v) for v in values):
        return History(np.reshape(np.array(values, float), (1, -1)), 1.0)
    return History(np.stack([np.broadcast_to(v, run.samples) for v in values], axis=1), 1 / run.sample_rate)


def _watched(bench):
    """({channel: sensor row}, model): the model with a sensor for every channel that needs a motion."""
    model, rows, index = bench.model, [], {}
    for channel in bench.channels:
        if channel.quantity in MOTIONS:
            index[channel.name] = len(rows)
            rows.append(bench.sensor(channel.source, f"channel {channel.name}: sensor"))
        elif channel.quantity == "joint_force":
            index[channel.name] = len(rows)
            rows.append(bench.joint(channel.source)[0])
    rows = np.reshape(np.array(rows, float), (-1, model.size))
    return index, replace(model, sensor_name=tuple(index), sensor_rows=rows)


def _looked_at(bench, run, channel, motion, seen, inputs, step):
    """What a channel looks at, at every step."""
    if channel.quantity in MOTIONS:
        row = seen[channel.name]
        if channel.quantity == "acceleration":
            return np.gradient(motion.velocity[row], step, edge_order=2)
        return getattr(motion, channel.quantity)[row]
    if channel.quantity == "joint_force":
        _, stiffness, damping = bench.joint(channel.source)
        row = seen[channel.name]
        return stiffness * motion.displacement[row] + damping * motion.velocity[row]
    if channel.quantity == "element_force":
        names = [e.name for e in bench.model.elements]
        return motion.element_force[names.index(_known(channel.source, names, f"channel {channel.name}: element"))]
    if channel.quantity == "input":
        names = bench.model.input_name
        value = inputs[names.index(_known(channel.source, names, f"channel {channel.name}: input"))]
        return np.interp(motion.time, run.time, np.broadcast_to(value, run.samples))
    force = motion.normal_force if channel.quantity == "normal_force" else motion.friction_force
    return at_instants(force[bench.contacts(channel.source)].sum(axis=0))


def at_instants(means):
    """Values at the ends of steps from ``means`` (steps + 1,) over the step before, second order; the first is kept."""
    if len(means) < 3:
        return means
    after = np.append(means[2:], 2 * means[-1] - means[-2])
    return np.append(means[0], (means[1:] + after) / 2)


def _known(name, names, where):
    if name not in names:
        expected = f"one of {', '.join(names)}" if names else "a name that the model defines; it defines none"
        raise ConfigError(f"bench: {where}", expected, repr(name))
    return name
