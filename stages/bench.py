"""Stage bench: predicted sensor signals of the recorded runs."""

from functools import partial

import numpy as np

from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.force_balance import balance
from pipeline.case_models.runs import recorded
from pipeline.case_models.virtual_rig import Settings, built
from pipeline.contract import ConfigError, Context, stage, stored
from pipeline.diagnosis.features.poles import features, observed, predicted
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.diagnosis.signals.start_states import started
from pipeline.diagnosis.signals.usable_runs import usable
from pipeline.products import Bench, BenchRun, BenchStops, Effects, Recording, ReducedModel


def _check(sections):
    """Refuse a bench without sensors."""
    if not sections["bench"].channels:
        raise ConfigError("bench.channels", "at least one recorded channel", "none",
                          "say what each recorded channel shows of the model")


@stage(check=_check)
def bench(model: ReducedModel, effects: Effects | None, recording: Recording, settings: Settings,
          context: Context) -> Bench:
    """Predict the sensor signals of the recorded runs.

    Method:
    Every recorded run was predicted with the model, its contact law (contact: {contact}), friction law, stated effects
    and corrected values (forward: {forward}). simulation: time steps of at most {step}, sensors as defined in the case;
    equation: the force that the measured displacements require is compared with the applied force. The error is the
    root mean square of recorded minus predicted samples. If poles are compared, the runs are free vibrations and the
    predicted poles are complex eigenvalues about steady sliding.
    """
    whole, runs = with_effects(built(model, settings), effects), recorded(recording, settings, model)
    if settings.poles is not None:
        return _of_features(whole, runs, settings, context)
    if settings.forward == "equation":
        balances, refused = usable(runs, partial(balance, whole, equation=settings.equation))
        runs = {name: one.seen for name, one in balances.items()}
        answers = [one.predicted(whole) for one in balances.values()]
    else:
        runs = started(whole, runs, settings, refused := {})
        answers = context.map(partial(_shown, whole), list(runs.values()), "runs")
    for why in refused.values():
        context.remark(why)
    results = {name: _run(one, answer) for (name, one), answer in zip(runs.items(), answers, strict=True)}
    units = {c: u for one in runs.values() for c, u in zip(one.channels, one.unit, strict=True)}
    for name, one in results.items():
        context.log(f"{name}: error {', '.join(f'{e:.3g}' for e in one.error)} of the standard deviation")
    return Bench(settings=stored(settings), channel=list(units), unit=list(units.values()), runs=results)


def _stops(stops):
    """BenchStops of {run: Growth, or the reason why it tells none}."""
    told = [None if isinstance(stop, str) else stop for stop in stops.values()]
    column = {name: [0.0 if stop is None else getattr(stop, name) for stop in told]
              for name in ("std", "begin", "end", "grown")}
    root = np.array([0j if stop is None else stop.root for stop in told])
    return BenchStops(stop=list(stops), growth_rate=root.real, frequency=root.imag / (2 * np.pi), **column,
                      reason=[stop if isinstance(stop, str) else "" for stop in stops.values()])


def _shown(whole, run):
    """Samples (c, n) of one recorded run."""
    return shown(whole, run.run, run.channels)


def _run(seen_run, predicted):
    count = seen_run.valid.sum(axis=1)
    left = np.where(seen_run.valid, seen_run.samples - predicted, 0.0)
    size = np.sqrt((left**2).sum(axis=1) / np.maximum(count, 1))
    spread = np.array([s[v].std() if v.any() else 0.0 for s, v in zip(seen_run.samples, seen_run.valid, strict=True)])
    measured = np.where(seen_run.valid, seen_run.samples, 0.0)
    return BenchRun(time=seen_run.run.time, measured=measured, predicted=predicted,
                    valid=seen_run.valid.astype(int), root_mean_square=size,
                    error=np.divide(size, spread, out=np.zeros(len(size)), where=spread > 0))


def _of_features(whole, recorded_runs, settings, context):
    """Bench of poles and other features, one sample a feature; their errors count in their standard deviations."""
    seen = features(whole, recorded_runs, settings.poles)
    measured, units = observed(seen)
    results = {}
    for one in measured:
        told_by = predicted(whole, seen[one.name], one.channels)
        left = np.where(one.valid, one.samples - told_by, 0.0)[:, 0]
        results[one.name] = BenchRun(time=[0.0], measured=one.samples, predicted=told_by, valid=one.valid.astype(int),
                                   root_mean_square=abs(left), error=abs(left) / one.noise_std)
        context.log(f"{one.name}: {int(one.valid.sum())} features")
    stops = {name: _stops(one.stops) for name, one in seen.items() if one.stops}
    return Bench(settings=stored(settings), channel=list(units), unit=list(units.values()), runs=results, stops=stops)
