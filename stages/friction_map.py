"""Stage friction_map: mu(pressure, speed, distance) of the interface as a table for other programs."""

from dataclasses import replace

import numpy as np

from pipeline.case_models.rough.pair import Settings as MicroSettings
from pipeline.contract import ConfigError, Context, ConvergenceError, Quantities, Quantity, Section, option, stage
from pipeline.contract.settings import restored
from pipeline.physics.friction import table_formats
from pipeline.physics.friction.friction_table import refine
from pipeline.physics.friction.pressure_law import levelling_axis, polynomial_fit, slope_error
from pipeline.products import FrictionMap, FrictionOverTemperature, MicroFriction


class Settings(Section):
    """Law over pressure, and refinement of the computed points."""

    order: int | None = option(
        None, "order of the polynomial in the logarithm of pressure that is fitted to the computed points by weight of"
        " their standard errors; none = a curve through every point", ge=1)
    pressure_subdivisions: int = option(10, "parts of each interval between computed pressures", ge=1)
    speed_subdivisions: int = option(5, "parts of each interval between computed speeds", ge=1)
    distance_subdivisions: int = option(5, "parts of each interval between recorded distances", ge=1)
    bulk_temperature: Quantity("K", gt=-250) = option(
        "0 K", "temperature of both bodies above that of reference: that of the map, by micro_friction's softening, and"
        " of the linings of the brake, by structure.pad.lining_softening")
    bulk_temperatures: Quantities("K", ge=0) | None = option(
        None, "temperatures of both bodies above that of reference at which the map is told too, by micro_friction's"
        " softening; none = not")


def companions(product, case=None):
    """The map at its refined points in SI units: as CSV, and as the tables that Abaqus, Adams and FMUs read. Abaqus'
    has the temperatures, where there are some; the others are at bulk_temperature."""
    axes, warm = (product.pressure, product.speed, product.distance), product.over_temperature.get("bodies")
    return {"friction_map.csv": table_formats.as_csv(*axes, product.friction, product.friction_std),
            "friction_map.inp": table_formats.as_abaqus(*axes, product.friction, warm),
            "friction_map.adm": table_formats.as_adams(*axes, product.friction),
            "friction_map.txt": table_formats.as_modelica(*axes, product.friction)}


def _check(sections):
    """A law is fitted by weight of errors, which nothing tells of one pair of surfaces at one position; something is
    left of the shear limit at every temperature."""
    surface, micro, order = sections.get("surface"), sections.get("micro_friction"), sections["friction_map"].order
    if micro is not None:
        for name in ("bulk_temperature", "bulk_temperatures"):
            _refuse_melting(micro.softening, np.max(getattr(sections["friction_map"], name) or 0.0), name)
    if None not in (surface, micro, order) and surface.pairs * micro.realisations < 2:
        raise ConfigError("friction_map.order", "none, or two or more surface.pairs or micro_friction.realisations",
                          f"order {order} of one pair at one position", "its standard errors weigh the points")


@stage(companions=companions, check=_check)
def friction_map(micro_friction: MicroFriction, settings: Settings, context: Context) -> FrictionMap:
    """Map the friction coefficient over pressure, speed and sliding distance.

    Where 'order' is given, a polynomial in the logarithm of pressure is fitted instead of interpolating: scatter of the
    computed points then does not become a slope of friction over pressure, which decides on flutter. Beyond the
    computed pressures it levels off within a factor of two.

    Method:
    The computed points were interpolated by monotone cubics (PCHIP along pressure, speed and distance, each interval
    divided into {pressure_subdivisions}, {speed_subdivisions} and {distance_subdivisions} parts), over pressure by a
    fitted polynomial in its logarithm where an order is given (order: {order}). The map is read by multilinear
    interpolation and is constant outside its range. Friction is that of bodies {bulk_temperature} above the temperature
    of reference, by the softening of the shear limit.
    """
    micro_friction = _at_temperature(micro_friction, settings.bulk_temperature)
    parts = (settings.pressure_subdivisions, settings.speed_subdivisions, settings.distance_subdivisions)
    axes = (micro_friction.pressure, micro_friction.speed, micro_friction.distance)
    fine, friction = refine(axes, micro_friction.friction, parts)
    _, scatter = refine(axes, micro_friction.friction_std, parts)
    _, stiffness = refine(axes[::2], micro_friction.normal_stiffness.mean(axis=1), parts[::2])
    fit = slope = None
    if settings.order is not None:
        fine, friction, scatter, stiffness, fit, slope = _fitted(micro_friction, settings, fine, stiffness)
    return FrictionMap(pressure=fine[0], speed=fine[1], distance=fine[2], friction=friction, friction_std=scatter,
                       normal_stiffness=stiffness, computed_pressure=micro_friction.pressure,
                       computed_speed=micro_friction.speed, **_slope_errors(micro_friction, fine, scatter, fit, slope),
                       over_temperature=_warmed(micro_friction, settings, fine, friction),
                       bulk_temperature=settings.bulk_temperature)


