"""The table of a product Countermeasures as CSV: one row of each mode, and one of each variant over all points."""

import csv
import io

import numpy as np

_ROOT = ("frequency", "growth", "damping ratio")
_HEAD = ("variant", "change", "pressure / MPa", "speed / rad/s",
         *(f"{name} {when}{unit}" for when in ("before", "after")
           for name, unit in zip(_ROOT, (" / Hz", " / 1/s", ""), strict=True)),
         "MAC", "MAC of a rival", "match", "state", "error of growth / 1/s",
         *(f"squeal probability {what}" for what in (
             "before", "before, low", "before, high", "after", "after, low", "after, high", "change", "change, low",
             "change, high")), "change exceeds interval")


def csv_table(product):
    """Text of the CSV file; the row of a variant over all operating points names none, and no mode."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow((*_HEAD, *(f"{name} / {unit}" if unit else name for name, unit in
                               zip(product.cost_name, product.cost_unit, strict=True))))
    for variant, name in enumerate(product.variant):
        head, costs = (name, product.change[variant]), _costs(product, variant)
        writer.writerow((*head, "any", "any", *[""] * 11, *_overall(product, variant), *costs))
        for row in np.flatnonzero(product.mode_variant == variant):
            point = int(product.mode_operating[row])
            writer.writerow((*head, f"{product.pressure[point] / 1e6:.6g}", f"{product.speed[point]:.6g}",
                             *_of_mode(product, row), *_at(product, variant, point), *costs))
    return stream.getvalue()


def _of_mode(product, row):
    cells = []
    for when in ("before", "after"):
        root, known = getattr(product, when)[row], getattr(product, f"{when}_known")[row]
        cells += [f"{v:.6g}" for v in (root.imag / (2 * np.pi), root.real, -root.real / abs(root))] if known else \
            [""] * 3
    return (*cells, f"{product.mac[row]:.4g}", f"{product.rival_mac[row]:.4g}",
            "clear" if product.clear[row] else "ambiguous", product.state[row], f"{product.error[row]:.4g}")


def _at(product, variant, point):
    """Probabilities at an operating point; empty where none was sampled."""
    here = sampled(product, point)
    if here is None:
        return [""] * 10
    return _cells(product.probability[here], product.interval[here], product.variant_probability[variant, here],
                  product.variant_interval[variant, here], product.probability_change[variant, here],
                  product.change_interval[variant, here])


def sampled(product, point):
    """Index of the sampled operating point that is operating point number ``point``; None where none is."""
    same = np.flatnonzero((product.sampled_pressure == product.pressure[point])
                          & (product.sampled_speed == product.speed[point]))
    return int(same[0]) if len(same) else None


def _overall(product, variant):
    if not product.draws:
        return [""] * 10
    return _cells(product.overall, product.overall_interval, product.variant_overall[variant],
                  product.variant_overall_interval[variant], product.overall_change[variant],
                  product.overall_change_interval[variant])


def _cells(before, before_ends, after, after_ends, change, ends):
    exceeds = "yes" if ends[0] > 0 or ends[1] < 0 else "no"
    return [*(f"{float(v):.6g}" for v in (before, *before_ends, after, *after_ends, change, *ends)), exceeds]


def _costs(product, variant):
    return [f"{value:.6g}" if known else "" for value, known in
            zip(product.cost[variant], product.cost_known[variant], strict=True)]
