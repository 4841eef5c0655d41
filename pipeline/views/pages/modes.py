"""Modes of a run for the terminal: growth rate, damping ratio, what other programs print, and what they grow into."""

import numpy as np

from pipeline.views.chapters.models import matrix_modes, sensitivities
from pipeline.views.chapters.unstable_modes import critical_friction, distinct_unstable, explanation, words
from pipeline.views.figures.number_format import number, percent, quantity

TWO_PI = 2.0 * np.pi
HEAD = ("frequency", "growth / 1/s", "damping ratio / %", "-2 Re/|Im| / %", "60 dB in", "from friction", "at")
#: what the columns are, and who prints which
CONVENTIONS = ("Growth: Re s of the eigenvalue s. Damping ratio: -Re s/|s|; Abaqus, Nastran and OptiStruct print"
               " -2 Re s/|Im s|. A mode grows where Re s > 0 and both ratios are negative. 60 dB in: time in which its"
               " velocity grows a thousandfold.")
_UNSTABLE = "unstable modes, each frequency once, where it grows most"
_STABLE = "no mode is unstable; the least stable ones"
#: least stable modes that are shown where none is unstable
_LEAST_STABLE = 3
#: modes nearer than this share of their frequency are one
_ALIKE = 0.005
#: modes whose reasons are told
_EXPLAINED = 4
#: parts of a growth rate that are told, and the share of the largest below which they are not
_PARTS, _SMALL = 5, 1e-3
_RISE = np.log(1e3)


def of_case(modes):
    """(title, rows, sentences) of ComplexModes: the unstable modes, each frequency once, else the least stable ones."""
    chosen = distinct_unstable(modes, len(modes.unstable_root))
    if not chosen:
        return _STABLE, _least_stable(modes), []
    rows = []
    for k in chosen:
        critical = critical_friction(modes, k)
        onset = "—" if critical is None else number(critical, 3)
        rows.append(_row(modes.unstable_root[k], onset, _point(modes, modes.unstable_operating[k])))
    told = [f"{quantity(modes.unstable_root[k].imag / TWO_PI, 'Hz')}: {explanation(modes, k)} {_parts(modes, k)}"
            for k in chosen[:_EXPLAINED] if k in modes.followed_mode]
    return _UNSTABLE, rows, told


def of_matrices(modes):
    """The same of MatrixModes."""
    found = modes.roots
    grows = len(found.unstable_root) > 0
    root, point = (found.unstable_root, found.unstable_operating) if grows else (found.root, found.root_operating)
    order = np.argsort(-root.real, kind="stable")
    rows = [_row(root[k], "—", f"{quantity(found.speed[point[k]], 'rad/s', 3)}, friction ×"
                 f" {number(float(modes.friction), 3)}") for k in order[_distinct(root[order])]]
    if not grows:
        return _STABLE, rows[:_LEAST_STABLE], []
    return _UNSTABLE, rows, [dict(matrix_modes.note(modes))["What matters"]]


def matters(derived):
    """Sentences on what moves the mode that grows most, of Sensitivities; [] of None."""
    return [] if derived is None else list(filter(None, [sensitivities.statement(derived)]))


def cycles(motion, unstable):
    """Sentences on what a Transient or a LimitCycle, None without one, settles to at each operating point, beside the
    ``unstable`` (g,) frequencies [Hz]."""
    if motion is None:
        return []
    told = []
    for k, (pressure, speed) in enumerate(zip(motion.pressure, motion.speed, strict=True)):
        sensor = int(np.argmax(motion.cycle_amplitude[k])) if hasattr(motion, "cycle_amplitude") else ...
        frequency, settled = np.asarray(motion.cycle_frequency[k])[sensor], np.asarray(motion.settled[k])[sensor]
        what = f"a cycle at {quantity(frequency, 'Hz')}{_beside(frequency, unstable)}" if settled and frequency else \
            "no cycle"
        told.append(f"Motion over time at {quantity(pressure, 'Pa', 3)}, {quantity(speed, 'rad/s')}: it settles to"
                    f" {what}.")
    return told