def _warmth(computed, rise, where):
    """Friction over that at reference, (P, V, S) at the computed points, of bodies ``rise`` K warmer.

    Friction goes with the shear limit, which bulk and flash heat soften, and flash heat with friction.
    """
    softening = restored(MicroSettings, computed.settings.item()).softening
    _refuse_melting(softening, rise, where)
    cold = 1.0 - softening * computed.flash_temperature                     # limit over that without any flash
    heating = softening * computed.flash_temperature / cold
    return (1 - softening * rise) / (1 + heating * (1 - softening * rise)) / cold


def _refuse_melting(softening, rise, where):
    if softening * rise >= 1.0:
        raise ConfigError(f"friction_map.{where}", f"less than {1 / softening:.4g} K, where nothing is left of the"
                          " shear limit", f"{rise:g} K", "lower micro_friction.softening")


def _at_temperature(computed, rise):
    """MicroFriction with the friction and the errors of bodies ``rise`` K warmer."""
    if not rise:
        return computed
    factor = _warmth(computed, rise, "bulk_temperature")
    return replace(computed, friction=computed.friction * factor, friction_std=computed.friction_std * factor,
                   pair_friction=computed.pair_friction * factor)


def _warmed(computed, settings, fine, friction):
    """FrictionOverTemperature of the map, whose own temperature is the one stated."""
    if settings.bulk_temperatures is None:
        return {}
    axes = computed.pressure, computed.speed, computed.distance
    points = np.stack(np.meshgrid(*(np.clip(axis, own[0], own[-1]) for axis, own in zip(fine, axes, strict=True)),
                                  indexing="ij"), axis=-1)
    own = _warmth(computed, settings.bulk_temperature, "bulk_temperature")
    factors = [_at(axes, _warmth(computed, rise, "bulk_temperatures") / own, points)
               for rise in settings.bulk_temperatures]
    return {"bodies": FrictionOverTemperature(temperature=settings.bulk_temperatures,
                                              friction=[friction * f for f in factors])}


def _at(axes, values, points):
    """``values`` on ``axes`` at ``points`` (..., 3), linearly; of an axis of one point they do not vary."""
    from scipy.interpolate import RegularGridInterpolator

    several = [k for k, axis in enumerate(axes) if len(axis) > 1]
    if not several:
        return np.full(points.shape[:-1], values.item())
    grid = RegularGridInterpolator([axes[k] for k in several], values.reshape([len(axes[k]) for k in several]))
    return grid(points[..., several])


def _fitted(computed, settings, fine, stiffness):
    """(axes, friction, its standard error, stiffness, value and slope over ln p per computed value) of the fitted law.

    The stiffness beyond the computed pressures is proportional to pressure below them, and constant above.
    """
    pressure = levelling_axis(computed.pressure, settings.pressure_subdivisions)
    weights = computed.friction_std.mean(axis=(1, 2))
    fit = polynomial_fit(computed.pressure, weights, settings.order, pressure)
    parts = (1, settings.speed_subdivisions, settings.distance_subdivisions)
    axes = pressure, computed.speed, computed.distance
    friction = refine(axes, np.einsum("fp,pvs->fvs", fit, computed.friction), parts)[1]
    scatter = refine(axes, _scatter_of_fit(computed, fit), parts)[1]
    if friction.min() <= 0:
        raise ConvergenceError("friction_map.order", "a law of friction above 0", f"{friction.min():.3g}",
                               "lower the order, or interpolate")
    inside = np.array([np.interp(pressure, fine[0], column) for column in stiffness.T]).T
    below = np.minimum(pressure / computed.pressure[0], 1.0)[:, None]
    return (pressure, *fine[1:]), friction, scatter, below * inside, fit, np.gradient(fit, np.log(pressure), axis=0)


