"""Spots of a rough pair over pressure, wear and the ratio of both wear coefficients: from a few runs to any point.

Three exact scalings leave so few axes. The solids are linear: at E times its modulus a pair touches under E times the
pressure as it did, and its spots are pressed E times as hard (both solids, or a disc so stiff that only the pad
yields). Archard's depth is coefficient times pressure times way, so that only their product counts. In full slip
friction is limit times area over pressure, so that whatever acts on the limit needs no new contact. Between the runs ln
of the area is a bicubic spline over ln pressure and ln(1 + wear) that goes on straight outside them, and a parabola
over the ratio.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy

from pipeline.physics.rough.sliding_pair import passed, spot_limit, spots, states

#: wear of the disc over that of the pad: all that the pad loses sticks there, about half, and nearly as fast
RATIOS = (-1.0, -0.3, 0.4)
#: wear cycle from which the coordinate of wear is logarithmic, as a share of all
_KNEE = 0.05


@dataclass(frozen=True)
class SpotTable:
    """``area`` (p, w, r) and ``heating`` (v, p, w, r) in K/Pa of spots, mean over realisations and a pass.

    Axes: ``pressure`` Pa, ``worn`` (pad coefficient times way, m/Pa), RATIOS, ``speed`` m/s. ``scatter``: relative
    standard error of the area by the realisations, beyond what fitted values can take up.
    """

    pressure: np.ndarray
    worn: np.ndarray
    speed: np.ndarray
    area: np.ndarray
    heating: np.ndarray
    scatter: float

    def at(self, pressure, worn, ratio, speed):
        """(area share (n,), heating (n,) in K/Pa) at points (n,); heating between speeds by a power of the speed."""
        pressure, worn, ratio, speed = np.broadcast_arrays(*(np.atleast_1d(np.asarray(a, float))
                                                             for a in (pressure, worn, ratio, speed)))
        place = np.log(pressure), self._wear(worn), ratio
        area, *heating = (self._read(layers, *place) for layers in self._splines)
        row = np.interp(np.log(speed), np.log(self.speed), np.arange(len(self.speed)))
        low, point = np.floor(row).astype(int), np.arange(len(row))
        high = np.minimum(low + 1, len(self.speed) - 1)
        heating = np.array(heating)
        between = (1 - row + low) * heating[low, point] + (row - low) * heating[high, point]
        return np.exp(area), np.exp(between)

    @cached_property
    def _splines(self):
        """Of ln area, then of ln heating at every speed: one spline for each of the RATIOS."""
        axes = np.log(self.pressure), self._wear(self.worn)
        return [[scipy.interpolate.RectBivariateSpline(*axes, np.log(table[..., k])) for k in range(len(RATIOS))]
                for table in (self.area, *self.heating)]

    def _wear(self, worn):
        return np.log1p(worn / (_KNEE * self.worn[-1]))

    def _read(self, layers, pressure, wear, ratio):
        """What the splines ``layers`` tell at points (n,), straight on outside their runs."""
        axes, total = (np.log(self.pressure), self._wear(self.worn)), 0.0
        inside = [np.clip(c, a[0], a[-1]) for c, a in zip((pressure, wear), axes, strict=True)]
        for weight, spline in zip(_parabola(ratio), layers, strict=True):
            beyond = (pressure - inside[0]) * spline.ev(*inside, dx=1) + (wear - inside[1]) * spline.ev(*inside, dy=1)
            total = total + weight * (spline.ev(*inside) + beyond)
        return total


def spot_table(pairs, pressure, cycles, speed, fan_out):
    """SpotTable of Rubbings ``pairs`` (realisations) at pressures (p,) Pa and after ``cycles`` (w,) of their wear.

    ``fan_out(function, tasks)`` maps as the builtin does; p x 3 x realisations slides, each without shear.
    """
    wearing = pairs[0].wearing
    tasks = [(_worn_so(pair, ratio), p, tuple(cycles), tuple(speed)) for p in pressure for ratio in RATIOS
             for pair in pairs]
    values = np.array(list(fan_out(_slide, tasks)))              # (task, w, 1 + v)
    values = values.reshape(len(pressure), len(RATIOS), len(pairs), len(cycles), 1 + len(speed))
    values = values.transpose(2, 4, 0, 3, 1)
    mean, worn = values.mean(axis=0), wearing.pad_coefficient * wearing.distance * np.asarray(cycles, float)
    table = SpotTable(np.asarray(pressure, float), worn, np.asarray(speed, float), mean[0], mean[1:], 0.0)
    return replace(table, scatter=_scatter(table, np.log(values[:, 0])))


def friction(table, rubbing, drag, softer=1.0):
    """Friction (n,) at the points of a Drag: that of a Rubbing whose pad has 1 / ``softer`` of the table's modulus."""
    wearing = rubbing.wearing.under(drag.pressure)
    ratio = wearing["disc_coefficient"] / wearing["pad_coefficient"]
    area, heating = table.at(softer * drag.pressure, wearing["pad_coefficient"] * drag.distance / softer, ratio,
                             drag.speed)
    shearing = rubbing.shearing.after(drag.pressure, drag.distance)
    return spot_limit(shearing, drag.pressure, area, drag.speed, heating) * area / drag.pressure


def mean_wear(rubbing, drag):
    """Mean depth (pad, disc) in m at the end of a Drag: coefficient times pressure times way, whatever the spots."""
    wearing, way = rubbing.wearing.under(drag.pressure), drag.pressure * drag.distance.max()
    return wearing["pad_coefficient"] * way, wearing["disc_coefficient"] * way


def _scatter(table, areas):
    """Standard error of the mean of ln areas (realisation, p, w, r), beyond what fitted values can take up.

    A factor on the limit, the modulus and the wear coefficient shift ln area, tilt it over ln pressure and over wear.
    """
    if len(areas) < 2:
        return 0.0
    pressure, worn = np.meshgrid(np.log(table.pressure), table._wear(table.worn), indexing="ij")
    basis = np.repeat(np.stack([np.ones_like(worn), pressure, worn], axis=-1), len(RATIOS), axis=1).reshape(-1, 3)
    apart = (areas - areas.mean(axis=0)).reshape(len(areas), -1).T
    shifted, *_ = np.linalg.lstsq(basis, apart, rcond=None)
    left = apart - basis @ shifted
    return float(np.sqrt((left**2).sum() / (left.shape[0] * (len(areas) - 1)) / len(areas)))


def _worn_so(pair, ratio):
    return replace(pair, wearing=replace(pair.wearing, disc_coefficient=ratio * pair.wearing.pad_coefficient,
                                         exponent=0.0))


def _slide(task):
    """Rows (w, 1 + v) of real area and heating of one slide."""
    rubbing, pressure, cycles, speed = task
    rubbing, rows = replace(rubbing, wearing=replace(rubbing.wearing, cycles=max(cycles))), []
    for cycle, worn in enumerate(states(rubbing, pressure)):
        if cycle in cycles:
            met = [spots(c.pressure, rubbing.pair, rubbing.shearing, speed) for c in passed(rubbing, worn, pressure)]
            rows.append(np.mean([(area, *heating) for area, _, heating in met], axis=0))
    return np.array(rows)


def _parabola(ratio):
    """Weights (3, n) of the three RATIOS at ratios (n,) (Lagrange)."""
    return [np.prod([(ratio - r) / (node - r) for r in RATIOS if r != node], axis=0) for node in RATIOS]