def beside(named, heard, near):
    """Sentences on ``heard`` frequencies [Hz] beside NamedModes: the nearest ones, and how often a tone would be near
    one by chance, as dense as modes lie in the octave about it."""
    unstable = named.frequency[named.unstable == 1]
    told, chances = [], []
    for frequency in heard:
        octave = frequency * np.array([2.0**-0.5, 2.0**0.5])
        every, growing = (named.covered(octave, near, which) for which in (False, True))
        chances.append(growing)
        told.append(f"Heard at {quantity(frequency, 'Hz')}{_nearest(frequency, named.frequency, unstable)}. By chance a"
                    f" tone lies within {percent(near, 2)} of a mode in {percent(every, 2)} of cases, of an unstable"
                    f" one in {percent(growing, 2)}.")
    if len(heard) > 1:
        met = sum(bool(len(unstable)) and bool(abs(f / unstable - 1).min() <= near) for f in heard)
        told.append(f"Of {len(heard)} frequencies {met} lie within {percent(near, 2)} of an unstable mode; by chance as"
                    f" many or more would in {percent(_at_least(met, chances), 2)} of cases.")
    return told


def _nearest(frequency, modes, unstable):
    """The nearest of the ``modes`` [Hz], and of the ``unstable`` ones among them."""
    first, second = _beside(frequency, modes, "the nearest mode"), _beside(frequency, unstable)
    same = second and first.partition(" at ")[2] == second.partition(" at ")[2]
    return first + (", which is unstable" if same else second)


def _at_least(count, chances):
    """Probability that of independent events with these ``chances`` at least ``count`` happen."""
    number_of = np.ones(1)
    for chance in chances:
        number_of = np.convolve(number_of, (1 - chance, chance))
    return float(number_of[count:].sum())


def _beside(frequency, modes, what="the unstable mode"):
    """', 6.1 % below the unstable mode at 553.7 Hz': the nearest one of ``modes`` (n,) [Hz]; '' without any."""
    if not len(modes):
        return ""
    nearest = modes[np.argmin(abs(np.log(modes / frequency)))]
    away = frequency / nearest - 1
    return f", {percent(abs(away), 2)} {'above' if away > 0 else 'below'} {what} at {quantity(nearest, 'Hz')}"


def _parts(modes, index):
    """Sentence: the largest parts of a growth rate, with their signs."""
    growth = modes.unstable_growth[index]
    order = [k for k in np.argsort(-abs(growth), kind="stable")[:_PARTS] if abs(growth[k]) > _SMALL * abs(growth).max()]
    parts = (f"{words(modes.growth_term[k])} {'+' if growth[k] > 0 else ''}{number(growth[k], 3)}" for k in order)
    return f"Largest parts of the growth rate in 1/s: {', '.join(parts)}."


def _least_stable(modes):
    point, branch = np.nonzero(modes.operating_root.imag > 0)
    roots = modes.operating_root[point, branch]
    order = np.argsort(-roots.real, kind="stable")
    return [_row(roots[k], "—", _point(modes, point[k])) for k in order[_distinct(roots[order])][:_LEAST_STABLE]]


def _distinct(roots):
    """Indices of ``roots`` whose frequency none before them has."""
    kept = []
    for k, root in enumerate(roots):
        if all(abs(root.imag / roots[other].imag - 1) > _ALIKE for other in kept):
            kept.append(k)
    return np.array(kept, int)


def _point(modes, point):
    return (f"{quantity(modes.operating_pressure[point], 'Pa', 3)}, {quantity(modes.operating_speed[point], 'rad/s')},"
            f" friction {number(modes.operating_friction[point], 3)}")


def _row(root, onset, where):
    rise = quantity(_RISE / root.real, "s", 3) if root.real > 0 else "never"
    return (quantity(root.imag / TWO_PI, "Hz", 5), number(root.real, 4), number(-100 * root.real / abs(root), 4),
            number(-200 * root.real / abs(root.imag), 4), rise, onset, where)
