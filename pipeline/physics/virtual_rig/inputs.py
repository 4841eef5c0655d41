"""Forces and displacements of the inputs of a run, and their course between its samples."""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.virtual_rig.band_limited import refined


def run_inputs(bench, run):
    """[N, one value or samples (samples,)] of each input of the model, in its order; 0 N where nothing is said.

    Of an end that moves by u the force k u + c u' in its joint.
    """
    return [_end_force(bench, run, name, value) if name in bench.model.moved_ends else value
            for name, value in zip(bench.model.input_name, stated_inputs(bench, run), strict=True)]


def stated_inputs(bench, run):
    """[one value or samples (samples,)] of each input: N, or m where it moves the end of a joint."""
    unknown = {*run.inputs, *run.pulses} - set(bench.model.input_name)
    if unknown:
        raise ConfigError(f"run {run.name}: input", f"one of {', '.join(bench.model.input_name)}",
                          ", ".join(sorted(unknown)))
    return [_struck(run.inputs.get(n, run.conditions.get(n, 0.0)), run, n) for n in bench.model.input_name]


def _struck(value, run, name):
    """``value`` of an input with its pulse on top, where a Run has one there."""
    return value + run.pulses[name].force(run.samples, run.sample_rate) if name in run.pulses else value


def resolved(bench, run, parts):
    """(Run, its inputs as of ``run_inputs``) by which steps go, ``parts`` of them from sample to sample.

    A Run with pulses or band-limited inputs comes at ``parts`` times its rate, so that the steps resolve them.
    """
    if not (run.pulses or run.band_limited):
        return run, run_inputs(bench, run)
    finer = replace(run, sample_rate=parts * run.sample_rate, inputs={}, drive=None)
    within = {name: refined(value, parts) for name, value in run.inputs.items() if name in run.band_limited}
    rest = {name: value for name, value in run.inputs.items() if name not in within}
    smooth = run_inputs(bench, replace(finer, inputs=within, pulses={}))
    drawn = run_inputs(bench, replace(run, inputs=rest, pulses={}))
    return finer, [_struck(fine if name in within else _between(value, run, finer, name in run.held), finer, name)
                   for name, fine, value in zip(bench.model.input_name, smooth, drawn, strict=True)]


def _between(value, run, finer, held):
    if not np.ndim(value):
        return value
    if held:
        return np.append(np.repeat(value[:-1], (finer.samples - 1) // (run.samples - 1)), value[-1])
    return np.interp(finer.time, run.time, value)


def input_unit(bench, name):
    """Unit in which runs state an input: m of a moved end, else N."""
    return "m" if name in bench.model.moved_ends else "N"


def _end_force(bench, run, name, displacement):
    _, stiffness, damping = bench.joint(bench.model.moved_ends[name])
    if not np.ndim(displacement) or not damping:
        return stiffness * displacement
    if name in run.held:
        raise ConfigError(f"run {run.name}: input {name}", "linear or band_limited, because its joint has a damper",
                          "hold: step", "a displacement that jumps takes an infinite force of a damper")
    velocity = scipy.interpolate.CubicSpline(run.time, displacement)(run.time, 1)
    return stiffness * displacement + damping * velocity


def holding(bench, run):
    """(i,) True for inputs whose samples are held until the next."""
    return np.array([name in run.held for name in bench.model.input_name], bool)
