"""A sensor: what it measures of a bench, and what it writes of it.

A measurand knows its unit, the parts of a bench that it can be read from, the displacement row that it needs, its
values in a simulated run and its response to small motions. A sensor writes

    clip(gain filtered(x(t - delay)) + offset + drift t)

An acceleration takes part in every change of an input that acts on a mass: that part of it is M^-1 times the input
itself, and only the rest, which is smooth, is differentiated. Of inputs that are held, which jump, and of pulses, which
may be shorter than a step, that part is filtered and delayed in closed form.

Contact forces, known as means over steps, are interpolated to instants, so that no channel lags by half a step.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: share of a sample by which rounding may put an instant before it
_ROUNDING = 1e-6
#: time constants after which a filter has forgotten all but a thousandth
_FADED = 7.0


@dataclass(frozen=True)
class SimulatedRun:
    """A simulated ``run`` of a ``bench``: ``motion`` at every ``step`` s, ``inputs`` [one value or samples], N.

    ``rows`` {sensor name: index of its row in the motion}.
    """

    bench: object
    run: object
    motion: object
    inputs: list
    step: float
    rows: dict


@dataclass(frozen=True)
class Measurand(ABC):
    """A quantity that a sensor measures at a ``source``, in SI ``unit``; its ``name`` is that of YAML and products.

    ``in_model``: whether the model alone has all sources, before effects add theirs.
    """

    name: str
    unit: str
    in_model = True

    @abstractmethod
    def sources(self, bench):
        """Names of the parts of a Bench that it can be read from."""

    def row(self, bench, source, sensor):
        """Displacement row (n,) whose motion it is read from, None where it needs none; ``sensor`` for messages."""
        return

    @abstractmethod
    def history(self, simulated, sensor):
        """Values (steps + 1,) of a Sensor in a SimulatedRun, as far as steps resolve them."""

    def parts(self, simulated, sensor):
        """(``history``, [(factor, part)] that come on top and that steps do not resolve: Held or HalfSine, in N)."""
        return self.history(simulated, sensor), ()

    def response(self, bench, source, moves, rate):
        """(f,) where the coordinates move by ``moves`` (n, f) exp(``rate`` t); 0 for forces in contacts and inputs."""
        return np.zeros(len(rate), complex)


@dataclass(frozen=True)
class Motion(Measurand):
    """The time derivative of this ``order`` of a displacement."""

    order: int

    def sources(self, bench):
        return bench.model.sensor_name

    def row(self, bench, source, sensor):
        return bench.sensor(source, f"channel {sensor}: sensor")

    def history(self, simulated, sensor):
        motion, k = simulated.motion, simulated.rows[sensor.name]
        return (motion.displacement, motion.velocity)[self.order][k]

    def response(self, bench, source, moves, rate):
        return rate ** self.order * (bench.sensor(source) @ moves)


@dataclass(frozen=True)
class Acceleration(Motion):
    """What inputs give a mass at once, and the rest of its velocity, differentiated."""

    def history(self, simulated, sensor):
        return self.parts(simulated, sensor)[0]

    def parts(self, simulated, sensor):
        run, at_once, sharp = simulated.run, 0.0, []
        velocity = simulated.motion.velocity[simulated.rows[sensor.name]]
        for name, given, share in _acting(simulated, sensor):
            if name in run.held:
                impulse = np.append(0.0, np.cumsum(given[:-1]))
                sharp.append((share, Held(given[:-1], simulated.step)))
            else:
                impulse = scipy.integrate.cumulative_trapezoid(given, initial=0.0)
                at_once = at_once + share * given
            if name in run.pulses:
                at_once = at_once - share * run.pulses[name].force(len(given), 1 / simulated.step)
                sharp.append((share, run.pulses[name]))
            velocity = velocity - share * simulated.step * impulse
        return at_once + np.gradient(velocity, simulated.step, edge_order=2), sharp


class JointForce(Measurand):
    """Force of the spring and the damper of a joint, whose far end may be moved by inputs."""

    def sources(self, bench):
        return bench.model.joints.name

    def row(self, bench, source, sensor):
        return bench.joint(source)[0]

    def history(self, simulated, sensor):
        _, stiffness, damping = simulated.bench.joint(sensor.source)
        motion, k = simulated.motion, simulated.rows[sensor.name]
        force = stiffness * motion.displacement[k] + damping * motion.velocity[k]
        ends = (n for n, joint in simulated.bench.model.moved_ends.items() if joint == sensor.source)
        return force - sum(_applied(simulated, name) for name in ends)

    def response(self, bench, source, moves, rate):
        row, stiffness, damping = bench.joint(source)
        return (stiffness + rate * damping) * (row @ moves)


@dataclass(frozen=True)
class ContactForce(Measurand):
    """Sum over the contacts of a group; ``component`` is the field of a motion that holds it."""

    component: str

    def sources(self, bench):
        return ("contact", *bench.groups)

    def history(self, simulated, sensor):
        force = getattr(simulated.motion, self.component)
        return at_instants(force[simulated.bench.contacts(sensor.source)].sum(axis=0))


class ElementForce(Measurand):
    """Force of an element, those of effects included."""

    in_model = False

    def sources(self, bench):
        return tuple(e.name for e in bench.model.elements)

    def history(self, simulated, sensor):
        names = self.sources(simulated.bench)
        return simulated.motion.element_force[names.index(known(sensor.source, names,
                                                                f"channel {sensor.name}: element"))]


class InputForce(Measurand):
    """Force of an input."""

    def sources(self, bench):
        return bench.model.input_name

    def history(self, simulated, sensor):
        return _applied(simulated, known(sensor.source, self.sources(simulated.bench), f"channel {sensor.name}: input"))


def _acting(simulated, sensor):
    """[(name, force (steps + 1,) in N, acceleration of a Sensor per N)] of the inputs that vary."""
    model = simulated.bench.model
    acting = [i for i, value in enumerate(simulated.inputs) if np.ndim(value)]
    if not acting:
        return []
    shares = sensor.row(simulated.bench) @ np.linalg.solve(model.mass, model.input_rows[acting].T)
    return [(model.input_name[i], _applied(simulated, model.input_name[i]), share)
            for i, share in zip(acting, shares, strict=True)]


def _applied(simulated, name):
    """Force (steps + 1,) of an input in a SimulatedRun."""
    run, value = simulated.run, simulated.inputs[simulated.bench.model.input_name.index(name)]
    samples = np.broadcast_to(value, run.samples)
    if name in run.held:
        return samples[np.floor(simulated.motion.time * run.sample_rate + _ROUNDING).astype(int)]
    return np.interp(simulated.motion.time, run.time, samples)


DISPLACEMENT, VELOCITY = Motion("displacement", "m", 0), Motion("velocity", "m/s", 1)
ACCELERATION = Acceleration("acceleration", "m/s^2", 2)
JOINT_FORCE, ELEMENT_FORCE = JointForce("joint_force", "N"), ElementForce("element_force", "N")
INPUT_FORCE = InputForce("input", "N")
NORMAL_FORCE = ContactForce("normal_force", "N", "normal_force")
FRICTION_FORCE = ContactForce("friction_force", "N", "friction_force")
#: all of them by the names that YAML and products have for them
MEASURANDS = {m.name: m for m in (DISPLACEMENT, VELOCITY, ACCELERATION, JOINT_FORCE, NORMAL_FORCE, FRICTION_FORCE,
                                  ELEMENT_FORCE, INPUT_FORCE)}


def measurand(name, where):
    """The Measurand of this name; ConfigError for ``where`` if there is none."""
    if name not in MEASURANDS:
        raise ConfigError(where, f"one of {', '.join(MEASURANDS)}", repr(name))
    return MEASURANDS[name]


@dataclass(frozen=True)
class Sensor:
    """A channel of a bench: it measures ``measurand`` at ``source``, a sensor point, joint, contact group, ...

    ``gain`` in units written per SI unit, ``delay`` s, ``offset`` and ``drift`` (per s) in units written, ``corner`` Hz
    of a first-order low pass, ``limit`` in units written, at which it clips.
    """

    name: str
    measurand: Measurand
    source: str
    gain: float = 1.0
    delay: float = 0.0
    offset: float = 0.0
    drift: float = 0.0
    corner: float = np.inf
    limit: float = np.inf

    def __post_init__(self):
        if not (self.delay >= 0 and self.corner > 0 and self.limit > 0):
            raise ConfigError(f"channel {self.name}", "delay >= 0, corner > 0 and limit > 0",
                              f"{self.delay:g} s, {self.corner:g} Hz, {self.limit:g}")

    @property
    def moves(self):
        """Whether it measures a motion."""
        return isinstance(self.measurand, Motion)

    @property
    def lag(self):
        """Time in s for which it shows what happened before: its delay, and until its filter has forgotten."""
        return self.delay + (_FADED / (2 * np.pi * self.corner) if np.isfinite(self.corner) else 0.0)

    def row(self, bench):
        """Displacement row (n,) that it needs of a Bench, or None."""
        return self.measurand.row(bench, self.source, self.name)

    def written(self, values, step, sharp=(), begin=0):
        """What it writes of ``values`` (n,) at equal steps (s), with [(factor, part)] that are ``sharp`` on top; time 0
        is at step number ``begin``."""
        time = step * (np.arange(len(values)) - begin)
        if np.isfinite(self.corner):
            values = low_pass(values, step, self.corner)
        if self.delay > 0:
            values = np.interp(time - self.delay, time, values)
        for factor, part in sharp:
            values = values + factor * part.filtered(time - self.delay, self.corner)
        return np.clip(self.gain * values + (self.offset + self.drift * time), -self.limit, self.limit)

    def measured(self, written, time):
        """Values at ``time`` (n,) s of what was ``written`` (n,), with offset, drift, gain and delay undone."""
        shown = np.asarray(written, float) - self.offset - self.drift * time
        return np.interp(time + self.delay, time, shown / self.gain)

    def response(self, bench, moves, rate):
        """(f,) that it writes where the coordinates move by ``moves`` (n, f) exp(``rate`` t)."""
        value = self.measurand.response(bench, self.source, moves, rate)
        return value * (self.gain * np.exp(-rate * self.delay) / (1 + rate / (2 * np.pi * self.corner)))


def low_pass(values, step, corner):
    """y' = w (x - y) with w = 2 pi ``corner``, exact where x is linear over the steps; y starts settled."""
    reach = 2 * np.pi * corner * step
    keep = np.exp(-reach)
    ramp = 1 - (1 - keep) / reach
    first, last = 1 - keep - ramp, ramp
    filtered, _ = scipy.signal.lfilter([last, first], [1.0, -keep], values, zi=[(1 - last) * values[0]])
    return filtered


