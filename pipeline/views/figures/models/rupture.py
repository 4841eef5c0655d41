"""Pictures of a rupture: velocity field with interface state, slip profiles, front speed, studies."""

import numpy as np

from pipeline.views.figures.style import (
    BLUE,
    COLOURS,
    FAINT,
    INK,
    LINES,
    MARKERS,
    RED,
    SEQUENTIAL,
    WIDTH,
    animated,
    drawing,
    legend,
    png,
    svg,
)

#: colours of the interface in the velocity field, as in the paper: white sticks, black slips; open is ours
STICK, SLIP, OPEN = "#ffffff", "#000000", RED
_SIDES = (BLUE, RED)
#: percentile of the particle speed at which the colours end
_BRIGHT = 99.7
#: inches around the velocity field: left, right, below, above (where the colour bar lies)
_AROUND = 0.62, 0.15, 0.52, 0.72
#: least distance of two labels beside the axes, over the height of the axes, and how often they are pushed apart
_APART, _PUSHES = 0.045, 30


def field(rupture, frame, dpi):
    """PNG of the particle speed in both plates, and of the interface: white sticks, black slips, red is open.

    Colours follow the square root of the speed, so that weak waves show beside the fronts.
    """
    from matplotlib.colors import PowerNorm

    norm = PowerNorm(0.5, 0.0, _limit(rupture))
    values = 1e3 * rupture.speed_field[frame]
    x, y = _reach(rupture)
    left, right, below, above = _AROUND
    high = (WIDTH - left - right) * np.ptp(y) / np.ptp(x)
    with drawing(high + below + above, left=left, right=right, top=above) as figure:
        axes = figure.subplots()
        shown = None
        for part in (slice(None, _rows_below(rupture)), slice(_rows_below(rupture), None)):
            ends = *rupture.field_x[[0, -1]], *rupture.field_y[part][[0, -1]]
            extent = 1e3 * np.array(ends)
            shown = axes.imshow(values[part], origin="lower", extent=extent, aspect="equal", norm=norm,
                                cmap=SEQUENTIAL, interpolation="bilinear")
        _interface(axes, rupture, frame)
        axes.set(xlabel="x / mm", ylabel="y / mm", xlim=x, ylim=y)
        axes.annotate(f"{1e6 * rupture.frame_time[frame]:.2f} µs", (0.02, 0.97), xycoords="axes fraction", va="top",
                      color="white")
        axes.grid(False)
        bar = axes.inset_axes([0.0, 1.0 + 0.08 / high, 1.0, 0.1 / high])
        figure.colorbar(shown, cax=bar, orientation="horizontal", ticklocation="top", label="particle speed / mm/s")
        return png(figure, dpi)


def _interface(axes, rupture, frame):
    """The line of the interface, each run of one state in its colour."""
    state, x = rupture.frame_state[frame], 1e3 * rupture.x
    cuts = np.flatnonzero(np.diff(state)) + 1
    for part in np.split(np.arange(state.size), cuts):
        ends = np.r_[part, min(part[-1] + 1, state.size - 1)]
        colour, name = ((STICK, "_sticks"), (SLIP, "_slips"), (OPEN, "_open"))[state[part[0]]]
        axes.plot(x[ends], 0.0 * ends, color=colour, lw=2.2, solid_capstyle="butt", zorder=3, label=name)


def animation(rupture, dpi, most=3_000_000):
    """Animated PNG of all frames, in few colours; frames are left out evenly until it holds ``most`` bytes."""
    return animated(lambda frame: field(rupture, frame, dpi), len(rupture.frame_time), 150, most)


def _reach(rupture):
    """((low, high) mm along x, same along y): as far as waves from the middle come, across at the slower P speed."""
    centre = 0.5 * (rupture.x[0] + rupture.x[-1])
    along, across = (1.05 * speed * rupture.duration for speed in
                     (rupture.dilatational_speed.max(), rupture.dilatational_speed.min()))
    low, high = rupture.field_y[[0, -1]]
    return (1e3 * np.clip([centre - along, centre + along], *rupture.x[[0, -1]]),
            1e3 * np.clip([-across, across], low, high))


def _limit(rupture):
    return max(1e3 * float(np.percentile(rupture.speed_field, _BRIGHT)), 1e-9)