def _scatter_of_fit(computed, fit):
    """Standard error (F, V, S) of the fitted law (F, P): that of what the pairs of surfaces give, whose friction at all
    pressures rises and falls together; of one pair that of independent points."""
    each = computed.pair_friction
    if len(each) == 1:
        return np.sqrt(np.einsum("fp,pvs->fvs", fit**2, computed.friction_std**2))
    return np.einsum("fp,npvs->nfvs", fit, each).std(axis=0, ddof=1) / np.sqrt(len(each))


def _slope_errors(computed, fine, scatter, fit, slope):
    """Fields of the map: where its error is smallest, the errors of its slopes there, and how errors go together.

    ``fit`` and ``slope`` (F, P) are those of the fitted law per computed value; None: a straight line by weight. With
    several pairs of surfaces errors are those of what each pair gives, whose friction at all pressures and speeds rises
    and falls together.
    """
    pressure, speed, distance = fine
    several = len(computed.pair_friction) > 1
    best = np.where(_inside(computed.pressure, pressure, several)[:, None], scatter.mean(axis=1), np.inf).argmin(axis=0)
    if several:
        return {"best_pressure": pressure[best], **_errors_of_pairs(computed, fine, best, fit, slope)}
    over_pressure, over_speed = [], []
    for s, at in enumerate(np.interp(computed.distance, distance, best).round().astype(int)):
        errors = computed.friction_std[:, :, s]
        over_pressure.append(slope_error(np.log(computed.pressure), errors.mean(axis=1)) if slope is None
                             else np.sqrt(slope[at] ** 2 @ errors**2).mean())
        there = [np.interp(v, speed, scatter[at, :, np.argmin(abs(distance - computed.distance[s]))])
                 for v in computed.speed]
        over_speed.append(slope_error(np.log(computed.speed), there))
    return {"best_pressure": pressure[best],
            "pressure_slope_std": np.interp(distance, computed.distance, over_pressure),
            "speed_slope_std": np.interp(distance, computed.distance, over_speed),
            "error_correlation": np.tile(np.eye(3), (len(distance), 1, 1))}


def _inside(computed, pressure, several):
    """Whether each ``pressure`` is one at which errors may be stated: of several pairs, whose errors may be smallest at
    an end, one between the outermost ``computed`` ones, where the law has a slope of its own."""
    inner = computed[1:-1] if several and len(computed) > 2 else pressure
    return (pressure >= inner[0]) & (pressure <= inner[-1])


def _errors_of_pairs(computed, fine, best, fit, slope):
    """Standard errors of the slopes and correlations, by what each pair of surfaces gives; see ``_slope_errors``."""
    pressure, speed, distance = fine
    errors, correlations = [], []
    for s, at in enumerate(np.interp(computed.distance, distance, best).round().astype(int)):
        each = computed.pair_friction[..., s]
        near = np.argmin(abs(np.log(computed.pressure / pressure[at])))
        one = np.eye(len(computed.pressure))[near]
        level, over = (one, _line(np.log(computed.pressure))) if fit is None else (fit[at], slope[at])
        terms = np.array([np.einsum("p,npv->n", level, each) / len(computed.speed),
                          np.einsum("p,npv->n", over, each) / len(computed.speed),
                          each[:, near] @ _line(np.log(computed.speed))])
        errors.append([_standard_error(term) for term in terms[1:]])
        correlations.append(_correlation(terms))
    at = [int(np.argmin(abs(computed.distance - d))) for d in distance]
    over_distance = [np.interp(distance, computed.distance, values) for values in np.transpose(errors)]
    return {"pressure_slope_std": over_distance[0], "speed_slope_std": over_distance[1],
            "error_correlation": np.array(correlations)[at]}


def _correlation(terms):
    """Correlation (k, k) of ``terms`` (k, n); none with a term that does not vary."""
    off = terms - terms.mean(axis=1, keepdims=True)
    size = np.sqrt(np.einsum("kn,kn->k", off, off))
    scaled = off / np.where(size > 0.0, size, 1.0)[:, None]
    return np.where(np.eye(len(terms), dtype=bool), 1.0, scaled @ scaled.T)


def _line(x):
    """Weights (n,) that give the slope of a straight line through values at ``x`` (n,); zeros of a single one."""
    off = x - x.mean()
    return off / (off @ off) if len(x) > 1 else off


def _standard_error(values):
    return float(values.std(ddof=1) / np.sqrt(len(values)))
