"""What draws of a noise matrix say: occurrence of squeal by condition, module, band and brake; what the map covers."""

import numpy as np

from pipeline.physics.stability.occurrence_rates import rate


def predicted(noisy, applications):
    """Fields of a product NoiseMatrix: of draws ``noisy`` (brakes, repeats, c, b) and ``applications`` (m, c)."""
    anywhere = noisy.any(axis=3)
    rates = [rate(anywhere[:, :, k]) for k in range(anywhere.shape[2])]
    modules = [rate(anywhere @ row) for row in applications / applications.sum(axis=1, keepdims=True)]
    weight = applications.sum(axis=0) / applications.sum()
    whole, bands = rate(anywhere @ weight), noisy.mean(axis=(0, 1))
    return {
        "noisy": anywhere.reshape(-1, len(rates)).astype(int), "probability": [r.share for r in rates],
        "interval": [r.interval() for r in rates], "correlation": [r.correlation for r in rates],
        "band_probability": bands, "band_occurrence": weight @ bands,
        "module_occurrence": [r.share for r in modules], "module_interval": [r.interval() for r in modules],
        "occurrence": whole.share, "occurrence_interval": whole.interval(),
        "brake_occurrence": (anywhere @ weight).mean(axis=1)}


def described(plan, settings):
    """Fields of a product NoiseMatrix that describe the Schedule ``plan``."""
    columns = list(zip(*plan.origins, strict=True)) or [()] * 5
    names = ("origin_module", "origin_setting", "origin_value", "origin", "origin_source")
    conditions = {name: np.array([getattr(c, name) for c in plan.conditions])
                  for name in ("kind", "pressure", "speed", "end", "temperature")}
    return {
        "title": plan.title, "published_sections": plan.published.sections,
        "published_applications": plan.published.applications, "published_source": plan.published.source,
        "not_available": plan.not_available, **dict(zip(names, map(list, columns), strict=True)),
        "module": [m.module for m in plan.modules], "applications": plan.applications, **conditions,
        "kind": [c.kind for c in plan.conditions], "pad_pressure": settings.pressure_factor * conditions["pressure"],
        "wheel_radius": settings.wheel_radius, "level": settings.level}


def outside(friction_map, plan, lever, settings):
    """(c,) 1 where a condition of the Schedule ``plan`` lies, in part or throughout, beyond the pressures and sliding
    speeds at which the FrictionMap was computed; ``lever`` (k,) m of the contacts. All 0 without a map."""
    if friction_map is None:
        return np.zeros(len(plan.conditions), int)
    return np.array([int(_beyond(friction_map, condition, lever, settings)) for condition in plan.conditions])


def _beyond(friction_map, condition, lever, settings):
    pressure = settings.pressure_factor * condition.pressure
    speed = abs(condition.speeds(settings.points)) / settings.wheel_radius * float(np.mean(lever))
    pressures, speeds = friction_map.computed_pressure, friction_map.computed_speed
    return not (pressures[0] <= pressure <= pressures[-1] and speeds[0] <= speed.min() and speed.max() <= speeds[-1])
