"""The first screen: does it squeal, where, how certain, what is tuned. Every number comes from a product."""

from dataclasses import dataclass

import numpy as np

from pipeline.views.chapters import convergence, limit_cycle, probability
from pipeline.views.chapters.bench import (
    diagnosis,
    line_evidence,
    measured_friction,
    modal_test,
    model_update,
    noise_events,
    orders,
    response_functions,
)
from pipeline.views.chapters.friction import outside_computed
from pipeline.views.chapters.models import countermeasures, matrix_modes, noise_matrix, sensitivities
from pipeline.views.chapters.models.rupture import headline as rupture_headline
from pipeline.views.chapters.pad_motion import extremes, open_balance, point, rate_in_words
from pipeline.views.chapters.unstable_modes import (
    below_squeal,
    distinct_unstable,
    explanation,
    signed,
    squealing,
    words,
)
from pipeline.views.chapters.vibration import origin
from pipeline.views.figures.agreement import judged
from pipeline.views.figures.number_format import number, percent, plural, quantity, span

TWO_PI = 2.0 * np.pi
NEAR = 0.02     # an unstable mode explains an event when their frequencies agree within 2 %


@dataclass(frozen=True)
class Verdict:
    """Headline, answers in plain words, and key figures as (name, value) pairs."""

    headline: str
    tone: str       # squeal, warning or quiet: the colour of the page's head
    answers: tuple
    facts: tuple


def verdict(products, tuned_settings, ahead=()):
    """Verdict over ``products`` (name -> product or None); ``tuned_settings`` are (name, value) pairs.

    ``ahead``: names of stages that are to come, while the chain runs: their parts say so.
    """
    if products.get("diagnosis") is not None or products.get("line_evidence") is not None:
        return _diagnosed(products.get("diagnosis"), products, tuned_settings)
    for name, told in (("friction_update", measured_friction), ("model_update", model_update),
                       ("matrix_modes", matrix_modes)):
        if products.get(name) is not None:
            answers = (*told.note(products[name]), ("Measured", _measured(products)),
                       ("Tuned", _tuned(products, tuned_settings)))
            return Verdict(*told.headline(products[name]), tuple(filter(lambda a: a[1], answers)),
                           tuple(_facts(products)))
    if products.get("noise_matrix") is not None:
        return _of_matrix(products["noise_matrix"], products, tuned_settings)
    headline, tone = _headline(products, ahead)
    answers = [("Measured", _measured(products), ""), ("Where", _where(products), "limit_cycle"),
               ("Why", _why(products), "complex_modes"),
               ("How likely", _likely(products), "probability"),
               ("What to change", _matters(products), "sensitivities"),
               ("What helps", _helps(products), "countermeasures"),
               ("How certain", _sure(products, ahead), "convergence"),
               ("Tuned", _tuned(products, tuned_settings), "")]
    told = ((question, "Being computed." if stage in ahead else text) for question, text, stage in answers)
    return Verdict(headline, tone, tuple(a for a in told if a[1]), tuple(_facts(products)))


def first_look(modes):
    """Verdict over ComplexModes of one operating point on coarse meshes, before all else; its basis is told beside."""
    squeals = squealing(modes)
    text = "steady sliding is stable"
    if len(squeals):
        frequency = quantity(modes.unstable_root[int(np.argmax(squeals))].imag / TWO_PI, "Hz", 3)
        text = f"squeal can start, most strongly at {frequency}" if squeals.any() else \
            f"no squeal, but groan or moan at {frequency}"
    return Verdict(f"First look, not converged: {text}", "warning", (("Why", _why({"complex_modes": modes})),),
                   (_modes(modes),))


def _of_matrix(product, products, tuned_settings):
    """Verdict of a noise matrix: how likely it squeals, in what, where, and whether the bench agrees."""
    answers = [("Schedule", noise_matrix.schedule(product)), ("Where", noise_matrix.where(product)),
               ("The bench", noise_matrix.bench(product)),
               ("How certain", noise_matrix.certain(product)), ("Tuned", _tuned(products, tuned_settings))]
    return Verdict(*noise_matrix.headline(product), tuple(a for a in answers if a[1]), tuple(_facts(products)))


