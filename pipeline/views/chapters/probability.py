"""Chapter: how likely is an unstable mode over the scatter of the brake, and what decides?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures import probability as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

#: what scatters -> how it is called
WORDS = {"joint_stiffness": "stiffness of joints", "joint_loss": "loss factors of joints",
         "body_loss": "loss factors of bodies", "lining_stiffness": "stiffness of the linings",
         "contact_stiffness": "stiffness of the contact", "damping_speed": "damping speed of the contact",
         "friction": "friction", "friction_over_pressure": "slope of friction over pressure",
         "friction_over_speed": "slope of friction over speed"}


def chapter(probability, look):
    """Chapter of the product Probability."""
    if not len(probability.value):
        return Chapter("probability", "How likely", "No draws were made of the scatter.", "No probability.")
    return Chapter(
        "probability", "How likely",
        f"{len(probability.value)} draws of {plural(len(probability.source), 'source')} of scatter, each source"
        f" independent of the others. {ended(probability)} A draw squeals at an operating point if a mode from"
        f" {quantity(float(probability.squeal_from), 'Hz')} on grows there by more than"
        f" {quantity(float(probability.least_growth), '1/s')}. The draws fill the scatter evenly (scrambled Sobol"
        " sequence), so that what goes linearly with the sources,"
        f" {percent(float(probability.explained), 2)} of the variance of what squeals, is not left to chance; the"
        " intervals (95 %, Wilson) are of the rest. They speak of the number of draws, not of the scatter that was"
        " assumed.",
        statement(probability), _figures(probability), (_sources(probability), _bands(probability)),
        (accuracy(probability), solved(probability)))


def statement(probability):
    """Probability at the worst operating point, at any, and what matters most beyond its error; empty without draws."""
    if not len(probability.value):
        return ""
    worst = int(np.argmax(probability.probability))
    share = _with_interval(probability.probability[worst], probability.interval[worst])
    first = (f"Over the stated scatter, {share} of the draws squeal at"
             f" {quantity(probability.pressure[worst], 'Pa', 3)} and"
             f" {quantity(probability.speed[worst], 'rad/s')}, the worst operating point;"
             f" {_with_interval(probability.overall, probability.overall_interval)} at any.")
    order = np.argsort(-probability.sensitivity)[:2]
    matters = [f"{in_words(probability.source[k])} ({percent(probability.sensitivity[k], 2)} of the variance of the"
               f" growth rate, more of it {_sign(probability.trend[k])})"
               for k in order if probability.sensitivity[k] > 2 * probability.sensitivity_error[k]]
    if not matters:
        return f"{first} No source stands out from the error that so many draws leave."
    return f"{first} What matters most: {', then '.join(matters)}."


def ended(probability):
    """Why no more draws were made, in one sentence."""
    made, most, within = len(probability.value), int(probability.most_draws), float(probability.within)
    reached = np.diff(probability.overall_interval)[0]
    if made < most:
        return (f"Of at most {most} no more were made, as the interval of the probability at any operating point is no"
                f" wider than {percent(2 * within)}; to end by its width makes its 95 % slightly optimistic, by less"
                " than a point for probabilities of .05 to .95 and 100 draws or more.")
    if within and reached > 2 * within:
        return (f"All that were allowed were made, and the interval of the probability at any operating point is still"
                f" {percent(reached)} wide, more than {percent(2 * within)}: allow more (probability.draws).")
    return "All that were allowed were made."


def solved(probability):
    """How the roots of the draws were found, in one sentence."""
    points, whole = probability.growth.size, int(probability.whole_spectra)
    residual = probability.root_residual.max(initial=0.0)
    text = (f"{plural(len(probability.root), 'unstable root')} of {plural(points, 'combination')} of draw"
            f" and operating point, each with a residual of at most {quantity(residual, '1/s', 2)} on the common bases;"
            f" {whole} of these combinations were solved for all their roots, as a few did not serve.")
    if int(probability.checked_draws):
        text += (f" Of {plural(int(probability.checked_draws), 'checked draw')}, {int(probability.spectrum_differ)} had"
                 " other growing roots among all of them.")
    return text


def in_words(source):
    """A source in plain words."""
    kind, _, part = str(source).partition(":")
    return f"{WORDS[kind]} ({part.replace('_', ' ')})" if part else WORDS[kind]


def accuracy(probability):
    """How far the common bases are from the whole reduced model, in one sentence."""
    draws, roots = int(probability.checked_draws), probability.whole_root
    if not draws:
        return "No draw was solved in the whole reduced model: the error of the common bases is unknown."
    if not len(roots):
        return (f"{plural(draws, 'draw')} solved in the whole reduced model as well: no unstable mode there, and"
                f" {int(probability.missed)} that only one of both has.")
    frequency = abs(probability.checked_root.imag / roots.imag - 1).max()
    growth = abs(probability.checked_root.real - roots.real).max()
    return (f"{plural(draws, 'draw')} solved in the whole reduced model as well, half of them the farthest from the"
            f" nominal brake, {plural(len(roots), 'unstable mode')}:"
            f" frequencies within {percent(frequency, 2)}, growth rates within {quantity(growth, '1/s', 2)};"
            f" {int(probability.missed)} with more than 10 1/s that only one of both has.")


def _with_interval(share, interval):
    return f"{percent(share)} ({percent(interval[0])} to {percent(interval[1])})"


def _sign(trend):
    return "less stable" if trend > 0 else "more stable"


def _figures(product):
    return (
        Figure(pictures.per_point(product), "Share of the draws that squeal at each operating point, with 95 %"
               " interval."),
        Figure(pictures.per_band(product), "Share of the draws with an unstable mode in each 1/3 octave at any"
               " operating point, with 95 % interval."),
        Figure(pictures.sensitivities(product, [in_words(s) for s in product.source]),
               "First-order sensitivity: share of the variance of the largest growth rate that goes with each source"
               " alone, with standard error. Red: more of it is less stable; blue: more stable."))


def _sources(product):
    order = np.argsort(-product.sensitivity)
    rows = [(in_words(product.source[k]), str(product.origin[k]), percent(product.sensitivity[k], 2),
             f"± {percent(product.sensitivity_error[k], 2)}", number(product.trend[k], 2)) for k in order]
    return Table(("source", "scatter", "sensitivity", "error", "rank correlation"), tuple(rows),
                 "What scatters, by its influence on the largest growth rate", (2, 3, 4), (1,))


def _bands(product):
    used = np.flatnonzero(product.band_any > 0)
    rows = [(f"{pictures.nominal(product.band[b]) / 1e3:g} kHz",
             _with_interval(product.band_any[b], product.band_interval[b]),
             percent(product.band_probability[b].max())) for b in used]
    return Table(("1/3 octave", "at any operating point", "at the worst"), tuple(rows),
                 "Share of the draws with an unstable mode, by 1/3 octave", (1, 2))
