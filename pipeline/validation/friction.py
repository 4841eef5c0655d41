"""Friction, real contact area and wear as the paper's section 3.1 states them."""

from dataclasses import fields

import numpy as np

from pipeline.validation import SAME, Ours, correlation, index_of, ours, ratio

_AREA, _FRICTION, _WEAR, _LARGEST = (f"micro_friction.{name}" for name in ("real_area", "friction", "wear_depth",
                                                                          "largest_wear"))
#: fact key -> product field
FIELDS = {
    "micro_pressures": "micro_friction.pressure", "micro_speeds": "micro_friction.speed",
    "distance_last": "micro_friction.distance", "real_area_start": _AREA, "real_area_rises_with_pressure": _AREA,
    "real_area_growth": _AREA, "real_area_growth_rises_with_pressure": _AREA, "wear_depth": _WEAR,
    "wear_depth_over_pressure": _WEAR, "largest_wear_first": _LARGEST, "largest_wear_last": _LARGEST,
    "friction_follows_real_area": f"{_FRICTION}, {_AREA}", "friction_*": _FRICTION,
}

#: rows of new surfaces
_START_ROWS = ("real_area_start", "real_area_rises_with_pressure", "largest_wear_first",
               "friction_pressure_difference_start", "friction_speed_over_pressure")

#: rows that need a run as long as the paper's
_RUN_ROWS = ("real_area_growth", "real_area_growth_rises_with_pressure", "wear_depth", "wear_depth_over_pressure",
             "largest_wear_last", "friction_pressure_difference_end", "friction_lowest", "friction_highest",
             "friction_rises_with_pressure", "friction_rises_with_distance", "friction_distance_over_pressure",
             "friction_follows_real_area")


def friction_rows(micro, known):
    """Rows of the product MicroFriction at its middle speed; ``known`` = published values in SI by key.

    Only pressures and speeds within the paper's range count: the table may extend beyond it.
    """
    settings, micro = _settings(micro), _published_points(micro, known)
    if not micro.friction.size:
        note = "no computed point lies within the paper's pressures and speeds"
        return {**settings, **dict.fromkeys((*_START_ROWS, *_RUN_ROWS), Ours(None, note))}
    end = known.get("distance_last", micro.distance[-1])
    if micro.distance[-1] < end * (1 - SAME):
        note = f"our run ends after {1e3 * micro.distance[-1]:.3g} mm of sliding, the paper's after {1e3 * end:.3g} mm"
        return {**settings, **_new_surfaces(micro, known), **dict.fromkeys(_RUN_ROWS, Ours(None, note))}
    return {**settings, **_new_surfaces(micro, known), **_area_and_wear(micro, known, end),
            **_friction(micro, known, end)}


def _published_points(micro, known):
    """The product at its pressures and disc speeds within the paper's range."""
    axes = {"pressure": micro.pressure, "speed": micro.disc_speed}
    selected = {name: _within(axis, known.get(f"{name}_lowest", 0.0), known.get(f"{name}_highest", np.inf))
                for name, axis in axes.items()}
    values = {field.name: getattr(micro, field.name) for field in fields(micro)}
    for field in fields(micro):
        for axis, dimension in enumerate(field.metadata["dims"]):
            if dimension in selected:
                values[field.name] = values[field.name].compress(selected[dimension], axis)
    return type(micro)(**values)


def _within(axis, low, high):
    """Mask of the values from ``low`` to ``high``."""
    return (axis >= low * (1 - SAME)) & (axis <= high * (1 + SAME))


def _settings(micro):
    return {"micro_pressures": ours(micro.pressure.size, "a setting of this case, not a result"),
            "micro_speeds": ours(micro.speed.size, "a setting of this case, not a result"),
            "distance_last": ours(micro.distance[-1], "a setting of this case, not a result: last recorded distance")}


def _new_surfaces(micro, known):
    middle = micro.speed.size // 2
    area, friction = micro.real_area[:, middle, 0], micro.friction[:, middle, 0]
    low = index_of([known.get("pressure_lowest")], micro.pressure)
    cycle = known.get("distance_last", np.nan) / known.get("wear_iterations", np.nan)
    largest = np.interp(cycle, micro.distance, micro.largest_wear.max(axis=(0, 1)))
    by_speed, by_pressure = (np.ptp(micro.friction, axis=axis).max() for axis in (1, 0))
    influence = ratio(by_speed, by_pressure) if micro.speed.size > 1 else np.nan
    return {
        "real_area_start": ours(None if low is None else area[low], "lowest pressure, middle speed, new surfaces"),
        "real_area_rises_with_pressure": ours(_smallest(area[1:] / area[:-1]), "middle speed, new surfaces"),
        "largest_wear_first": ours(largest, f"largest of the paper's operating points after {1e6 * cycle:.3g} um, the"
                                   " distance of one of the paper's iterations, by interpolation from new"),
        "friction_pressure_difference_start": ours(_range(friction), "middle speed, new surfaces"),
        "friction_speed_over_pressure": ours(influence, "largest differences, all else equal"),
    }


def _area_and_wear(micro, known, end):
    middle = micro.speed.size // 2
    depth = _at(micro, micro.wear_depth, end)[:, middle]
    growth = (_at(micro, micro.real_area, end) - micro.real_area[:, :, 0])[:, middle]
    low = index_of([known.get("pressure_lowest")], micro.pressure)
    note = f"middle speed, {1e3 * end:.3g} mm"
    steeper = ratio(growth[-1], growth[0]) if growth.size > 1 else np.nan
    return {
        "real_area_growth": ours(None if low is None else growth[low], f"lowest pressure, {note}"),
        "real_area_growth_rises_with_pressure": ours(steeper, f"highest over lowest pressure, {note}"),
        "wear_depth": ours(depth.mean(), f"mean over pressure, {note}"),
        "wear_depth_over_pressure": ours(ratio(_range(depth), depth.mean()), note),
        "largest_wear_last": ours(_at(micro, micro.largest_wear, end).max(), "largest of the paper's operating points"),
    }


def _friction(micro, known, end):
    middle = micro.speed.size // 2
    friction = micro.friction[:, middle]
    curves = np.array([_at(micro, micro.friction, known.get(key, end))[:, middle]
                       for key in ("distance_first", "distance_middle", "distance_last")])
    follows = [correlation(a, f) for a, f in zip(micro.real_area[:, middle], friction, strict=True)]
    note = f"middle speed, {1e3 * end:.3g} mm"
    influence = ratio(np.ptp(curves, axis=0).max(), np.ptp(curves, axis=1).max())
    return {
        "friction_pressure_difference_end": ours(_range(curves[-1]), note),
        "friction_lowest": ours(micro.friction.min(), "smallest of the paper's operating points"),
        "friction_highest": ours(micro.friction.max(), "largest of the paper's operating points"),
        "friction_rises_with_pressure": ours(_smallest(np.diff(curves)), "middle speed, the paper's three distances"),
        "friction_rises_with_distance": ours((curves[-1] - curves[0]).min(), "middle speed, smallest over pressure"),
        "friction_distance_over_pressure": ours(influence, "largest differences, the paper's three distances"),
        "friction_follows_real_area": ours(min(follows), "middle speed, smallest over pressure"),
    }


def _at(micro, values, distance):
    """``values`` (pressure, speed, distance) at one distance, linear between the recorded ones."""
    return np.apply_along_axis(lambda curve: np.interp(distance, micro.distance, curve), 2, values)


def _range(values):
    return np.ptp(values) if values.size > 1 else np.nan


def _smallest(values):
    return values.min() if values.size else np.nan