def _diagnosed(product, products, tuned_settings):
    """Verdict of a case with recordings: what they show to be missing."""
    weighed = products.get("line_evidence")
    headline, tone = diagnosis.headline(product) if weighed is None else line_evidence.headline(weighed)
    answers = [] if product is None else list(diagnosis.note(product))
    if weighed is not None:     # of single frequencies, what to measure remains
        answers = [*line_evidence.note(weighed), *answers[-1:]]
    answers.append(("Tuned", _tuned(products, tuned_settings)))
    return Verdict(headline, tone, tuple(a for a in answers if a[1]), tuple(_facts(products)))


def published_squeal(comparison):
    """Squeal frequencies of the paper in Hz, from the rows of the comparison."""
    if comparison is None:
        return ()
    size = {"Hz": 1.0, "kHz": 1e3}
    rows = range(len(comparison.row))
    return tuple(sorted({comparison.published[r] * size[str(comparison.unit[r])] for r in rows
                         if comparison.section[r] == "squeal" and comparison.published_known[r]
                         and str(comparison.unit[r]) in size}))


def _headline(products, ahead):
    squeal, modes = products.get("squeal"), products.get("complex_modes")
    if products.get("rupture") is not None:
        return rupture_headline(products["rupture"]), "warning"
    if products.get("convergence") is not None or "convergence" in ahead:
        return _onset(modes, _doubt(products.get("convergence")), products.get("limit_cycle"))
    unstable = 0 if modes is None else len(distinct_unstable(modes, len(modes.unstable_root)))
    if squeal is not None and len(squeal.event_level):
        if len(squeal.pressure) == 1:
            return f"Squeal at {quantity(squeal.event_frequency[np.argmax(squeal.event_level)], 'Hz', 3)}", "squeal"
        where = len(np.unique(squeal.event_operating))
        return f"Squeal at {where} of {len(squeal.pressure)} operating points", "squeal"
    if unstable:
        start = "No peak exceeds the squeal threshold, but " if squeal is not None else ""
        text = f"{start}{plural(unstable, 'mode')} {'is' if unstable == 1 else 'are'} unstable"
        return text[0].upper() + text[1:], "warning"
    if products.get("modal_test") is not None and modes is None:
        return modal_test.headline(products["modal_test"])
    heard = products.get("noise_events")
    if heard is not None and modes is None and (told := noise_events.headline(heard)):
        return told
    if products.get("recording") is not None and squeal is None and modes is None:
        return f"{plural(len(products['recording'].runs), 'run')} from a bench, not yet compared with a model", "quiet"
    if squeal is None and modes is None:
        return "No verdict: this case ends before the stability analysis", "warning"
    if squeal is None and (cycle := _settled_cycle(products.get("transient"))):
        return f"Vibration at {quantity(cycle, 'Hz', 3)} although no mode is unstable", "warning"
    return "No squeal predicted", "quiet"


def _doubt(refined):
    """What a headline adds on convergence; None: it is to come."""
    if refined is None:
        return " (convergence: being computed)"
    if refined.converged.item():
        return ""
    if convergence.unjudged(refined):
        return f" (not shown to be converged: {convergence.unrefined(refined)})"
    return " (not converged)"


def _onset(modes, doubt, cycle):
    """Headline of a two-way analysis: whether the brake squeals or, without a simulation, whether squeal can start; and
    whether that is converged."""
    points, squeals = len(modes.operating_speed), squealing(modes)
    starts = len(np.unique(modes.unstable_operating[squeals]))
    if not starts and len(squeals):
        lower = quantity(modes.unstable_root[0].imag / TWO_PI, "Hz", 3)
        return f"No squeal, but groan or moan at {lower}{doubt}", "warning"
    if not starts:
        return f"Steady sliding is stable at all {points} operating points{doubt}", "quiet" if not doubt else "warning"
    strongest = quantity(modes.unstable_root[squeals][0].imag / TWO_PI, "Hz", 3)
    if cycle is not None and len(cycle.pressure):
        loudest = int(np.argmax(limit_cycle.total(cycle)[:, -1]))
        strongest = quantity(cycle.cycle_frequency[loudest], "Hz", 3)
        return f"Squeals at {starts} of {points} operating points, loudest at {strongest}{doubt}", \
               "squeal" if not doubt else "warning"
    return f"Squeal can start at {starts} of {points} operating points, most strongly at {strongest}{doubt}", \
           "squeal" if not doubt else "warning"


