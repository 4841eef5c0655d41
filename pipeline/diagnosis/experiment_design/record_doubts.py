"""Doubts about recorded runs that no model is needed for, one sentence each: channels, lengths, units, runs."""

from itertools import combinations

import numpy as np
import scipy

from pipeline.contract.errors import first_of

#: share of samples at the end of a range beyond which it clips; step over standard deviation of a coarse channel
_CLIPPED, _COARSE = 0.01, 0.1
#: share of such samples that are one stretch where a body rests at the end of its range
_ON_END = 0.8
#: correlation of copies; samples and periods of the slowest motion that a run needs; samples a period
_COPY, _FEW, _PERIODS, _A_PERIOD = 0.99999, 50, 3, 8
#: runs that rules over operating points need
_RUNS = 3
#: mean of a position over its largest excursion beyond which its zero is another one than that of the model
_AWAY = 10.0
#: sizes beyond which a unit is doubted, by SI unit: of a swing about its mean
_SIZES = {"m": (1e-9, 100.0), "rad": (1e-6, 60.0), "m/s^2": (1e-6, 1e5), "N": (1e-9, 1e8), "N m": (1e-9, 1e7),
          "m/s": (1e-9, 1e3)}


def doubts(recording, names, held_out, free=True):
    """[sentence] of the channels ``names`` of a product Recording, ``held_out`` runs; ``free``: nothing drives the rig,
    so that its own vibrations are all that it shows."""
    runs = {name: run for name, run in recording.runs.items() if set(names) & set(run.channels)}
    told = [sentence for name in names for sentence in _of_channel(name, runs)]
    told += [f"{a} and {b} are one another's copy: they count as one" for a, b in combinations(names, 2)
             if _copies(a, b, runs)]
    told += [sentence for name, run in runs.items() for sentence in _of_run(name, run, names, free)]
    compared = [name for name in runs if name not in held_out]
    if not held_out:
        told.append("no run is held out: nothing can be verified, a tie is the most; state diagnosis.held_out: [RUN]")
    if len(compared) < _RUNS:
        told.append(f"{len(compared)} fitted run{'s' * (len(compared) != 1)}: what differs between operating points, as"
                    f" a wrong law does, takes {_RUNS}; cut a long record into runs, or record other amplitudes")
    return told


def _samples(run, name):
    channel = run.channels[name]
    kept = np.ones(len(channel.samples), bool)
    for first, after in np.reshape(channel.missing, (-1, 2)):
        kept[int(first):int(after)] = False
    return np.asarray(channel.samples, float)[kept]


def _of_channel(name, runs):
    parts = {r: _samples(run, name) for r, run in runs.items() if name in run.channels}
    if not parts:
        return
    still = [r for r, values in parts.items() if not np.ptp(values)]
    if still:
        yield f"{name} never changes in {first_of(still, 4)}: a dead channel, or an input that does nothing"
    clipped = {r: max(np.mean(values == values.max()), np.mean(values == values.min()))
               for r, values in parts.items() if np.ptp(values) and len(np.unique(values)) > 20}
    worst = max(clipped, key=clipped.get, default=None)
    if worst is not None and clipped[worst] > _CLIPPED and _flat(parts[worst]):
        share = f"{name} stands at the end of its range in {100 * clipped[worst]:.0f} % of the samples of {worst}"
        yield (f"{share}, on end: it rests there, where a run tells nothing, or a stop holds it; cut that off"
               if _rests(parts[worst]) else
               f"{share}: it clips, or a stop holds it; state bench.channels limit, or leave that out")
    coarse = {r: _step(values) / values.std() for r, values in parts.items() if np.ptp(values)}
    worst = max(coarse, key=coarse.get, default=None)
    if worst is not None and coarse[worst] > _COARSE:
        yield (f"{name} has steps of {100 * coarse[worst]:.0f} % of its standard deviation in {worst}: motions below"
               " are not seen; its noise is at least the step over 3.5")
    channel = runs[next(iter(parts))].channels[name]
    mean, swing = np.median([values.mean() for values in parts.values()]), max(map(np.ptp, parts.values()))
    if str(channel.measures) == "displacement" and abs(mean) > _AWAY * swing > 0:
        place = f"{mean:.4g} {channel.unit}"
        yield (f"{name} lies at {place} and moves by {swing:.2g} {channel.unit}: sizes of laws follow its distance from"
               f" 0; state its zero, bench.corrections: {{channels.{name}.offset: {place}}}")
    unit = str(next(iter(runs.values())).channels[name].unit) if name in next(iter(runs.values())).channels else ""
    low, high = _SIZES.get(unit, (0.0, np.inf))
    size = max((values.std() for values in parts.values()), default=0.0)
    if size and not low < size < high:
        yield f"{name} varies by {size:.3g} {unit}: is its unit right? angles in deg, lengths in mm say so in 'unit'"


def _flat(values):
    """Whether the end of the range is held for three samples on end, as clipping does and a peak does not."""
    return any(np.any(end[:-2] & end[1:-1] & end[2:]) for end in (values == values.max(), values == values.min()))


def _rests(values):
    """Whether nearly all samples at the end of the range are one stretch."""
    end = max((values == values.max(), values == values.min()), key=np.count_nonzero)
    lengths = np.bincount(scipy.ndimage.label(end)[0])[1:]
    return lengths.max() > _ON_END * lengths.sum()


def _step(values):
    """Smallest step between different samples where few values occur, 0 where they are fine."""
    levels = np.unique(values)
    return float(np.median(np.diff(levels))) if 1 < len(levels) < max(len(values) / 4, 2) else 0.0


def _copies(a, b, runs):
    both = [(_samples(run, a), _samples(run, b)) for run in runs.values() if {a, b} <= set(run.channels)]
    both = [(x, y) for x, y in both if len(x) == len(y) and len(x) > 2 and np.ptp(x) and np.ptp(y)]
    return bool(both) and all(np.corrcoef(x, y)[0, 1] > _COPY for x, y in both)


def _of_run(name, run, names, free):
    first = next(c for c in names if c in run.channels)
    values, rate = _samples(run, first), float(run.channels[first].rate)
    if len(values) < _FEW:
        yield f"run {name} has {len(values)} samples: too few for more than one or two values; take {_FEW} or more"
        return
    if not np.ptp(values):
        return
    density = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(len(values))))**2
    main = float(np.sum(density[1:] * np.arange(1, len(density))) / np.sum(density[1:]) * rate / len(values))
    periods = main * len(values) / rate
    if free and periods < _PERIODS:
        yield f"run {name} lasts {periods:.1f} periods of {first}: take three or more"
    if rate / main < _A_PERIOD:
        yield f"run {name}: {rate / main:.0f} samples in a period of {first}; {_A_PERIOD} or more are needed"
