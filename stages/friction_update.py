"""Stage friction_update: measured friction beside the friction map, and what of the micro scale it asks to change."""

import copy

import numpy as np

from pipeline.case_models.rough.pair import Settings as MicroSettings
from pipeline.contract import ConfigError, Context, Quantity, Section, option, restored, stage
from pipeline.contract import documents as yaml
from pipeline.diagnosis.measured_friction import update as updating
from pipeline.diagnosis.measured_friction.samples import joined, of_slides, tabulated
from pipeline.diagnosis.measured_friction.update import DISTANCE, LEVEL, PRESSURE, SPEED, TEMPERATURE, TERMS
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.products import FrictionMap, FrictionUpdate, MicroFriction, Recording
from pipeline.recordings.friction import SILENT
from pipeline.recordings.samples import with_gaps

#: sets of terms that the product lists
_LISTED = 10
#: term -> settings of micro_friction that it changes
SETTINGS = {LEVEL: ("third_body_factor",), SPEED: ("rate_coefficient",), TEMPERATURE: ("softening",),
            DISTANCE: ("disc.wear_coefficient", "pad.wear_coefficient"), PRESSURE: ()}
#: units of these
UNITS = {"wear_coefficient": "m^2/N", "softening": "1/K"}


class Slides(Section):
    """Channels of a reciprocating tribometer; its runs may state ``temperature``, and ``distance`` slid before them."""

    load: str = option("load", "channel of the normal force")
    friction: str = option("friction", "channel of the friction force")
    position: str = option("position", "channel of the position of what moves")
    area: Quantity("m^2", gt=0) = option(..., "nominal contact area")
    settle: float = option(0.5, "share of each slide after which friction has built up", gt=0, lt=1)


class Settings(Section):
    """Runs, and how their channels are read."""

    runs: tuple[str, ...] = option((), "recorded runs; none = all that hold friction, or the channels of slides")
    slides: Slides | None = option(None, "channels of runs without a table of friction; none = such runs are left out")


def companions(product, case):
    """The case with the values that the measurements ask for; none where they ask for none, or cannot tell which.

    A value that its setting cannot take (friction that falls with speed is no rate of the shear limit) stays as it is.
    """
    if case is None or str(product.verdict) != "values" or not allowed(product).any():
        return {}
    document = copy.deepcopy(case.document)
    section, source = document.setdefault("micro_friction", {}), f"measured friction of {case.name}, standard error"
    for k in np.flatnonzero(allowed(product)):
        *way, key = str(product.setting[k]).split(".")
        holder = section.setdefault(way[0], {}) if way else section
        unit = UNITS.get(key, "")
        value, std = float(product.setting_after[k]), float(product.setting_std[k])
        holder[key] = {"value": f"{value!r} {unit}" if unit else value, "origin": "inferred",
                       "source": f"{source} {std:.2g} {unit}".rstrip()}
    document["title"] = f"{document.get('title', case.name)}, friction as measured"
    return {f"{case.name}_updated.yaml": yaml.yaml_text(document)}


def allowed(product):
    """(settings,) whether each can take the value that the measurements ask for."""
    highest = np.array([1.0 if name == "third_body_factor" else np.inf for name in product.setting])
    return (product.setting_after >= 0) & (product.setting_after <= highest)


@stage(companions=companions)
def friction_update(micro_friction: MicroFriction, friction_map: FrictionMap, recording: Recording, settings: Settings,
                    context: Context) -> FrictionUpdate:
    """Compare measured friction with the map: where it is off, and which values of the micro scale that asks for.

    Method:
    Level, pressure, speed, sliding distance and temperature are terms by which the logarithm of the map may be off. All
    sets of those that the samples can tell were fitted by weighted least squares, with a scatter between tests beside
    the stated errors, and compared by BIC; a term counts where its p-value over all terms tried is below 0.01.
    """
    samples = joined([_samples(name, run, settings) for name, run in _chosen(recording, settings).items()])
    law = FrictionLaw.of(friction_map)
    found = updating.update(law, samples, _map_errors(friction_map, samples, grid_error(micro_friction), law))
    nothing = found.every[[f.terms for f in found.every].index(())]
    settled = _settings(restored(MicroSettings, micro_friction.settings.item()), found)
    value, std, terms = found.value.copy(), found.std.copy(), list(found.best.terms)
    value[terms], std[terms] = found.best.values, found.best.std
    context.log(f"{len(samples)} coefficients of friction: {found.verdict}")
    return FrictionUpdate(
        **{name: getattr(samples, name) for name in ("friction", "friction_std", "pressure", "speed", "distance",
                                                     "temperature")},
        run=[str(r) for r in samples.run], outside=found.outside.astype(int), mapped=np.exp(found.mapped),
        updated=np.exp(found.updated), unseen=np.exp(found.unseen), term=list(TERMS),
        **{name: [int(t in of) for t in range(len(TERMS))] for name, of in
           (("tested", found.tested), ("fitted", terms), ("needed", found.sure))}, value=value, value_std=std,
        map_std=found.map_std, p_value=found.p_value, scatter=found.best.scatter, scatter_before=nothing.scatter,
        model=[words(f.terms) for f in found.every[:_LISTED]], bic=[f.bic - nothing.bic for f in found.every[:_LISTED]],
        setting=[s[0] for s in settled], setting_before=[s[1] for s in settled], setting_after=[s[2] for s in settled],
        setting_std=[s[3] for s in settled], verdict=found.verdict, alike=[words(terms) for terms in found.alike])