def _settled_cycle(transient):
    """Frequency in Hz of the strongest settled cycle; 0 without any."""
    if transient is None:
        return 0.0
    moves = np.where(transient.settled > 0, transient.cycle_amplitude, 0.0)
    return float(transient.cycle_frequency.flat[np.argmax(moves)]) if moves.any() else 0.0


def _where(products):
    squeal, cycle = products.get("squeal"), products.get("limit_cycle")
    if squeal is None and cycle is None and products.get("noise_events") is not None:
        turning = orders.largest(products.get("orders"))
        told = noise_events.conclusion(products["noise_events"])
        return told + (f" Orders of the shaft: {turning}." if turning else "")
    if squeal is None:
        return "" if cycle is None else limit_cycle.statement(cycle)
    operating, sensor = np.unravel_index(np.argmax(squeal.peak_level), squeal.peak_level.shape)
    return (f"Loudest at {point(squeal, operating)}: {number(squeal.peak_level[operating, sensor], 3)} dB"
            f" re {quantity(squeal.reference, 'm/s', 3)} at {quantity(squeal.peak_frequency[operating, sensor], 'Hz')},"
            f" sensor {squeal.sensor_name[sensor]}; threshold {number(squeal.threshold, 3)} dB."
            f"{_harmonics(squeal, squeal.peak_frequency[operating, sensor])}")


def _measured(products):
    """What is to be known of the measurement beside its modes."""
    given = products.get("response_functions")
    return "" if given is None else response_functions.remarks(given)


def _harmonics(squeal, peak):
    """The fundamental of the loudest peak, and the number of harmonics among the events."""
    above = squeal.event_order > 1
    if not above.any():
        return ""
    loudest = int(np.argmax(squeal.event_level))
    is_loudest = above[loudest] and abs(squeal.event_frequency[loudest] / peak - 1) <= NEAR
    sentence = f" It is the {origin(squeal, loudest)}." if is_loudest else ""
    harmonics = np.count_nonzero(above)
    if harmonics == len(above):
        return f"{sentence} Every event is a harmonic of a lower fundamental."
    return f"{sentence} Harmonics of a lower fundamental: {harmonics} of {plural(len(above), 'event')}."


def _why(products):
    modes, squeal = products.get("complex_modes"), products.get("squeal")
    if modes is None:
        return ""
    if not len(modes.unstable_root):
        forced = ": the response at the sensors is forced by the rotating friction patches"
        return f"No mode is unstable{forced if products.get('multibody') is not None else ''}."
    frequencies = modes.unstable_root.imag / TWO_PI
    strongest = (f"The most unstable mode, {quantity(frequencies[0], 'Hz')}, has a growth rate of"
                 f" {quantity(modes.unstable_root[0].real, '1/s', 3)}.")
    if squeal is None:
        return f"{strongest}{_fed(modes)}"
    peak = squeal.peak_frequency.flat[np.argmax(squeal.peak_level)]
    nearest = frequencies[np.argmin(np.abs(frequencies - peak))]
    apart = abs(nearest / peak - 1)
    if apart <= NEAR:
        return f"{strongest} The loudest peak coincides (within {percent(NEAR)}) with an unstable mode at" \
               f" {quantity(nearest, 'Hz')}."
    forced = ": it is forced by the pads, whose motion is computed on a rigid disc"
    return (f"{strongest} No unstable mode lies within {percent(NEAR)} of the loudest peak (nearest"
            f" {quantity(nearest, 'Hz')})"
            f"{forced if products.get('multibody') is not None else ''}.")


