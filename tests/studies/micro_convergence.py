"""'make study_micro': how far friction, real area and wear of the default pair hang on grid, patch, layers and cycles.

The rough pair of configs/disc_brake.yaml is taken through 10 mm of sliding at 1 and 3 MPa, each time with one choice
made finer or larger, over the same pairs of surfaces (a larger patch is of other surfaces: there scatter is told).
Prints one table for each choice, in Markdown, with the limit that the last three values tell (``grid_limit``) and its
error; draws them into the folder. Then the CPU time of one normal contact from 64^2 to 1024^2 nodes beside N log N.
"""

import argparse
import time
from functools import partial
from pathlib import Path
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np

from pipeline.case_models.rough.pair import rough_pair
from pipeline.contract.settings import fill
from pipeline.physics.numerics.grid_limit import grid_limit
from pipeline.physics.rough.contact.normal_contact import solve_normal_contact
from stages.micro_friction import Settings as MicroSettings
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface
from tests.studies.forced import ROOT, shared_out
from tests.studies.paper_micro import DENSITY, sections, slid

NUMBERS = {"real area at 1 MPa, new (%)": (100.0, "{:.2f}"), "friction at 1 MPa, new": (1.0, "{:.3f}"),
           "p dmu/dp, new": (1.0, "{:.3f}"), "friction at 1 MPa, worn": (1.0, "{:.3f}"),
           "p dmu/dp, worn": (1.0, "{:.3f}"), "wear depth at 1 MPa (um)": (1e6, "{:.3f}")}
POINTS = {"pressures": ["1 MPa", "3 MPa"], "disc_speeds": ["10.25 rad/s"], "recorded_distances": ["0 mm", "10 mm"]}


class Sweep(NamedTuple):
    """One choice: its ``values``, ``changed(value)`` -> (patch in mm, section surface, section micro_friction), the
    ``pairs`` of each value, and its ``fineness`` (None: there is no limit to tell)."""

    values: tuple
    changed: object
    pairs: tuple
    fineness: object = None


def _grid(nodes):
    return 1.0, {"nodes": 16 * nodes}, {}


def _layers(thickness):
    return 2.0, {f"{body}_thickness": f"{thickness} mm" for body in ("disc", "pad")}, {}


SWEEPS = {
    "nodes per shortest wavelength": Sweep((4, 8, 16, 32), _grid, (4,) * 4, float),
    "edge of the patch (mm)": Sweep((0.5, 1.0, 2.0, 4.0), lambda edge: (edge, {}, {}), (16, 12, 8, 4)),
    "thickness of both blocks (mm)": Sweep((0.25, 0.5, 1.0, 2.0), _layers, (4,) * 4, float),
    "growth of the layers": Sweep((2.0, 1.5, 1.25), lambda growth: (2.0, {"layer_growth": growth}, {}), (2,) * 3,
                                  lambda growth: 1 / (growth - 1)),
    "cycles over 10 mm": Sweep((50, 100, 200, 400), lambda cycles: (2.0, {}, {"cycles": cycles}), (2,) * 4, float),
    "pass of the slider (um)": Sweep((0, 25, 50, 100), lambda stroke: (2.0, {}, {"stroke": f"{stroke} um"}), (2,) * 4),
}


def numbers(task):
    """(6,) NUMBERS of one pair: ``task`` is (Sweep's name, value, seed)."""
    name, value, seed = task
    patch, rough_changes, micro_changes = SWEEPS[name].changed(value)
    rough, micro = sections(patch, **(POINTS | micro_changes))
    found = slid(rough | rough_changes, micro, seed)
    friction, slopes = found.friction[:, 0], np.diff(found.friction[:, 0], axis=0)[0] / np.log(3.0)
    return np.array([found.real_area[0, 0, 0], friction[0, 0], slopes[0], friction[0, -1], slopes[-1],
                     found.wear_depth[0, 0, -1]])


