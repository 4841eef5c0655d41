"""What recordings of friction and worn faces show, run by run: friction over speed and way, mean depths worn."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError
from pipeline.inference.problem import Observed
from pipeline.physics.rough.sliding_pair import Drag
from pipeline.physics.rough.worn_depth import worn_depth

#: channels of a run, in the order of ``spot_table.mean_wear``
FRICTION, WEAR = "friction", ("pad wear", "disc wear")
UNITS = {FRICTION: "1", **dict.fromkeys(WEAR, "m")}
#: runs of another pressure than the first are not one drag
_SAME = 1e-3


@dataclass(frozen=True)
class Rubbed:
    """One run as recorded: its Drag, ``friction`` (n,) with ``std`` (n,), and ``wear`` {channel: (depth, std)} in m."""

    name: str
    drag: Drag
    friction: np.ndarray
    std: np.ndarray
    wear: dict


def rubbed(recording, stroke, stated_std=None):
    """{run: Rubbed} of the runs of a product Recording that hold friction.

    ``stroke``: how far the faces passed over each other, m; ``stated_std``: standard deviation of friction where the
    recording has none. New faces are those of the run, else the first that any run shows. ConfigError for recordings
    without friction, several pressures in a run, worn faces without new ones.
    """
    runs = {name: run for name, run in recording.runs.items() if run.friction}
    if not runs:
        raise ConfigError("diagnosis.forward", "recordings of friction", f"none in {', '.join(recording.runs)}")
    return {name: _rubbed(name, run, recording, stroke, stated_std) for name, run in runs.items()}


def observed(run, held_out, model_error):
    """Observed of a Rubbed: friction point by point, the wear at the end, ``model_error`` relative beside the noise.

    Points of one way share their spots, whatever the speed: together they count for one error of the model.
    """
    shared = np.sqrt(len(run.friction) / len(np.unique(run.drag.distance)))
    channels = (FRICTION, *run.wear)
    count = len(run.friction)
    samples, std = np.zeros((len(channels), count)), np.ones((len(channels), count))
    valid = np.zeros(samples.shape, bool)
    samples[0], std[0], valid[0] = run.friction, np.hypot(run.std, shared * model_error * run.friction), True
    for row, (depth, error) in enumerate(run.wear.values(), 1):
        samples[row, -1], std[row], valid[row, -1] = depth, np.hypot(error, model_error * depth), True
    return Observed(run.name, {"pressure": run.drag.pressure}, channels, samples, None, valid, noise_std=std,
                    held_out=held_out)


def shown(friction, wear, channels):
    """Samples (c, n) of friction (n,) and wear {channel: m}, as ``observed`` lays them out."""
    samples = np.zeros((len(channels), len(friction)))
    samples[0] = friction
    for row, channel in enumerate(channels[1:], 1):
        samples[row, -1] = wear[channel]
    return samples


def _rubbed(name, run, recording, stroke, stated_std):
    if len(run.friction) > 1:
        raise ConfigError(f"run {name}: friction", "one table", ", ".join(run.friction), "make them runs of their own")
    table, = run.friction.values()
    pressure = float(np.mean(table.pressure))
    if np.ptp(table.pressure) > _SAME * pressure:
        raise ConfigError(f"run {name}: friction", "one nominal pressure",
                          f"{table.pressure.min():g} to {table.pressure.max():g} Pa", "cut it into runs by pressure")
    if not np.all(table.speed > 0):
        raise ConfigError(f"run {name}: friction", "sliding speeds above 0", f"{table.speed.min():g} m/s")
    order = np.argsort(table.distance, kind="stable")
    std = np.where(table.friction_std > 0, table.friction_std, stated_std or 0.0)[order]
    if not np.all(std > 0):
        raise ConfigError(f"run {name}: friction_std", "the scatter of every point", "none at some",
                          "record it, or state diagnosis.noise.std.friction")
    drag = Drag(pressure, table.speed[order], table.distance[order])
    return Rubbed(name, drag, table.friction[order], std, _worn(name, run, recording, stroke))


def _worn(name, run, recording, stroke):
    """{channel: (depth, std)} of the bodies whose worn face the run shows."""
    depths, bodies = {}, [channel.split()[0] for channel in WEAR]
    for channel, body, other in zip(WEAR, bodies, bodies[::-1], strict=True):
        worn = _face(body, "worn", (run,))
        if worn is None:
            continue
        new, against = (_face(b, "new", (run, *recording.runs.values())) for b in (body, other))
        if new is None:
            raise ConfigError(f"run {name}: topography", f"a new face of the {body} beside the worn one", "none",
                              "record it before the test, in this run or another")
        if not _same_pixels(worn, new):
            raise ConfigError(f"run {name}: topography", f"the worn face of the {body} on the pixels of the new one,"
                              f" {_pixels(new)}", _pixels(worn), "record both alike, or resample one")
        if against is not None and not _same_pixels(against, new):
            against = None
        depths[channel] = worn_depth(new.height, worn.height, against and against.height,
                                    round(stroke / (new.x[1] - new.x[0])) + 1)
    return depths


def _same_pixels(one, other):
    return one.height.shape == other.height.shape and np.allclose([one.y[1], one.x[1]], [other.y[1], other.x[1]])


def _pixels(face):
    rows, columns = face.height.shape
    return f"{rows} x {columns} of {face.y[1]:.4g} m by {face.x[1]:.4g} m"


def _face(body, state, runs):
    """The first height map of a body in a state among ``runs``, or None."""
    maps = (t for run in runs for t in run.topography.values() if (str(t.body), str(t.state)) == (body, state))
    return next(maps, None)