def _fed(modes):
    """What moves in the most unstable mode, and the largest part of its growth rate on either side."""
    share, growth = modes.unstable_share[0], modes.unstable_growth[0]
    moving = words(modes.body_name[np.argmax(share)])
    diameters = modes.unstable_diameters[0]
    shape = f" with {plural(int(diameters), 'nodal diameter')}" if diameters >= 0 else ""
    feeds, takes = np.argmax(growth), np.argmin(growth)
    return (f" {percent(share.max())} of its kinetic energy is in the {moving}{shape}. Of its growth rate,"
            f" {signed(growth[feeds])} 1/s come from {words(modes.growth_term[feeds])}, {signed(growth[takes])} 1/s"
            f" from {words(modes.growth_term[takes])}."
            + (f" {explanation(modes, 0)}" if 0 in modes.followed_mode else "")
            + (f" {low}" if (low := below_squeal(modes)) else ""))


def _matters(products):
    """What moves the mode that grows most, and what makes it stable."""
    product = products.get("sensitivities")
    return "" if product is None else sensitivities.statement(product)


def _likely(products):
    """Probability at the worst operating point, and what matters most; empty without draws."""
    product = products.get("probability")
    return "" if product is None else probability.statement(product)


def _helps(products):
    """The best countermeasure; empty without variants."""
    product = products.get("countermeasures")
    return "" if product is None else countermeasures.statement(product)


def _compared(products):
    """The comparison, None where there are no published facts."""
    comparison = products.get("comparison")
    return comparison if comparison is not None and len(comparison.row) else None


def _own_brake(products):
    """Whether this is a brake that no published study is about."""
    return products.get("comparison") is None and products.get("structure") is not None


def _sure(products, ahead):
    comparison, refined = _compared(products), products.get("convergence")
    converged = "" if refined is None else f"{convergence.statement(refined)} "
    for told in filter(None, (outside_computed(products), open_balance(products.get("multibody")))):
        converged += f"{told} "
    if _own_brake(products) or "comparison" in ahead:
        return converged.strip()
    if comparison is None:
        return f"{converged}There is no published result to compare with."
    within = judged(comparison, "within")
    tuned = sum(bool(comparison.tuned[row]) for row in within)
    return (f"{converged}Of {len(comparison.row)} published facts, {len(judged(comparison))} are testable with this"
            f" chain; {len(within)} are met within tolerance, {tuned or 'none'} of them because the model was tuned to"
            f" them. At most {len(within) - tuned} are independent evidence for the model.")


def _tuned(products, tuned_settings):
    comparison = _compared(products)
    rows = [] if comparison is None else list(dict.fromkeys(t for t in map(str, comparison.tuned) if t))
    settings = [f"{name} = {value}" for name, value in tuned_settings]
    shown = rows or settings[:6]
    more = f" ({plural(len(settings), 'setting')} marked tuned; all below)" if settings else ""
    if settings and comparison is not None and not rows:
        more += ". The comparison does not state on which facts, so some of the agreement is not evidence"
    if not shown:
        return "" if _own_brake(products) else "Nothing in this case is marked as tuned."
    text = "; ".join(shown)
    return f"{text[:1].upper()}{text[1:]}{more}." if rows else f"{text}{more}."


def _facts(products):
    for name, describe in (("friction_map", _friction), ("micro_friction", _contact), ("complex_modes", _modes),
                           ("multibody", _motion), ("squeal", _level)):
        if products.get(name) is not None:
            yield describe(products[name])


def _friction(product):
    error = f", ± {number(product.friction_std.max(), 2)}" if product.friction_std.any() else ""
    return "friction coefficient", f"{span(product.friction, '1', 2)}{error}"


def _contact(product):
    return "real contact area", f"{span(100 * product.real_area, '1', 2)} % of nominal"


def _modes(product):
    frequencies = product.unstable_root.imag / TWO_PI
    most = np.bincount(product.unstable_operating.astype(int), minlength=1).max() if len(frequencies) else 0
    shown = f": {span(frequencies, 'Hz')}" if len(frequencies) else ""
    return "unstable modes at one operating point", f"{'up to ' if most else ''}{most}{shown}"


def _motion(product):
    high = extremes(product)[1]
    return "pad growth rate, highest load", (f"{rate_in_words(product, high)} at"
                                             f" {quantity(product.oscillation_frequency[high], 'Hz', 3)}")


def _level(product):
    return "highest level", f"{number(product.peak_level.max(), 3)} dB (threshold {number(product.threshold, 3)})"