def gathered(fan_out, names=tuple(SWEEPS)):
    """{name of a Sweep: [numbers (pairs, 6) of every value]}; ``fan_out`` maps as the builtin does."""
    tasks = [(name, value, seed) for name in names for value, pairs in zip(SWEEPS[name].values, SWEEPS[name].pairs,
                                                                           strict=True) for seed in range(pairs)]
    found = dict(zip(tasks, fan_out(numbers, tasks), strict=True))
    return {name: [np.array([found[name, value, seed] for seed in range(pairs)])
                   for value, pairs in zip(SWEEPS[name].values, SWEEPS[name].pairs, strict=True)] for name in names}


def table(name, found):
    """Lines of Markdown: mean and standard error at each value of a Sweep, ``found`` [(pairs, 6)], then the limit."""
    sweep = SWEEPS[name]
    lines = [f"| {name} | pairs | {' | '.join(NUMBERS)} |", "| --- " * (2 + len(NUMBERS)) + "|"]
    for value, each in zip(sweep.values, found, strict=True):
        error = each.std(axis=0, ddof=1) / np.sqrt(len(each))
        lines.append(f"| {value:g} | {len(each)} | {' | '.join(_cells(each.mean(axis=0), error))} |")
    if sweep.fineness is not None:
        limits = [grid_limit([sweep.fineness(v) for v in sweep.values], [each[:, k].mean() for each in found])
                  for k in range(len(NUMBERS))]
        lines.append(f"| limit | | {' | '.join(_cells([x.value for x in limits], [x.error for x in limits]))} |")
    return lines


def _cells(values, errors):
    return [f"{layout.format(unit * value)} ± {layout.format(unit * error)}"
            for (unit, layout), value, error in zip(NUMBERS.values(), values, errors, strict=True)]


def drawn(found, path):
    """Draw every Sweep of ``found`` to ``path``: values relative to the last, with their standard errors."""
    figure, axes = plt.subplots(2, (len(found) + 1) // 2, figsize=(4 * ((len(found) + 1) // 2), 7), squeeze=False)
    for ax, (name, each) in zip(axes.flat, found.items(), strict=False):
        means = np.array([values.mean(axis=0) for values in each])
        errors = np.array([values.std(axis=0, ddof=1) / np.sqrt(len(values)) for values in each])
        for k, label in enumerate(NUMBERS):
            ax.errorbar(SWEEPS[name].values, means[:, k] / means[-1, k], errors[:, k] / abs(means[-1, k]), label=label,
                        marker="o", capsize=2, linewidth=1)
        ax.set(xlabel=name, ylabel="over the last", xscale="symlog" if 0 in SWEEPS[name].values else "log")
    axes[0, 0].legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def solve_seconds(nodes):
    """CPU seconds of one normal contact at 2 MPa on ``nodes``^2 nodes of the default spacing."""
    rough, micro = sections(nodes / DENSITY)
    settings = fill(MicroSettings, micro, "micro_friction")
    pair = rough_pair(surface(settings=fill(SurfaceSettings, rough, "surface")), settings)
    begin = time.process_time()
    solve_normal_contact(-pair.pad_height - pair.disc_height, pair.compliance.normal, 2e6, tolerance=settings.tolerance)
    return time.process_time() - begin


def cost(sizes):
    """Lines: CPU seconds of one contact, and over N log N relative to the first."""
    seconds = [solve_seconds(n) for n in sizes]
    per = [s / (n * n * np.log(n * n)) for s, n in zip(seconds, sizes, strict=True)]
    return ["| nodes | CPU s | over N log N, first = 1 |", "| --- | --- | --- |",
            *(f"| {n}² | {s:.3f} | {p / per[0]:.2f} |" for n, s, p in zip(sizes, seconds, per, strict=True))]


def main():
    """Compute what is chosen, print the tables, draw them."""
    parser = argparse.ArgumentParser(prog="make study_micro", description=__doc__)
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_micro")
    parser.add_argument("--only", nargs="*", default=tuple(SWEEPS), choices=tuple(SWEEPS))
    parser.add_argument("--workers", type=int, default=2, help="processes")
    chosen = parser.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    found = gathered(partial(shared_out, workers=chosen.workers), tuple(chosen.only))
    for name, each in found.items():
        print("\n".join(table(name, each)), end="\n\n")
    print("\n".join(cost((64, 128, 256, 512, 1024))))
    drawn(found, chosen.folder / "convergence.svg")


if __name__ == "__main__":
    main()
