"""Dynamic rupture of the interface of two plates: central differences with forward-increment Lagrange multipliers.

The plates move about a static state that carries pressure and shear on the interface; all fields are perturbations of
it, all interface tractions are totals. After both plates stepped as if their edges were free, multipliers at the new
time close every gap and hold every sticking node, and are clipped to pressure >= 0 and |shear| <= friction * pressure
(Carpenter, Taylor and Katona, Int. J. Numer. Methods Eng. 32 (1991) 103; Baillet et al. 2005). On matched nodes the
system is diagonal and one clip solves it; elsewhere projected Gauss-Seidel sweeps do, nodes against segments. From
rest, what changes at t = 0 acts a whole step on the first half step: the run is early by half a step, once for all.

Signs: slip = lower minus upper along x; shear is the friction on the upper plate along x; pressure is positive.
Friction falls linearly with the slip path from ``static`` to ``dynamic`` (Ida, J. Geophys. Res. 77 (1972) 3796). With a
memory, the strength follows a delayed pressure s, ds/dt = (p - s) (1 / memory_time + |V| / memory_slip): the simplified
law of Prakash and Clifton (Cochard and Rice, J. Geophys. Res. 105 (2000) 25891).
"""

from typing import NamedTuple

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.rupture.plate_grid import largest_step, nodal_share
from pipeline.physics.rupture.plate_step import rims, step_plate

STICK, SLIP, OPEN = 0, 1, 2
_TOLERANCE, _SWEEPS = 1e-9, 2000


class Interface(NamedTuple):
    """What the interface is made of; arrays over the s slave nodes, those of the finer plate."""

    pressure: np.ndarray        # (s,) Pa, static state
    shear: np.ndarray           # (s,) Pa, static state
    gap: np.ndarray             # (s,) m, static state, >= 0
    static: np.ndarray          # (s,) friction coefficient before slip
    dynamic: np.ndarray         # (s,) after ``weakening`` of slip path
    weakening: float            # m, > 0
    memory_time: float          # s, 0 = none
    memory_slip: float          # m, 0 = none
    length: np.ndarray          # (s,) m, part of the interface of each node
    master: np.ndarray          # (s,) left master node of the segment
    weight: np.ndarray          # (s,) of the right master node, 0..1
    slave_above: bool           # True where the upper plate is the slave


class Motion(NamedTuple):
    """State of both plates and of the interface; changed by every step."""

    lower: np.ndarray           # (2, 2, rows, columns): displacement in m, velocity in m/s
    upper: np.ndarray
    slip: np.ndarray            # (s,) m
    path: np.ndarray            # (s,) m, sum of |slip increments|
    memory: np.ndarray          # (s,) Pa, delayed pressure


class Record(NamedTuple):
    """Interface over time; the slip rate belongs to half a step before ``time``."""

    time: np.ndarray            # (n,) s
    slip_rate: np.ndarray       # (n, s) m/s
    pressure: np.ndarray        # (n, s) Pa
    shear: np.ndarray           # (n, s) Pa
    state: np.ndarray           # (n, s) STICK, SLIP or OPEN


def positions(plate):
    """(columns,) m, x of the nodes of a plate."""
    return plate.spacing * np.arange(plate.columns)


def pairing(lower, upper):
    """(master, weight, slave_above, length): the finer plate's interface nodes on the segments of the coarser one."""
    above = upper.spacing < lower.spacing
    slave, master = (upper, lower) if above else (lower, upper)
    position = np.arange(slave.columns) * (slave.spacing / master.spacing)
    left = np.minimum(np.floor(position + 1e-9).astype(np.int64), master.columns - 2)
    weight = position - left
    weight[np.abs(weight) < 1e-9] = 0.0
    weight[np.abs(weight - 1.0) < 1e-9] = 1.0
    return left, weight, above, slave.spacing * nodal_share(slave.columns)


def at_rest(lower, upper, interface):
    """Motion at the static state."""
    plates = (np.zeros((2, 2, grid.rows, grid.columns)) for grid in (lower, upper))
    return Motion(*plates, np.zeros(interface.pressure.size), np.zeros(interface.pressure.size),
                  interface.pressure.copy())


def opening(interface, motion):
    """(s,) m, gap of every slave node at the present state."""
    upper, lower = motion.upper[0, 1, 0], motion.lower[0, 1, -1]
    slave, master = (upper, lower) if interface.slave_above else (lower, upper)
    right = np.minimum(interface.master + 1, master.size - 1)
    across = (1.0 - interface.weight) * master[interface.master] + interface.weight * master[right]
    return interface.gap + (slave - across if interface.slave_above else across - slave)


def stable_step(lower, upper):
    """Longest stable time step in s of both plates."""
    return min(largest_step(lower), largest_step(upper))


def advance(lower, upper, interface, motion, step, steps, start=0.0):
    """Step ``motion`` in place ``steps`` times; the Record of the interface after every step.

    Raises ConfigError for a step beyond the stability limit, ConvergenceError where the contact of unlike meshes
    does not converge or values stop being finite.
    """
    limit = stable_step(lower, upper)
    if not 0.0 < step <= limit:
        raise ConfigError("rupture: time step", f"a step up to {limit:.4g} s, the stability limit", f"{step:.4g} s",
                          "shorten the step")
    shape = steps, interface.pressure.size
    record = Record(start + step * np.arange(1, steps + 1), *(np.empty(shape, np.float32) for _ in range(3)),
                    np.empty(shape, np.uint8))
    failed = _advance(lower, upper, rims(lower, step), rims(upper, step), interface, motion, step, record)
    if failed:
        raise ConvergenceError(f"rupture: contact at step {failed}", f"multipliers to {_TOLERANCE:g} of the largest"
                               f" within {_SWEEPS} sweeps", "none", "shorten the step or match the meshes")
    if not np.isfinite(motion.slip).all():
        raise ConvergenceError(f"rupture: slip after {steps} steps", "finite values", "NaN or infinity")
    return record


