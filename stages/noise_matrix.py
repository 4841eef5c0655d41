"""Stage noise_matrix: how likely a brake squeals in the schedule of a noise matrix, beside what a bench recorded.

Draws are made before the fan-out, so that the number of workers changes no bit.
"""

import csv
import io
from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.case_models.noise_matrix.predicted import described, outside, predicted
from pipeline.case_models.noise_matrix.recorded_stops import recorded_stops
from pipeline.case_models.noise_matrix.sampling import Bands, Draws, solved
from pipeline.case_models.noise_matrix.schedule import Module, NamedSchedule, schedule
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import (
    DEFAULT,
    KINDS,
    Source,
    check_sources,
    family,
    fitting,
    friction_errors,
    law_in_words,
)
from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.diagnosis import noise_matrix_case
from pipeline.diagnosis.noise_matrix_comparison import comparison
from pipeline.physics.stability.draws.draw_statistics import third_octaves
from pipeline.physics.stability.draws.whole_roots import accuracy
from pipeline.products import ComplexModes, Effects, FrictionMap, NoiseEvents, NoiseMatrix, Recording, ReducedModel


class Settings(Section):
    """The schedule, what scatters from brake to brake and from stop to stop, and what of a bench belongs to it."""

    schedule: NamedSchedule = option("j2521", "schedule: j2521, j3211, or a file like theirs, which are in"
                                     " pipeline/case_models/noise_matrix")
    modules: tuple[Module, ...] = option((), "instead: modules of your own")
    wheel_radius: Quantity("m", gt=0) = option("0.31 m", "rolling radius of the tyre: speed of the vehicle per speed of"
                                               " the disc")
    pressure_factor: float = option(1.0, "nominal pad pressure over that in the line: area of the piston over that of"
                                    " the pad", gt=0)
    reference_temperature: Quantity("K", gt=0) = option("20 degC", "temperature of the friction map, above which"
                                                        " friction_map.bulk_temperatures are")
    points: int = option(6, "speeds along a stop at which it is solved", ge=1)
    lowest_frequency: Quantity("Hz", gt=0) = option("2 kHz", "modes from it on are squeal; SAE J2521: 2 kHz, and 1.25"
                                                    " kHz on a full suspension corner or axle")
    highest_frequency: Quantity("Hz", gt=0) = option("16 kHz", "modes up to it are squeal (SAE J2521); at most"
                                                     " complex_modes.frequency_max counts")
    least_growth: Quantity("1/s", ge=0) = option("0 1/s", "growth rate above which a mode counts")
    draws: int = option(250, "brakes that are drawn: the smallest p-value of a difference is about half of its inverse",
                        ge=2)
    repeats: int = option(2, "stops of each that are drawn", ge=1)
    seed: int = option(11, "seed of the draws", ge=0)
    sources: tuple[Source, ...] = option(DEFAULT, "what scatters, each source independent of the others")
    varying: tuple[str, ...] = option(
        ("contact_stiffness", "damping_speed", "friction", "friction_over_pressure", "friction_over_speed"),
        "kinds of sources that change from stop to stop of one brake; others belong to the brake")
    training: int = option(5, "further draws that the common bases are made to serve", ge=1)
    checked: int = option(4, "draws that are also solved in the whole reduced model, and at twice as many speeds", ge=0)
    smallest_correction: float = option(
        1e-2, "corrections of the common bases below this share of the modal amplitude are left out", gt=0)
    within: float = option(0.2, "share within which pressure and speed of a recorded stop are those of the schedule",
                           gt=0, lt=1)
    level: float = option(0.05, "family-wise level below which a difference from the bench counts", gt=0, lt=1)


