"""What motion to measure next, where measured motions are put into the equation of motion.

A drive that follows its path makes the same motion whatever resists it; what the hypotheses expect differently is the
force that it takes. A recorded motion is planned again, ``motion`` times as large about its middle or ``pace`` times as
fast, with as many samples; or on a bench of which one number is another.
"""

from dataclasses import replace

import numpy as np

from pipeline.case_models.force_balance import balance
from pipeline.contract import ConfigError
from pipeline.diagnosis.experiment_design.next_run import Planned, changed, words
from pipeline.physics.virtual_rig.force_residual import coordinates, forces_missing, moving
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT

#: what a recorded motion is planned with: factors on its size about its middle, and on its speed
MOTION, PACE = "motion", "pace"
#: planned where the case says nothing: within what was recorded, smaller and slower
WITHIN = {MOTION: (0.5, 0.25), PACE: (0.5, 0.25)}


def planned_motions(bench, recorded, equation, given, where="diagnosis.next"):
    """Planned Balances (m,), like ``recorded`` {name: Recorded} which moves farthest, with one thing changed each.

    ``given`` is the section ``next`` {motion, pace or what else can change: values}, nothing: WITHIN. ConfigError for
    names that neither motions nor the bench have, and units that do not fit. Ends of joints that move make the motion
    themselves: nothing is planned there, nor where no run is fitted.
    """
    if bench.model.moved_ends:
        if given:
            raise ConfigError(where, "none where an input moves the end of a joint", ", ".join(given))
        return ()
    if not recorded:
        return ()
    widest = max(recorded, key=lambda name: max(map(np.ptp, _measured(bench, recorded[name]).values())))
    planned = []
    for name, values in (given or WITHIN).items():
        for value in values:
            condition = f"{words(name, value)}, as {widest}"
            again, section, altered = _again(bench, recorded[widest], equation, name, value, f"{where}.{name}")
            again = replace(again, run=replace(again.run, name=condition), repeat_of="")
            planned.append(Planned(condition, widest, balance(bench, _driven(bench, again, section), section), altered))
    return tuple(planned)


def _again(bench, record, equation, name, value, where):
    """(Recorded, section of its equation, altered) with one thing changed."""
    if name in (MOTION, PACE) and not (isinstance(value, (int, float)) and value > 0):
        raise ConfigError(where, "factors above 0", repr(value))
    if name in bench.model.input_name:
        raise ConfigError(where, f"{MOTION}, {PACE} or a number of the bench: inputs are what the motion takes", name)
    if name == MOTION:
        moves = np.array([_measurand(bench, channel) == DISPLACEMENT for channel in record.channels])[:, None]
        middle = (record.samples.max(axis=1, keepdims=True) + record.samples.min(axis=1, keepdims=True)) / 2
        samples = np.where(moves, middle + value * (record.samples - middle), record.samples)
        return replace(record, samples=samples), equation, {}
    if name == PACE:
        run = record.run
        drive = None if run.drive is None else value * np.asarray(run.drive, float)
        run = replace(run, duration=run.duration / value, sample_rate=value * run.sample_rate, drive=drive)
        corner = None if equation.corner is None else value * equation.corner
        return replace(record, run=run), equation.model_copy(update={"corner": corner}), {}
    run, altered = changed(bench, record.run, name, value, where)
    return replace(record, run=run), equation, altered


def _driven(bench, record, equation):
    """The Recorded with the inputs that its motion takes on the nominal bench."""
    names, idle = bench.model.input_name, replace(record.run, inputs=dict.fromkeys(bench.model.input_name, 0.0))
    motion = coordinates(bench, idle, _measured(bench, record))     # a balance filters it, and what it takes
    needed = forces_missing(bench, idle, moving(motion, 1 / idle.sample_rate, equation.corner))
    force = np.linalg.lstsq(bench.model.input_rows.T, needed, rcond=None)[0]
    return replace(record, run=replace(record.run, inputs=dict(zip(names, force, strict=True)), held=()))


def _measured(bench, record):
    """{channel: (samples,)} of the displacements of a Recorded run."""
    return {c: s for c, s in zip(record.channels, record.samples, strict=True) if _measurand(bench, c) == DISPLACEMENT}


def _measurand(bench, channel):
    return next(c.measurand for c in bench.channels if c.name == channel)
