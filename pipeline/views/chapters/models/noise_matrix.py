"""Chapter: how likely does the brake squeal in a schedule of stops, where, and does the bench agree?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure
from pipeline.views.chapters.models.noise_matrix_tables import TOO, differing, named, tables
from pipeline.views.chapters.probability import accuracy
from pipeline.views.figures.models import noise_matrix as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity
from pipeline.views.figures.probability import nominal

PREDICTED = "Share of the draws that are noisy at each line pressure and speed, in percent"
RECORDED = ("; below it recorded stops, noisy / all. Framed: they differ by more than chance; solid red, the model"
            " squeals too little there, dashed white, too much")


def chapter(product, look):
    """Chapter of the product NoiseMatrix."""
    return Chapter(
        "noise_matrix", "Noise matrix", _see(product), f"{headline(product)[0]}. {bench(product)}".strip(),
        (key_figure(product), Figure(pictures.bands(product), _bands_caption(product)),
         Figure(pictures.brakes(product), "Noisy applications of each drawn brake, by its drawn stops: which share of"
                " the brakes has at most so many. Dashed: the mean.")),
        tables(product), tuple(filter(None, _notes(product))))


def headline(product):
    """(sentence, tone) of the first screen."""
    low, high = product.occurrence_interval
    share = float(product.occurrence)
    if share == 0:
        return "No squeal is predicted in this schedule", "quiet"
    return (f"{percent(share, 2)} ({percent(low, 2)} to {percent(high, 2)}) of the brake applications of this schedule"
            " are predicted to squeal", "squeal")


def schedule(product):
    """What the schedule is, and how much of a published one."""
    public = int(product.published_applications)
    missing = " Its values are not those of the standard, which were not available." if str(
        product.not_available) else ""
    of = f", of {public} published ones" if public else ""
    return f"One {product.title}: {int(product.applications.sum())} brake applications{of}.{missing}"


def where(product):
    """Where it is most likely: conditions and bands."""
    if not product.probability.any():
        return ""
    made = sorted(pictures.tiles(product), key=lambda tile: -tile.share)
    worst = f"{named(made[0].column, made[0].pressure)}, {percent(made[0].share, 2)} of the draws"
    strongest = [k for k in np.argsort(-product.band_occurrence)[:3] if product.band_occurrence[k] > 0]
    heard = ", ".join(f"{nominal(product.band[k]) / 1e3:g} kHz ({percent(product.band_occurrence[k], 2)})"
                      for k in strongest)
    ever, repeats = float(np.mean(product.brake_occurrence > 0)), plural(int(product.repeats), "drawn stop")
    return (f"Most likely in {worst}; most of it in the 1/3 octaves of {heard}. {percent(ever, 2)} of the drawn brakes"
            f" are noisy under some condition in their {repeats} of each.")


def bench(product):
    """Whether recorded stops agree, in sentences."""
    stops, runs = int(product.condition_stops.sum()), len(product.run)
    if not runs:
        return "No stops were recorded: nothing says whether a bench agrees."
    if not stops:
        return f"None of {plural(runs, 'recorded stop')} is near a condition of the schedule."
    noisy = int(product.condition_noisy.sum())
    first = (f"The bench squealed in {noisy} of {plural(stops, 'recorded stop')}, where"
             f" {number(product.all_expected, 3)} noisy ones are predicted ({_judged(product, 'all')}).")
    apart = differing(product)
    if not apart:
        blind = _blind(product)
        return f"{first} No pressure, speed or band differs by more than chance.{blind}"
    listed = "; ".join(f"{name} ({heard} of {of} noisy, {number(expected, 2)} predicted): {TOO[sign]}"
                       for name, heard, of, expected, _, sign in apart[:4])
    more = f"; {len(apart) - 4} more in the table" if len(apart) > 4 else ""
    return f"{first} Beyond chance: {listed}{more}."


def key_figure(product):
    """Figure of the first screen."""
    recorded = RECORDED if product.condition_stops.any() else ""
    return Figure(pictures.matrix(product), f"{PREDICTED}{recorded}.")


def certain(product):
    """How far the draws are to be trusted, in sentences."""
    beyond = int(product.outside.sum())
    outside = (f" {beyond} of {len(product.outside)} conditions lie, at least in part, beyond the pressures or speeds"
               " at which friction was computed, where the map is constant." if beyond else "")
    return f"{accuracy(product)} {_refined(product)}{outside}"


def _judged(product, name):
    p_value = float(getattr(product, f"{name}_p_value"))
    sign = int(getattr(product, f"{name}_difference"))
    return f"{TOO[sign]}, p {number(p_value, 2)}" if sign else f"no difference beyond chance, p {number(p_value, 2)}"


def _blind(product):
    """Sentence on conditions whose stops could not have differed whatever the bench did; empty where there are none."""
    asked = product.condition_stops > 0
    blind = int(np.sum(asked & (product.condition_least_p > product.level)))
    if not blind:
        return ""
    return (f" In {blind} of {plural(int(asked.sum()), 'condition')} it could not have: so few stops of one brake, or"
            " so few draws, leave room for any result.")


def _see(product):
    count, uses = len(product.kind), int(product.applications.sum())
    public, sections = int(product.published_applications), int(product.published_sections)
    known = (f" The published procedure has {sections} sections and {public} applications ({product.published_source})."
             if public else "")
    missing = f" Not available: {str(product.not_available)}" if str(product.not_available) else ""
    low, high = product.limits
    drawn, repeats = len(product.value) // int(product.repeats), int(product.repeats)
    return (f"A schedule {product.title}: {plural(len(product.module), 'module')}, {uses} brake applications,"
            f" {count} different conditions.{known}{missing} {plural(drawn, 'brake')} of {plural(repeats, 'stop')} each"
            f" were drawn; an application is noisy if a mode from {quantity(low, 'Hz', 3)} to {quantity(high, 'Hz', 3)}"
            f" is unstable. {_temperature(product)} How loud it gets is not predicted: an unstable mode may stay"
            " below 70 dB(A), or need more time to grow than a stop takes.")


def _temperature(product):
    if product.temperature.any():
        return "The temperatures of the schedule act by the softening of the friction map alone, not on materials."
    return ("The temperatures of the schedule do not act: the model does not depend on them, as friction does where"
            " friction_map.bulk_temperatures are stated.")


def _bands_caption(product):
    if product.condition_stops.any():
        return ("Share of the recorded stops that are noisy in each 1/3 octave, predicted and recorded. Star: they"
                " differ by more than chance.")
    return "Share of the applications of the schedule that are noisy in each 1/3 octave."


def _notes(product):
    yield certain(product)
    if product.condition_stops.any():
        yield (f"Recorded stops are taken to be those of one brake. {int(product.tests)} tests (conditions, bands, all"
               f" together) at a family-wise level of {percent(float(product.level))}, Holm; beta-binomial, so that"
               " stops of one brake count as alike as they are predicted to be. The test knows the declared scatter,"
               " no error of the model.")


def _refined(product):
    stops = int(product.refined_stops)
    if not stops:
        return ""
    return (f"At twice as many speeds along a stop, {int(product.refined_changed)} of {plural(stops, 'drawn stop')}"
            " would be judged otherwise.")
