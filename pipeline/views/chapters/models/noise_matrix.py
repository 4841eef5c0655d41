"""Chapter: how likely does the brake squeal in a schedule of stops, where, and does the bench agree?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.probability import accuracy, in_words
from pipeline.views.figures.models import noise_matrix as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity
from pipeline.views.figures.probability import nominal

#: the sign of a difference -> what it says
TOO = {1: "the model squeals too much", -1: "the model squeals too little"}
PREDICTED = "Share of the draws that are noisy at each line pressure and speed, in percent"
RECORDED = ("; below it recorded stops, noisy / all. Framed: they differ by more than chance; solid red, the model"
            " squeals too little there, dashed white, too much")


def chapter(product, look):
    """Chapter of the product NoiseMatrix."""
    return Chapter(
        "noise_matrix", "Noise matrix", _see(product), f"{headline(product)[0]}. {bench(product)}".strip(),
        (key_figure(product), Figure(pictures.bands(product), _bands_caption(product)),
         Figure(pictures.brakes(product), "Noisy applications of each drawn brake: which share of the brakes has at"
                " most so many. Dashed: the mean.")),
        tuple(t for t in (_differences(product), _modules(product), _scatter(product), _unmatched(product),
                          _origins(product)) if t.rows), tuple(filter(None, _notes(product))))


def headline(product):
    """(sentence, tone) of the first screen."""
    low, high = product.occurrence_interval
    share = float(product.occurrence)
    if share == 0:
        return "No squeal is predicted in this schedule", "quiet"
    return (f"{percent(share, 2)} ({percent(low, 2)} to {percent(high, 2)}) of the brake applications of this schedule"
            " are predicted to squeal", "squeal")


def where(product):
    """Where it is most likely: conditions and bands."""
    if not product.probability.any():
        return ""
    made = sorted(pictures.tiles(product), key=lambda tile: -tile.share)
    worst = f"{named(made[0].column, made[0].pressure)}, {percent(made[0].share, 2)} of the draws"
    strongest = [k for k in np.argsort(-product.band_occurrence)[:3] if product.band_occurrence[k] > 0]
    heard = ", ".join(f"{nominal(product.band[k]) / 1e3:g} kHz ({percent(product.band_occurrence[k], 2)})"
                      for k in strongest)
    never, ever = (float(np.mean(sign)) for sign in (product.brake_occurrence == 0, product.brake_occurrence > 0))
    return (f"Most likely in {worst}; most of it in the 1/3 octaves of {heard}. {percent(ever, 2)} of the drawn brakes"
            f" squeal at least once in the schedule, {percent(never, 2)} never.")


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


def differing(product):
    """[(name, noisy, stops, expected, family-wise p, sign)] of conditions and bands that differ, clearest first."""
    stops = int(product.condition_stops.sum())
    conditions = [(named(pictures.column(product, k), product.pressure[k], product.temperature[k]),
                   int(product.condition_noisy[k]), int(product.condition_stops[k]), product.condition_expected[k],
                   product.condition_p_value[k], int(product.condition_difference[k]))
                  for k in np.flatnonzero(product.condition_difference)]
    bands = [(f"1/3 octave of {nominal(product.band[k]) / 1e3:g} kHz", int(product.band_noisy[k]), stops,
              product.band_expected[k], product.band_p_value[k], int(product.band_difference[k]))
             for k in np.flatnonzero(product.band_difference)]
    return sorted(conditions + bands, key=lambda row: row[4])


def named(column, pressure, temperature=0.0):
    """A condition in words."""
    kind = "stops" if pictures.ARROW in column else "drags"
    turn = " in reverse" if column.startswith("R ") else ""
    warm = f", {temperature - 273.15:.3g} °C" if temperature else ""
    way = "from" if kind == "stops" else "at"
    speed = column.removeprefix("R ").replace(pictures.ARROW, " to ")
    return f"{kind} {way} {speed} km/h, {pressure / 1e5:.3g} bar{turn}{warm}"


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
    return (f" In {blind} of {plural(int(asked.sum()), 'condition')} it could not have: so few stops of one brake fit"
            " the scatter whatever they do.")


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
        return "Temperature acts by the softening of the friction map alone, not on materials."
    return "The temperatures of the schedule do not act: the model has no dependence on them."


def _bands_caption(product):
    if product.condition_stops.any():
        return ("Share of the recorded stops that are noisy in each 1/3 octave, predicted and recorded. Star: they"
                " differ by more than chance.")
    return "Share of the applications of the schedule that are noisy in each 1/3 octave."


def _differences(product):
    rows = [(name, f"{heard} / {stops}", number(expected, 3), number(p, 2), TOO[sign])
            for name, heard, stops, expected, p, sign in differing(product)]
    return Table(("condition or band", "recorded noisy / all", "predicted noisy", "family-wise p", "verdict"),
                 tuple(rows), "Where the bench and the model differ by more than chance", (1, 2, 3), (4,))


def _modules(product):
    rows = [(str(name), str(int(uses.sum())), percent(share, 3), f"{percent(low, 2)} to {percent(high, 2)}")
            for name, uses, share, (low, high) in zip(product.module, product.applications, product.module_occurrence,
                                                      product.module_interval, strict=True)]
    return Table(("module", "applications", "predicted noisy", "95 % interval"), tuple(rows), "Occurrence by module",
                 (1, 2, 3))


def _scatter(product):
    rows = [(in_words(name), str(law), "stop to stop" if varies else "brake to brake")
            for name, law, varies in zip(product.source, product.source_law, product.source_varies, strict=True)]
    return Table(("source", "scatter", "from"), tuple(rows), "What scatters", wide=(1,), folded=True)


def _unmatched(product):
    rows = [(str(product.run[k]), "yes" if product.run_noisy[k] else "no", str(product.run_reason[k]))
            for k in np.flatnonzero(product.run_condition < 0)]
    return Table(("run", "squeal", "reason"), tuple(rows), "Recorded stops that are no condition of the schedule", (),
                 (2,), folded=len(rows) > 8)


def _origins(product):
    rows = [tuple(map(str, row)) for row in zip(product.origin_module, product.origin_setting, product.origin_value,
                                                product.origin, product.origin_source, strict=True)]
    return Table(("module", "setting", "value", "origin", "source"), tuple(rows),
                 "Where the values of the schedule come from", (), (2, 4), folded=True)


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
