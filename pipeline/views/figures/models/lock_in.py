"""Pictures of the interface law and of lock-in."""

import numpy as np

from pipeline.views.figures.style import BLUE, COLOURS, FAINT, LINES, MARKERS, RED, drawing, legend, svg

_KINDS = ("classical", "intermediate", "multiple", "dual base", "other")
#: the paper's numbers in the map: (free length m, frequency Hz, what)
_PAPER = ((0.1515, 2215.0, "measured"), (0.1465, 2210.0, "simulated"), (0.1515, 2197.0, "simulated"),
          (0.1815, 1445.0, "simulated"))
_SAME_LENGTH = 1e-4


def normal_law(law):
    """Figure 4: pressure over the distance of the mean planes."""
    with drawing() as figure:
        axes = figure.add_subplot()
        axes.plot(1e6 * law.gap, law.gap_pressure / 1e6, color=BLUE)
        axes.set(xlabel="distance of the mean planes / µm", ylabel="pressure / MPa")
        return svg(figure)


def shear_law(law):
    """Figure 5: shear stress over displacement at several pressures."""
    with drawing(height=3.5, top=0.62) as figure:
        axes = figure.add_subplot()
        for k, colour, line in zip(_some(law), COLOURS, LINES, strict=False):
            axes.loglog(1e6 * law.displacement[1:], law.shear[k, 1:] / 1e6, color=colour, ls=line,
                        label=f"{law.pressure[k] / 1e6:.3g} MPa")
        axes.set(xlabel="tangential displacement / µm", ylabel="shear stress / MPa")
        legend(axes, 3)
        return svg(figure)


def descriptions(law):
    """Figures 6 to 8: the law at the middle pressure and its three descriptions, over their full slip."""
    k = len(law.pressure) // 2
    full = law.limit[k] / law.tangential_stiffness[k] * 4
    x, limit = law.displacement / full, law.limit[k]
    with drawing(height=3.5, top=0.62) as figure:
        axes = figure.add_subplot()
        axes.plot(x, law.shear[k] / limit, color=FAINT, lw=4, label="summits")
        axes.plot(x, law.evolution_shear[k] / limit, color=BLUE, label="evolution rule")
        axes.plot(x, law.elastic_shear[k] / limit, color=RED, ls="--", label="elastic stick")
        axes.plot([0, 0, 1], [0, 1, 1], color=COLOURS[2], ls="-.", label="rigid stick")
        axes.set(xlim=(-0.02, 1), xlabel="displacement / (4 limit / stiffness)", ylabel="shear stress / limit")
        legend(axes, 2)
        return svg(figure)


def length_map(lock_in):
    """Base of the motion over pin length by kind, the paper's numbers as crosses."""
    rows = np.array([scan == "length" for scan in lock_in.scan])
    length, base, settled = 1e3 * lock_in.length[rows], lock_in.base[rows] / 1e3, lock_in.settled[rows] > 0
    with drawing(height=4.7, top=1.25) as figure:
        axes = figure.add_subplot()
        grown = np.abs(lock_in.root[rows].imag) / (2e3 * np.pi)
        axes.plot(length, np.where(lock_in.root[rows].real > 0, grown, np.nan), ".", color=FAINT, ms=4,
                  label="fastest growing mode")
        for kind, colour, marker in zip(_KINDS, COLOURS, MARKERS, strict=False):
            of_kind = np.array([k == kind for k in lock_in.kind])[rows]
            if of_kind.any():
                axes.plot(length[of_kind], base[of_kind], marker, color=colour, mfc="none", label=kind)
                steady = of_kind & settled
                axes.plot(length[steady], base[steady], marker, color=colour)
        for free_length, frequency, source in _PAPER:
            mark = "+" if source == "measured" else "x"
            axes.plot(1e3 * free_length, frequency / 1e3, mark, color="black", ms=9, mew=1.3, zorder=3)
        for mark, source in (("+", "paper, measured"), ("x", "paper, simulated")):
            axes.plot([], [], mark, color="black", ms=9, mew=1.3, label=source)
        axes.set(xlabel="free length of the pin / mm", ylabel="base frequency / kHz", ylim=(0, None))
        legend(axes, 2)
        return svg(figure)


def case_motion(lock_in, case):
    """Figures 11 to 15: the last milliseconds and the spectra of disc and pin; lines: the paper's numbers."""
    with drawing(height=4.9, top=0.62, right=0.2) as figure:
        above, below = figure.subplots(2, 1)
        for body, (name, colour, line) in enumerate((("disc", BLUE, "-"), ("pin", RED, "--"))):
            above.plot(1e3 * lock_in.trace_time, 1e3 * lock_in.trace[case, body], color=colour, ls=line, lw=1.0,
                       label=name)
            below.plot(lock_in.frequency / 1e3, lock_in.spectrum[case, body], color=colour, ls=line, lw=0.8)
        for free_length, frequency, source in _PAPER:
            if abs(free_length - lock_in.length[case]) < _SAME_LENGTH:
                below.axvline(frequency / 1e3, color="black", lw=0.9, ls="-" if source == "measured" else ":", zorder=0)
        above.set(xlabel="time / ms", ylabel="velocity / mm/s", xlim=1e3 * lock_in.trace_time[[0, -1]])
        below.set(xlabel="frequency / kHz", ylabel="level / dB", xlim=(0, lock_in.frequency[-1] / 1e3), ylim=(-90, 5))
        legend(above, 2)
        return svg(figure)


def _some(law):
    """Up to five pressures, spread over the range."""
    return np.unique(np.linspace(0, len(law.pressure) - 1, 5).astype(int))
