"""Settings of a case with origins, as tables."""

from numbers import Real
from pathlib import Path

from pipeline.views.figures.number_format import quantity

#: origins to be questioned first
SOFT = ("tuned", "assumed", "inferred")


def stages(case):
    """One entry per stage in chain order: name, rows (key, meaning, value, origin, source), count of soft values."""
    entries = []
    for stage, settings in case.settings.items():
        rows = [_row(case, stage, key, value) for key, value in settings.items()]
        soft = {origin: sum(row["origin"] == origin for row in rows) for origin in SOFT}
        entries.append({"name": stage, "rows": rows, "soft": {k: n for k, n in soft.items() if n}})
    return entries


def methods(case):
    """(stage, sentence) with every {setting} of the sentence in its convenient unit."""
    return tuple((stage, _filled_in(case, stage, sentence)) for stage, sentence in case.methods.items())


def _filled_in(case, stage, sentence):
    settings, units = case.settings.get(stage, {}), case.units.get(stage, {})
    return sentence.format(**{key: written(value, units.get(key, "")) for key, value in settings.items()})


def tuned(case):
    """(dotted name, value) of every setting whose origin is 'tuned'."""
    return tuple((f"{entry['name']}.{row['key']}", row["value"]) for entry in stages(case) for row in entry["rows"]
                 if row["origin"] == "tuned")


def written(value, unit):
    """A setting as text: quantities in a convenient unit, files by name."""
    if value is None:
        return "—"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Path):
        return value.name
    if isinstance(value, dict):
        return ", ".join(f"{name}: {written(inner, unit)}" for name, inner in value.items()) or "—"
    many = isinstance(value, (tuple, list))
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Real) or (many and value and all(isinstance(v, Real) for v in value)):
        return quantity(value, unit or "1", 6)
    return ", ".join(written(v, unit) for v in value) if many else str(value)


def _idle(case, stage, key):
    """'no effect while hat_height is 0 m' of a setting that has none as the case stands; '' of others."""
    other = case.idle.get(stage, {}).get(key, "")
    value, unit = case.settings.get(stage, {}).get(other), case.units.get(stage, {}).get(other, "")
    return f"no effect while {other} is {'none' if value is None else written(value, unit)}" if other else ""


def _row(case, stage, key, value):
    origin = case.origins.get(stage, {}).get(key, {})
    said = origin.get("source", ""), origin.get("doubt", ""), _idle(case, stage, key)
    return {"key": key, "meaning": case.meanings.get(stage, {}).get(key, ""),
            "value": written(value, case.units.get(stage, {}).get(key, "")), "origin": origin.get("origin", "default"),
            "source": "; ".join(filter(None, said))}