def words(terms):
    """A set of terms in words."""
    return " + ".join(TERMS[t] for t in terms) or "the map as it is"


def _chosen(recording, settings):
    """{name: Run} of the settings."""
    wanted = settings.runs or tuple(name for name, run in recording.runs.items()
                                    if run.friction or (settings.slides and settings.slides.friction in run.channels))
    missing = [name for name in wanted if name not in recording.runs]
    if missing or not wanted:
        raise ConfigError("friction_update.runs", f"recorded runs with friction, of {', '.join(recording.runs)}",
                          ", ".join(missing) or "none of them holds friction",
                          "import a table of kind friction, or name the channels under friction_update.slides")
    return {name: recording.runs[name] for name in wanted}


def _samples(name, run, settings):
    if run.friction:
        return joined([tabulated(name, table) for table in run.friction.values()])
    slides = settings.slides
    if slides is None:
        raise ConfigError("friction_update.slides", f"the channels of run {name}, which holds no table of friction",
                          "none", "name load, friction and position, and the nominal area")
    lacking = [c for c in (slides.load, slides.friction, slides.position) if c not in run.channels]
    if lacking:
        raise ConfigError("friction_update.slides", f"channels of run {name}: {', '.join(run.channels)}",
                          ", ".join(lacking))
    channels = [run.channels[c] for c in (slides.load, slides.friction, slides.position)]
    if len({(float(c.rate), float(c.begin), len(c.samples)) for c in channels}) > 1:
        raise ConfigError("friction_update.slides", f"channels of run {name} of one rate, begin and length", "several")
    stated = {name: float(np.mean(condition.value)) for name, condition in run.conditions.items()}
    return of_slides(name, *(with_gaps(c) for c in channels), float(channels[0].rate), slides.area,
                     stated.get("temperature", SILENT["temperature"]), slides.settle,
                     stated.get("distance", SILENT["distance"]))


def grid_error(micro):
    """How far ln mu may be off by the grid: the real area on it beside that on an infinitely fine one, and its error.

    Of two grids three times what the last refinement changes (Roache's grid convergence index); of one all of it.
    """
    used = micro.refinement_area[np.argmin(abs(micro.refinement - micro.nodes_per_wavelength))]
    limit, safety = float(micro.area_limit), 1.0 if micro.area_order > 0 else 3.0
    return float(np.hypot(np.log(used / limit), safety * micro.area_limit_error / limit))


def _map_errors(friction_map, samples, grid, law):
    """Standard errors (5,) of ln mu of the map along the terms: of its surfaces at the middle of the samples, and of
    its ``grid``, which may change the level, and by as much again over the pressures and distances of the samples."""
    at = int(np.argmin(abs(friction_map.distance - np.median(samples.distance))))
    p = int(np.argmin(abs(np.log(friction_map.pressure / np.median(samples.pressure)))))
    v = int(np.argmin(abs(np.log(friction_map.speed / np.median(samples.speed)))))
    level, errors = friction_map.friction[p, v, at], np.zeros(len(TERMS))
    errors[LEVEL] = np.hypot(friction_map.friction_std[p, v, at] / level, grid)
    over = max(np.ptp(np.log(samples.pressure)), 1e-3)
    errors[PRESSURE] = np.hypot(friction_map.pressure_slope_std[at] / level, grid / over)
    errors[SPEED] = friction_map.speed_slope_std[at] / level
    ends = [law.evaluate(np.median(samples.pressure), np.median(samples.speed), k * samples.distance.max())[0]
            for k in (1 / np.e, 1.0)]
    errors[DISTANCE] = grid / max(abs(float(np.log(ends[1] / ends[0]))), 1e-3)
    return errors


def _settings(micro, found):
    """[(setting, value, value that the samples ask for, its standard error)] of terms beyond the error of the map."""
    changed = []
    for t, value, std in zip(found.best.terms, found.best.values, found.best.std, strict=True):
        whole = float(np.hypot(std, found.map_std[t]))
        for name in SETTINGS[t] if t in found.sure else ():
            before = micro
            for part in name.split("."):
                before = getattr(before, part)
            if t in (LEVEL, DISTANCE):
                after = before * np.exp(value)
                changed.append((name, before, after, after * whole))
            elif t == SPEED:
                changed.append((name, before, before + value, whole))
            else:
                changed.append((name, before, value, whole))
    return changed
