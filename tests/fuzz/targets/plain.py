"""Plain values of what readers return, to compare with what must come out."""

import numpy as np

from pipeline.recordings.samples import with_gaps


def of_runs(runs):
    """{run: {channels, frf, modes, conditions, friction, topography}} of plain numbers and texts."""
    return {name: _run(run) for name, run in runs.items()}


def _run(run):
    return {
        "channels": {name: channel(with_gaps(c), str(c.unit), float(c.rate), float(c.begin), str(c.measures))
                     for name, c in run.channels.items()},
        "frf": {name: {"frequency": f.frequency, "response": f.response, "unit": str(f.unit)}
                for name, f in run.frf.items()},
        "modes": {name: {"frequency": m.frequency, "damping": m.damping_ratio, "shape": m.shape}
                  for name, m in run.modes.items()},
        "conditions": {name: {"value": c.value, "unit": str(c.unit)} for name, c in run.conditions.items()},
        "friction": {name: {"friction": f.friction, "pressure": f.pressure, "speed": f.speed,
                            "temperature": f.temperature} for name, f in run.friction.items()},
        "topography": {name: {"height": t.height, "x": t.x, "y": t.y} for name, t in run.topography.items()}}


def channel(samples, unit, rate, begin=0.0, measures=None):
    """Plain values of a channel."""
    return {"samples": np.asarray(samples, float), "unit": unit, "rate": rate, "begin": begin, "measures": measures}


def run(channels, **more):
    """Plain values of a run that has these ``channels`` and, of the rest, ``more`` alone."""
    return {"channels": channels, "frf": {}, "modes": {}, "conditions": {}, "friction": {}, "topography": {}, **more}
