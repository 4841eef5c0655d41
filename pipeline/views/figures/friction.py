"""Curves of the micro study over sliding distance and pressure, its convergence, and the friction map."""

import numpy as np

from pipeline.views.figures.style import COLOURS, LINES, MARKERS, ORANGE, SEQUENTIAL, colour_bar, drawing, legend, svg


def over_distance(micro, what):
    """SVG of 'real_area', 'wear_depth' or 'friction' over sliding distance, one line per pressure, middle speed."""
    values, label, factor = {
        "real_area": (micro.real_area, "real contact area / % of nominal", 100.0),
        "wear_depth": (micro.wear_depth, "wear depth / µm", 1e6),
        "friction": (micro.friction, "coefficient of friction", 1.0),
    }[what]
    middle = len(micro.speed) // 2
    with drawing() as figure:
        axes = figure.subplots()
        for p, pressure in enumerate(micro.pressure):
            axes.plot(1e3 * micro.distance, factor * values[p, middle], color=COLOURS[p % 6], ls=LINES[p % 6],
                      label=f"{pressure / 1e6:.3g} MPa")
            if what == "friction":
                half = micro.friction_std[p, middle]
                axes.fill_between(1e3 * micro.distance, values[p, middle] - half, values[p, middle] + half,
                                  color=COLOURS[p % 6], alpha=0.2, lw=0, label=f"_{pressure / 1e6:.3g} MPa")
        axes.set(xlabel="sliding distance / mm", ylabel=label, xlim=(0, None))
        legend(axes)
        return svg(figure)


def over_pressure(micro):
    """SVG of mu over pressure after short, middle and long sliding, with standard errors, middle speed."""
    middle = len(micro.speed) // 2
    with drawing() as figure:
        axes = figure.subplots()
        for line, s in enumerate(_distances(micro)):
            axes.errorbar(micro.pressure / 1e6, micro.friction[:, middle, s], micro.friction_std[:, middle, s],
                          color=COLOURS[line], ls=LINES[line], marker=MARKERS[line], capsize=3,
                          label=f"{1e3 * micro.distance[s]:.2g} mm")
        axes.set(xlabel="pressure / MPa", ylabel="coefficient of friction", xticks=micro.pressure / 1e6)
        legend(axes)
        return svg(figure)


def from_rest(micro):
    """SVG of shear over normal force against the displacement from rest, one line per pressure."""
    with drawing() as figure:
        axes = figure.subplots()
        for p, pressure in enumerate(micro.pressure):
            order = np.argsort(micro.presliding_displacement[p])
            axes.plot(np.r_[0.0, 1e6 * micro.presliding_displacement[p][order]],
                      np.r_[0.0, micro.presliding_friction[p][order]], color=COLOURS[p % 6], ls=LINES[p % 6],
                      marker=MARKERS[p % 6], label=f"{pressure / 1e6:.3g} MPa")
        axes.set(xlabel="displacement from rest / µm", ylabel="shear over normal force", xlim=(0, None), ylim=(0, None))
        legend(axes)
        return svg(figure)


def bearing(micro):
    """SVG of the height that a share of the area exceeds (Abbott & Firestone), pad and disc; dashed: new."""
    with drawing() as figure:
        axes = figure.subplots()
        for body, colour in (("disc", COLOURS[0]), ("pad", COLOURS[1])):
            heights = {"disc": micro.disc_bearing, "pad": micro.pad_bearing}[body]
            for record, line, label in ((0, "--", f"_{body}, new"), (-1, "-", body)):
                axes.plot(100 * micro.bearing_share, 1e6 * heights[record], color=colour, ls=line, label=label)
        axes.set(xlabel="share of the area above / %", ylabel="height / µm", xlim=(0, 100))
        legend(axes)
        return svg(figure)


def convergence(micro):
    """SVG of the real contact area over nodes per shortest wavelength."""
    with drawing(2.6, top=0.12) as figure:
        axes = figure.subplots()
        axes.plot(micro.refinement, 100 * micro.refinement_area, marker="o", color=COLOURS[0])
        if micro.area_order:
            low, high = (100 * (micro.area_limit + side * micro.area_limit_error) for side in (-1, 1))
            axes.axhspan(low, high, color=COLOURS[1], alpha=0.3, lw=0)
            axes.axhline(100 * micro.area_limit, color=COLOURS[1], ls=LINES[1], label="limit, extrapolated")
            legend(axes)
        axes.set(xlabel="nodes per shortest wavelength", ylabel="real contact area / %",
                 ylim=(0, 115 * micro.refinement_area.max()))
        axes.set_xticks(micro.refinement, [f"{n:.3g}" for n in micro.refinement])
        return svg(figure)


def friction_map(product):
    """SVG of mu over speed and pressure at the largest distance: orange lines computed, hatched extrapolated."""
    return _over_points(product, product.friction[:, :, -1], "coefficient of friction", "%.3f")


def map_error(product):
    """SVG of the standard error of mu in the same way."""
    return _over_points(product, product.friction_std[:, :, -1], "its standard error", "%.4f")


def _over_points(product, values, label, layout):
    pressure, speed = _widened(product.pressure, product.computed_pressure), _widened(
        product.speed, product.computed_speed)
    rows = np.searchsorted(product.pressure, np.clip(pressure, product.pressure[0], product.pressure[-1]))
    columns = np.searchsorted(product.speed, np.clip(speed, product.speed[0], product.speed[-1]))
    values = values[np.ix_(rows, columns)]
    with drawing(3.5, bar=True) as figure:
        axes = figure.subplots()
        shown = axes.contourf(speed, pressure / 1e6, values, levels=_levels(values), cmap=SEQUENTIAL)
        shown.plotted = speed, pressure / 1e6, values
        _mark_computed(axes, product, speed, pressure)
        axes.set(xlabel="sliding speed / m/s", ylabel="pressure / MPa")
        axes.grid(False)
        colour_bar(axes, shown, label, format=layout)
        return svg(figure)


def _mark_computed(axes, product, speed, pressure):
    from matplotlib.patches import Rectangle

    left, right = product.computed_speed.min(), product.computed_speed.max()
    low, high = product.computed_pressure.min() / 1e6, product.computed_pressure.max() / 1e6
    first, last, bottom, top = speed[0], speed[-1], pressure[0] / 1e6, pressure[-1] / 1e6
    outside = ((first, bottom, last - first, low - bottom), (first, high, last - first, top - high),
               (first, low, left - first, high - low), (right, low, last - right, high - low))
    for x, y, width, height in outside:
        axes.add_patch(Rectangle((x, y), width, height, facecolor="none", edgecolor="white", hatch="///", lw=0,
                                 label="_"))
    axes.hlines(product.computed_pressure / 1e6, left, right, color=ORANGE, lw=2, label="_computed pressure")
    axes.vlines(product.computed_speed, low, high, color=ORANGE, lw=2, label="_computed speed")


def _widened(axis, computed):
    """The axis of the map, with a rim outside the computed range to show the constant extrapolation."""
    rim = 0.2 * max(np.ptp(computed), 0.2 * computed.max())
    return np.unique(np.concatenate([[max(computed.min() - rim, 0.0)], axis, [computed.max() + rim]]))


def _levels(values):
    low, high = values.min(), values.max()
    spread = max(high - low, 1e-3)
    return np.linspace(low - 0.02 * spread, high + 0.02 * spread, 13)


def _distances(micro):
    return sorted({0, (len(micro.distance) - 1) // 2, len(micro.distance) - 1})