@dataclass(frozen=True)
class Held:
    """Values (n,), each ``held`` over one ``step`` (s) from time 0."""

    held: np.ndarray
    step: float

    def filtered(self, time, corner):
        """Values at ``time`` (m,) behind a first-order low pass of ``corner`` Hz, exact; settled before time 0. Without
        it, at a jump those after it."""
        late = time / self.step
        within = np.clip(np.floor(late + _ROUNDING).astype(int), 0, len(self.held) - 1)
        reach = 2 * np.pi * corner * self.step
        if not np.isfinite(reach):
            return self.held[within]
        keep = np.exp(-reach)
        ends = scipy.signal.lfilter([1 - keep], [1.0, -keep], self.held, zi=[keep * self.held[0]])[0]
        begins = np.append(self.held[0], ends)[within]
        return self.held[within] + (begins - self.held[within]) * np.exp(-reach * np.maximum(late - within, 0.0))


def at_instants(means):
    """Values at the ends of steps from ``means`` (steps + 1,) over the step before, second order; the first stays."""
    if len(means) < 3:
        return means
    following = np.append(means[2:], 2 * means[-1] - means[-2])
    return np.append(means[0], (means[1:] + following) / 2)


def known(name, names, where):
    """The ``name``, if it is among ``names``; ConfigError for ``where`` otherwise."""
    if name not in names:
        raise ConfigError(f"bench: {where}", f"one of {', '.join(names)}" if names else "one that the model defines",
                          repr(name))
    return name