def _rows_below(rupture):
    """Rows of the lower plate: the interface stands twice, first as the lower plate's last row."""
    return int(np.flatnonzero(np.diff(rupture.field_y) == 0.0)[0]) + 1


def slip_profiles(rupture):
    """SVG of the slip over x at all profile times (Figure 9 of the paper)."""
    from matplotlib import colormaps

    with drawing(3.4, top=0.2) as figure:
        axes = figure.subplots()
        shades = colormaps[SEQUENTIAL](np.linspace(0.0, 0.9, len(rupture.profile_time)))
        for time, slip, colour in zip(rupture.profile_time, rupture.slip, shades, strict=True):
            axes.plot(1e3 * rupture.x, 1e9 * slip, color=colour, lw=1.1, label=f"{1e6 * time:.2f} µs")
        for side, stop in zip(rupture.side, rupture.stop, strict=True):
            axes.axvline(1e3 * stop, color=FAINT, lw=0.8, ls="--")
            axes.annotate(f"{side} {1e3 * stop:.2f}", (1e3 * stop, 0.97), xycoords=("data", "axes fraction"),
                          rotation=90, va="top", ha="right", fontsize=8, color=INK)
        reach = 1.15 * np.abs(rupture.stop - 0.5 * rupture.x[-1]).max() + 0.02 * rupture.x[-1]
        axes.set(xlabel="x / mm", ylabel="slip / nm", xlim=1e3 * (0.5 * rupture.x[-1] + np.array([-reach, reach])))
        axes.legend(loc="upper left", fontsize=7.5, handlelength=1.2)
        return svg(figure)


def arrivals(rupture):
    """SVG of the arrival of the pulse and of the first slip over x: what tells pulse from precursor."""
    with drawing() as figure:
        axes = figure.subplots()
        first, reached = rupture.first_slip > 0.0, rupture.reached == 1
        axes.plot(1e3 * rupture.x[first], 1e6 * rupture.first_slip[first], ".", color=COLOURS[4], ms=2.5,
                  label="first slip")
        axes.plot(1e3 * rupture.x[reached], 1e6 * rupture.arrival[reached], ".", color=INK, ms=2.5, label="pulse")
        axes.plot(1e3 * rupture.x[reached], 1e6 * rupture.healed[reached], ".", color=COLOURS[2], ms=1.5,
                  label="healed")
        axes.set(xlabel="x / mm", ylabel="time / µs")
        legend(axes)
        return svg(figure)


def speed_over_x(rupture):
    """SVG of the front speed over x with the wave speeds of both solids."""
    waves = [("$c_P$ 1", rupture.dilatational_speed[0]), ("$c_P$ 2", rupture.dilatational_speed[1]),
             ("$c_S$ 1", rupture.shear_speed[0]), ("$c_S$ 2", rupture.shear_speed[1]),
             ("$c_R$ 2", rupture.rayleigh_speed[1])]
    if rupture.interface_wave:
        waves.append(("$c_{GR}$", rupture.generalised_rayleigh_speed))
    with drawing(3.6, right=0.55, top=0.2) as figure:
        axes = figure.subplots()
        known = rupture.front_speed > 0.0
        axes.plot(1e3 * rupture.x[known], rupture.front_speed[known], ".", color=INK, ms=3)
        highest = 1.2 * float(rupture.dilatational_speed.max())
        heights = _apart([float(speed) for _, speed in waves], _APART * highest)
        for number, ((name, speed), height) in enumerate(zip(waves, heights, strict=True)):
            axes.axhline(speed, color=COLOURS[number % 6], ls=LINES[number % 6], lw=1.0)
            axes.annotate(name, (1.01, height), xycoords=("axes fraction", "data"), fontsize=8, va="center",
                          color=COLOURS[number % 6])
        axes.set(xlabel="x / mm", ylabel="front speed / m/s", ylim=(0, highest))
        return svg(figure)


def _apart(values, least):
    """Places near ``values``, in their order, pushed apart until no two are much closer than ``least``."""
    positions = np.array(values)
    order = np.argsort(positions)
    for _ in range(_PUSHES):
        for low, high in zip(order, order[1:], strict=False):
            push = 0.5 * max(least - (positions[high] - positions[low]), 0.0)
            positions[low], positions[high] = positions[low] - push, positions[high] + push
    return positions


