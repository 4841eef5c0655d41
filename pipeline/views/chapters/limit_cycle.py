"""Chapter: what unstable modes grow into."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.vibration import surface_sounds
from pipeline.views.figures.models import limit_cycle as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

TWO_PI = 2.0 * np.pi
#: check -> what was done
WORDS = {"step": "half the time step", "patches": "twice the contact patches", "stick speed": "half the stick speed",
         "modes": "more modes"}


def chapter(cycle, look):
    """Chapter of the product LimitCycle."""
    if not len(cycle.pressure):
        return Chapter("limit_cycle", "From onset to limit cycle", "No operating point has an unstable mode.",
                       "Every small motion decays.")
    figures = (Figure(pictures.levels(cycle), "Velocity level over time, mean over the sensors; up to six operating"
                      " points, loudest first."), key_figure(cycle))
    return Chapter(
        "limit_cycle", "From onset to limit cycle",
        f"{plural(len(cycle.pressure), 'operating point')} with unstable modes; all bodies are flexible in the loop:"
        f" {plural(int(cycle.modes), 'mode')}, {int(cycle.patches)} contact patches, steps of"
        f" {quantity(float(cycle.step), 's', 3)}. The energy balance closes within {percent(cycle.imbalance.max(), 2)};"
        f" {percent(cycle.added_loss.max(), 2)} of the energy lost goes to the damping added above the frequencies of"
        " interest.",
        statement(cycle), figures, (_cycles(cycle), _onsets(cycle)),
        sounds=surface_sounds(cycle.listen, "The loudest limit cycle"))


def key_figure(cycle):
    """Spectrum of the loudest limit cycle; None where every motion decays."""
    if not len(cycle.pressure):
        return None
    loudest = int(np.argmax(total(cycle)[:, -1]))
    return Figure(pictures.spectrum(cycle, loudest), f"Spectrum of the limit cycle at {point(cycle, loudest)}, loudest"
                  " sensor, last two windows; dotted: multiples of the strongest line.")


def total(cycle):
    """(operating, window) m/s: root mean square over the sensors."""
    return np.sqrt((cycle.level**2).mean(axis=1))


def point(cycle, operating):
    """Words for one operating point."""
    return f"{quantity(cycle.pressure[operating], 'Pa', 3)} and {quantity(cycle.speed[operating], 'rad/s')}"


def agreement(cycle):
    """Largest difference of a growth rate between small simulated motion and complex modes: (1/s, share of it)."""
    error = abs(cycle.onset_simulated.real - cycle.onset_root.real)
    return float(error.max(initial=0.0)), float((error / cycle.onset_root.real).max(initial=0.0))


def statement(cycle):
    """Sentences: level and frequency, what stops the growth, agreement with complex modes, how far it holds."""
    if not len(cycle.pressure):
        return "Every small motion decays."
    last = total(cycle)[:, -1]
    loudest = int(np.argmax(last))
    error, share = agreement(cycle)
    unsettled = int((cycle.settled == 0).sum())
    holds = "".join(f" With {WORDS[str(name)]} the level changes by {number(level, 2)} dB, the strongest line by"
                    f" {percent(abs(frequency), 2)}." for name, level, frequency in
                    zip(cycle.check, cycle.check_level, cycle.check_frequency, strict=True))
    state = ("Every motion settles at its level." if not unsettled else
             f"{unsettled} of {len(last)} motions {'has' if unsettled == 1 else 'have'} NOT settled: the level still"
             f" changes by more than {number(float(cycle.settled_within), 2)} dB over the last two windows.")
    simulated = "Simulated:" if len(last) == 1 else f"Of {len(last)} simulated operating points, the loudest is"
    return (f"{simulated} {point(cycle, loudest)}, where the sensors move with"
            f" {quantity(last[loudest], 'm/s', 3)} ({number(pictures.decibel(last[loudest]), 4)} dB re 1 nm/s), most"
            f" strongly at {quantity(cycle.cycle_frequency[loudest], 'Hz', 4)};"
            f" {percent(cycle.stick_share[loudest, -1], 2)} of the contact patches stick and"
            f" {percent(cycle.open_share[loudest, -1], 2)} of the contacts are open, on average. {state} Small motion"
            f" grows as the complex modes say, within {quantity(error, '1/s', 2)} ({percent(share, 2)}).{holds}")


def _cycles(cycle):
    last = total(cycle)[:, -1]
    rows = [(quantity(p, "Pa", 3), quantity(w, "rad/s"), number(pictures.decibel(last[k]), 4),
             quantity(cycle.cycle_frequency[k], "Hz", 4), percent(cycle.open_share[k, -1], 2),
             percent(cycle.stick_share[k, -1], 2), "yes" if cycle.settled[k] else "no")
            for k, (p, w) in enumerate(zip(cycle.pressure, cycle.speed, strict=True))]
    head = ("pressure", "speed", "level / dB", "strongest line", "open", "sticking", "settled")
    return Table(head, tuple(rows), "Limit cycles: level re 1 nm/s, mean over the sensors, in the last window",
                 tuple(range(2, 6)))


def _onsets(cycle):
    rows = [(point(cycle, int(k)), quantity(root.imag / TWO_PI, "Hz", 5), number(root.real, 4), number(seen.real, 4),
             percent(seen.imag / root.imag - 1, 2))
            for k, root, seen in zip(cycle.onset_operating, cycle.onset_root, cycle.onset_simulated, strict=True)]
    head = ("operating point", "frequency", "growth rate, complex modes / 1/s", "simulated / 1/s", "frequency")
    return Table(head, tuple(rows), "Onset: growth of the small motion beside the complex modes", tuple(range(1, 5)),
                 folded=True)