def companions(product, case=None):
    """The conditions as a table, predicted and measured, and the case that asks why where these differ."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(("kind", "line pressure / Pa", "pad pressure / Pa", "begin / m/s", "end / m/s", "temperature / K",
                     "applications", "probability", "lowest", "highest", "correlation of stops", "recorded stops",
                     "noisy", "predicted noisy", "family-wise p", "difference",
                     *(f"probability {middle:.4g} Hz" for middle in product.band)))
    words = {1: "model squeals too much", -1: "model squeals too little", 0: ""}
    for k, kind in enumerate(product.kind):
        numbers = (product.pressure[k], product.pad_pressure[k], product.speed[k], product.end[k],
                   product.temperature[k], product.applications[:, k].sum(), product.probability[k],
                   *product.interval[k], product.correlation[k], product.condition_stops[k],
                   product.condition_noisy[k], product.condition_expected[k], product.condition_p_value[k])
        writer.writerow((kind, *(f"{value:.6g}" for value in numbers), words[int(product.condition_difference[k])],
                         *(f"{value:.6g}" for value in product.band_probability[k])))
    return {"noise_matrix.csv": stream.getvalue()} | noise_matrix_case.companions(product, case)


def _check(sections):
    settings = sections["noise_matrix"]
    check_sources(settings.sources, "noise_matrix.sources")
    schedule(settings.schedule, settings.modules)
    strange = sorted(set(settings.varying) - set(KINDS))
    if strange:
        raise ConfigError("noise_matrix.varying", f"kinds of sources: {', '.join(KINDS)}", ", ".join(strange))
    if settings.lowest_frequency >= settings.highest_frequency:
        raise ConfigError("noise_matrix.lowest_frequency", f"less than {settings.highest_frequency:g} Hz, the highest",
                          f"{settings.lowest_frequency:g} Hz")
    heard, modes = sections.get("noise_events"), sections.get("complex_modes")
    if modes is not None and modes.frequency_max <= settings.lowest_frequency:
        raise ConfigError("complex_modes.frequency_max", f"more than {settings.lowest_frequency:g} Hz, where squeal"
                          " begins (noise_matrix.lowest_frequency)", f"{modes.frequency_max:g} Hz")
    if heard is not None and heard.lowest_frequency > settings.lowest_frequency:
        raise ConfigError("noise_events.lowest_frequency", "at most noise_matrix.lowest_frequency,"
                          f" {settings.lowest_frequency:g} Hz", f"{heard.lowest_frequency:g} Hz",
                          "look for squeal where it is predicted")


@stage(companions=companions, check=_check)
def noise_matrix(model: ReducedModel, friction_map: FrictionMap | None, modes: ComplexModes,
                 recording: Recording | None, events: NoiseEvents | None, effects: Effects | None, settings: Settings,
                 context: Context) -> NoiseMatrix:
    """Predict the squeal of a schedule of stops over the scatter of the brake, and compare it with a bench.

    Operating points, terms and effects are those of complex_modes, loss factors always hysteretic; every pressure and
    speed of the schedule is solved, a stop at several speeds along it. An application is noisy where a mode is
    unstable.

    Method:
    {draws} brakes with {repeats} stops each were drawn from the declared scatter (seed {seed}); sources that change
    from stop to stop were drawn anew for each. Unstable modes from {lowest_frequency} to {highest_frequency} make an
    application noisy, a stop at any of {points} speeds along it. Recorded stops were matched with the conditions of the
    schedule within {within}, and the number of noisy ones was tested against the beta-binomial distribution of another
    brake of this scatter, two-sided, with Holm's correction over all conditions and bands (level {level}).
    """
    settings = settings.model_copy(update={"sources": fitting(settings.sources, model)})
    points = StabilitySettings.of(modes)
    acts = friction_map is not None and "bodies" in friction_map.over_temperature
    plan = schedule(settings.schedule, settings.modules, acts)
    high = min(settings.highest_frequency, points.frequency_max)
    bands = Bands(third_octaves(settings.lowest_frequency, high), settings.lowest_frequency, high,
                  settings.least_growth, points.neutral)
    errors = friction_errors(friction_map, points.sliding_distance)
    draws = Draws.of(settings, errors, model, settings.draws, settings.seed)
    training = Draws.of(settings, errors, model, settings.training, [settings.seed, 1])
    result = solved(plan, draws, training, model, friction_map, partial(_family, points, effects), points, bands,
                    settings, context)
    noisy = result.noisy.reshape(settings.draws, settings.repeats, len(plan.conditions), len(bands.middle))
    return NoiseMatrix(
        **described(plan, settings), limits=[bands.low, bands.high], band=bands.middle,
        source=[s.name for s in settings.sources], source_law=[law_in_words(s, errors) for s in settings.sources],
        source_varies=[int(s.kind in settings.varying) for s in settings.sources], value=draws.values,
        repeats=settings.repeats, **predicted(noisy, plan.applications), **_accuracy(result),
        outside=outside(friction_map, plan, model.contact_lever, settings),
        **_compared(noisy, plan, bands, recording, events, settings))


def _family(points, effects, model, state, friction_map, direction):
    """Family of one preload, with the effects of the case as they are when it slides in a ``direction``, 1 or -1."""
    turning = replace(points, speeds=tuple(direction * np.abs(points.speeds)))
    return family(model, state, friction_map, turning, effects)


def _accuracy(result):
    return {**accuracy(result.compared), "refined_stops": result.refined.size,
            "refined_changed": int(np.sum(result.refined != result.coarse))}


def _compared(noisy, plan, bands, recording, events, settings):
    """Fields of the recorded stops, and of their comparison with the draws."""
    count, width = len(plan.conditions), len(bands.middle)
    stops, heard = np.zeros(count, int), np.zeros((count, width + 1), int)
    told = {"run": [], "run_condition": [], "run_reason": [], "run_noisy": []}
    if recording is not None and events is not None:
        found = recorded_stops(recording, events, plan.conditions, bands, settings)
        anywhere = np.column_stack([found.noisy, found.noisy.any(axis=1)]).astype(int)
        matched = found.condition >= 0
        np.add.at(stops, found.condition[matched], 1)
        np.add.at(heard, found.condition[matched], anywhere[matched])
        told = {"run": list(found.run), "run_condition": found.condition, "run_reason": list(found.reason),
                "run_noisy": anywhere[:, -1]}
    return {**told, "condition_stops": stops, "condition_noisy": heard[:, width], "band_noisy": heard[:, :width].sum(
        axis=0), **comparison(noisy, stops, heard, settings.level)}