def phase_diagram(rupture):
    """SVG over the stress ratio: how far both fronts run, how fast, and what becomes of them."""
    stress_runs = rupture.study == "stress"
    order = np.argsort(rupture.study_ratio[stress_runs])
    ratio, centre = rupture.study_ratio[stress_runs][order], 0.5 * (rupture.x[0] + rupture.x[-1])
    with drawing(5.2, top=0.8) as figure:
        figure.subplots_adjust(hspace=0.45)
        above, below = figure.subplots(2, sharex=True)
        for side, name in enumerate(rupture.side):
            far = 1e3 * np.abs(rupture.study_stop[stress_runs][order, side] - centre)
            outcome = rupture.study_outcome[stress_runs][order, side]
            speed = rupture.study_speed[stress_runs][order, side]
            kind = rupture.study_kind[stress_runs][order, side]
            above.plot(ratio, far, color=_SIDES[side], ls=LINES[side], lw=1.0)
            for mark, wanted in (("x", ("died",)), ("s", ("stopped",)), (">", ("running", "edge"))):
                selected = np.isin(outcome, wanted)
                above.plot(ratio[selected], far[selected], mark, color=_SIDES[side], label=f"{name}: {wanted[0]}")
            for fill, wanted in ((_SIDES[side], "pulse"), ("none", "crack")):
                selected = (kind == wanted) & (speed > 0.0)
                below.plot(ratio[selected], speed[selected], MARKERS[side], color=_SIDES[side], mfc=fill,
                           label=f"{name} {wanted}")
        above.set(ylabel="run / mm")
        below.set(xlabel="shear over pressure", ylabel="speed / m/s")
        legend(above, 2)
        legend(below, 2)
        return svg(figure)


def mesh_study(rupture):
    """SVG of speed and pulse width over the spacing, with and without memory of the pressure, per Poisson ratio."""
    mesh_runs = rupture.study == "mesh"
    with drawing(5.4, top=0.6) as figure:
        panels = figure.subplots(3, sharex=True)
        groups = sorted(set(zip(rupture.study_poisson[mesh_runs], rupture.study_memory[mesh_runs], strict=True)))
        for number, (poisson, memory) in enumerate(groups):
            selected = mesh_runs & (rupture.study_poisson == poisson) & (rupture.study_memory == memory)
            order = np.flatnonzero(selected)[np.argsort(rupture.study_spacing[selected])]
            label = f"ν {poisson:g}, " + (f"memory {1e9 * memory:.0f} ns" if memory else "Coulomb")
            look = {"color": COLOURS[number % 6], "ls": LINES[number % 6], "marker": MARKERS[number % 6],
                    "label": label}
            spacing = 1e6 * rupture.study_spacing[order]
            panels[0].plot(spacing, rupture.study_speed[order, 1], **look)
            panels[1].plot(spacing, rupture.study_speed[order, 0], **look)
            panels[2].plot(spacing, 1e6 * rupture.study_width[order, 1], **look)
        if rupture.interface_wave:
            panels[0].axhline(float(rupture.generalised_rayleigh_speed), color=FAINT, lw=1.0, ls=":")
        for axes, name in zip(panels, ("right / m/s", "left / m/s", "width right / µm"), strict=True):
            axes.set(ylabel=name, xscale="log")
        ticks = 1e6 * np.unique(rupture.study_spacing[mesh_runs])
        panels[2].set_xticks(ticks, [f"{tick:.4g}" for tick in ticks])
        panels[2].set_xticks([], minor=True)
        panels[2].set(xlabel="spacing / µm")
        legend(panels[0], 2)
        return svg(figure)


def static_state(rupture):
    """SVG of pressure and shear before the rupture."""
    with drawing() as figure:
        axes = figure.subplots()
        stresses = (("pressure", rupture.static_pressure), ("shear", rupture.static_shear))
        for number, (name, values) in enumerate(stresses):
            axes.plot(1e3 * rupture.x, 1e-6 * values, color=COLOURS[number], ls=LINES[number], label=name)
        axes.set(xlabel="x / mm", ylabel="stress / MPa")
        legend(axes)
        return svg(figure)
