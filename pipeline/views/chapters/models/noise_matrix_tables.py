"""Tables of a noise matrix: where the bench differs, occurrence by module, what scatters, origins of the schedule."""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.chapters.probability import in_words
from pipeline.views.figures.models import noise_matrix as pictures
from pipeline.views.figures.number_format import number, percent
from pipeline.views.figures.probability import nominal

#: the sign of a difference -> what it says
TOO = {1: "the model squeals too much", -1: "the model squeals too little"}


def tables(product):
    """Tables of the chapter that have rows."""
    made = (_differences(product), _modules(product), _scatter(product), _unmatched(product), _origins(product))
    return tuple(table for table in made if table.rows)


def differing(product):
    """[(name, noisy, stops, expected, family-wise p, sign)] of conditions and bands that differ, clearest first."""
    stops = int(product.condition_stops.sum())
    conditions = [(named(pictures.column(product, k), product.pressure[k], product.temperature[k]),
                   int(product.condition_noisy[k]), int(product.condition_stops[k]), product.condition_expected[k],
                   product.condition_p_value[k], int(product.condition_difference[k]))
                  for k in np.flatnonzero(product.condition_difference)]
    bands = [(f"1/3 octave of {nominal(product.band[k]) / 1e3:g} kHz", int(product.band_noisy[k]), stops,
              product.band_expected[k], product.band_p_value[k], int(product.band_difference[k]))
             for k in np.flatnonzero(product.band_difference)]
    return sorted(conditions + bands, key=lambda row: row[4])


def named(column, pressure, temperature=0.0):
    """A condition in words."""
    kind = "stops" if pictures.ARROW in column else "drags"
    turn = " in reverse" if column.startswith("R ") else ""
    warm = f", {temperature - 273.15:.3g} °C" if temperature else ""
    way = "from" if kind == "stops" else "at"
    speed = column.removeprefix("R ").replace(pictures.ARROW, " to ")
    return f"{kind} {way} {speed} km/h, {pressure / 1e5:.3g} bar{turn}{warm}"


def _differences(product):
    rows = [(name, f"{heard} / {stops}", number(expected, 3), number(p, 2), TOO[sign])
            for name, heard, stops, expected, p, sign in differing(product)]
    return Table(("condition or band", "recorded noisy / all", "predicted noisy", "family-wise p", "verdict"),
                 tuple(rows), "Where the bench and the model differ by more than chance", (1, 2, 3), (4,))


def _modules(product):
    rows = [(str(name), str(int(uses.sum())), percent(share, 3), f"{percent(low, 2)} to {percent(high, 2)}")
            for name, uses, share, (low, high) in zip(product.module, product.applications, product.module_occurrence,
                                                      product.module_interval, strict=True)]
    return Table(("module", "applications", "predicted noisy", "95 % interval"), tuple(rows), "Occurrence by module",
                 (1, 2, 3))


def _scatter(product):
    rows = [(in_words(name), str(law), "stop to stop" if varies else "brake to brake")
            for name, law, varies in zip(product.source, product.source_law, product.source_varies, strict=True)]
    return Table(("source", "scatter", "from"), tuple(rows), "What scatters", wide=(1,), folded=True)


def _unmatched(product):
    rows = [(str(product.run[k]), "yes" if product.run_noisy[k] else "no", str(product.run_reason[k]))
            for k in np.flatnonzero(product.run_condition < 0)]
    return Table(("run", "squeal", "reason"), tuple(rows), "Recorded stops that are no condition of the schedule", (),
                 (2,), folded=len(rows) > 8)


def _origins(product):
    rows = [tuple(map(str, row)) for row in zip(product.origin_module, product.origin_setting, product.origin_value,
                                                product.origin, product.origin_source, strict=True)]
    return Table(("module", "setting", "value", "origin", "source"), tuple(rows),
                 "Where the values of the schedule come from", (), (2, 4), folded=True)