@njit(error_model="numpy")
def _advance(lower, upper, lower_rim, upper_rim, interface, motion, step, record):
    below, above = np.empty((3, 2, lower.columns)), np.empty((3, 2, upper.columns))
    between = 0         # nodes that meet a segment, not a node; without any the system is diagonal
    for i in range(interface.weight.size):
        if interface.weight[i] != 0.0 and interface.weight[i] != 1.0:
            between += 1
    matched = between == 0
    pressure, shear = np.empty(interface.pressure.size), np.empty(interface.pressure.size)
    strength = np.empty(pressure.size)
    for count in range(record.time.size):
        step_plate(lower, lower_rim, motion.lower[0], motion.lower[1], step, below)
        step_plate(upper, upper_rim, motion.upper[0], motion.upper[1], step, above)
        if interface.slave_above:
            slave, slave_gain = motion.upper[:, :, 0], upper_rim.row_gain[0]
            master, master_gain, side = motion.lower[:, :, -1], lower_rim.row_gain[1], 1.0
        else:
            slave, slave_gain = motion.lower[:, :, -1], lower_rim.row_gain[1]
            master, master_gain, side = motion.upper[:, :, 0], upper_rim.row_gain[0], -1.0
        if not _contact(interface, motion, slave, slave_gain, master, master_gain, side, step, matched, pressure,
                        shear, strength):
            return count + 1
        _remember(interface, motion, slave, master, side, step, pressure, shear, strength, record, count)
    return 0


@njit(error_model="numpy")
def _contact(interface, motion, slave, slave_gain, master, master_gain, side, step, matched, pressure, shear, strength):
    """Multipliers at the new time, applied to both plates; ``side`` = 1 where the slave is above. True = converged."""
    for i in range(pressure.size):
        pressure[i], shear[i] = interface.pressure[i], interface.shear[i]
    remembers = interface.memory_time > 0.0 or interface.memory_slip > 0.0
    largest = np.max(interface.pressure)
    for _ in range(_SWEEPS):
        change = 0.0
        for i in range(pressure.size):
            m, w = interface.master[i], interface.weight[i]
            length = interface.length[i]
            yield_y = length * (slave_gain[1, i] + (1.0 - w) ** 2 * master_gain[1, m] + w**2 * master_gain[1, m + 1])
            yield_x = length * (slave_gain[0, i] + (1.0 - w) ** 2 * master_gain[0, m] + w**2 * master_gain[0, m + 1])
            if yield_y == 0.0 or yield_x == 0.0:
                strength[i] = np.inf
                continue
            gap = interface.gap[i] + side * (slave[0, 1, i] - (1.0 - w) * master[0, 1, m] - w * master[0, 1, m + 1])
            pressed = max(pressure[i] - gap / (step * yield_y), 0.0)
            rate = side * ((1.0 - w) * master[1, 0, m] + w * master[1, 0, m + 1] - slave[1, 0, i])
            acting = motion.memory[i] if remembers else pressed
            weakened = min(motion.path[i] / interface.weakening, 1.0)
            strength[i] = (interface.static[i] + (interface.dynamic[i] - interface.static[i]) * weakened) * acting
            if pressed == 0.0:
                strength[i] = 0.0
            held = shear[i] + rate / yield_x
            sheared = min(max(held, -strength[i]), strength[i])
            _push(slave, slave_gain, master, master_gain, i, m, w, side * length, sheared - shear[i],
                  pressed - pressure[i], step)
            change = max(change, abs(sheared - shear[i]), abs(pressed - pressure[i]))
            pressure[i], shear[i] = pressed, sheared
        if matched or change <= _TOLERANCE * largest:
            return True
    return False


@njit(error_model="numpy", inline="always")
def _push(slave, slave_gain, master, master_gain, i, m, w, length, along, across, step):
    """Tractions (along x, across = pressure) on the slave node and, turned round, on its master segment."""
    for axis in range(2):
        force = length * (along if axis == 0 else across)
        change = slave_gain[axis, i] * force
        slave[1, axis, i] += change
        slave[0, axis, i] += step * change
        change = (1.0 - w) * master_gain[axis, m] * force
        master[1, axis, m] -= change
        master[0, axis, m] -= step * change
        if w > 0.0:
            change = w * master_gain[axis, m + 1] * force
            master[1, axis, m + 1] -= change
            master[0, axis, m + 1] -= step * change


@njit(error_model="numpy")
def _remember(interface, motion, slave, master, side, step, pressure, shear, strength, record, count):
    """Slip, memory of the pressure and the record after the contact is solved."""
    for i in range(pressure.size):
        m, w = interface.master[i], interface.weight[i]
        rate = side * ((1.0 - w) * master[1, 0, m] + w * master[1, 0, m + 1] - slave[1, 0, i])
        sliding = abs(shear[i]) >= strength[i]
        if not sliding:
            rate = 0.0
        motion.slip[i] += step * rate
        motion.path[i] += step * abs(rate)
        pace = 0.0
        if interface.memory_time > 0.0:
            pace += step / interface.memory_time
        if interface.memory_slip > 0.0:
            pace += step * abs(rate) / interface.memory_slip
        motion.memory[i] = (motion.memory[i] + pace * pressure[i]) / (1.0 + pace)
        record.slip_rate[count, i], record.pressure[count, i], record.shear[count, i] = rate, pressure[i], shear[i]
        record.state[count, i] = OPEN if pressure[i] == 0.0 else (SLIP if sliding else STICK)
