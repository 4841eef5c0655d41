"""Chapters: vibration at the sensors, and squeal."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Sound, Table
from pipeline.views.chapters.pad_motion import extremes, point
from pipeline.views.figures import vibration as pictures
from pipeline.views.figures.number_format import THIN, number, ordinal, plural, quantity, span
from pipeline.views.pages.sound_file import wav

#: what the forces act on, by the coupling of the stage response
_ENTERED = {"disc": "disc alone", "released": "brake with open contacts", "assembly": "brake with closed contacts"}


def response(product, published, look):
    """Chapter of the product Response."""
    points = list(dict.fromkeys(extremes(product)))
    lines = tuple(f for f in published if f < pictures.highest_frequency(product))
    figures = tuple(Figure(pictures.spectra(product, points, sensor, lines, look.dpi),
                           f"Velocity spectrum at sensor {name}." + _dotted(lines))
                    for sensor, name in enumerate(product.sensor_name[:2]))
    superposed = span(np.bincount(product.mode_operating, minlength=len(product.pressure)), "1")
    effective = product.velocity.astype(float).std(axis=2)
    return Chapter(
        "response", "Vibration at the sensors",
        f"At each operating point the contact forces excite {superposed} modes up to"
        f" {quantity(product.mode_frequency.max(), 'Hz')} (superposed exactly); forces enter the"
        f" {_ENTERED[str(product.coupling)]}."
        f" Spectra at lowest and highest load, resolution"
        f" {quantity(product.frequency[1] - product.frequency[0], 'Hz', 3)}.",
        f"RMS velocities are {span(effective, 'm/s')}. A narrow peak that rises above the forced"
        " response is a squeal candidate; many peaks of equal height only reflect the modal density of the brake.",
        figures)


def squeal(product, published, look):
    """Chapter of the product Squeal."""
    points = list(dict.fromkeys(extremes(product)))
    loudest = int(np.argmax(product.peak_level.max(axis=0)))
    figures = (
        Figure(pictures.level_frequency(product, published),
               f"Level over frequency of {plural(len(product.event_level), 'event')}"
               + (f", {span(product.event_frequency, 'Hz')}, {span(product.event_level, '1')} dB"
                  if len(product.event_level) else "")
               + ("; hollow: harmonics of a lower fundamental" if (product.event_order > 1).any() else "")
               + "; grey dots: highest peak of each sensor; dashed: threshold."
               + _dotted(published)),
        Figure(pictures.band_levels(product, points, loudest),
               f"Third-octave levels at sensor {product.sensor_name[loudest]}, lowest and highest load."))
    return Chapter(
        "squeal", "Squeal",
        f"The detector calls a spectral peak above {number(product.threshold, 3)} dB (velocity, re"
        f" {quantity(product.reference, 'm/s', 3)}) in the squeal band an event, sensor by sensor."
        " An event at a whole multiple of a lower fundamental, inside the band or below it, is reported as its"
        " harmonic, not as a separate squeal frequency. Figure 1 shows where it squeals.",
        _conclusion(product), figures, _table(product), sounds=_sounds(product))


def _sounds(product):
    if not product.listen:
        return ()
    level = (f", the velocity level {number(product.event_level.max(), 3)} dB re"
             f" {quantity(product.reference, 'm/s', 3)}")
    return surface_sounds(product.listen, "The loudest squeal as predicted", level)


def surface_sounds(listen, what, level=""):
    """Sounds of {name: Excerpt} of a surface that moves, with ``what`` they are and the ``level`` in words."""
    return tuple(Sound(wav(one), f"{what} (squeal.wav): {one.content}. It is how the surface moves, not the sound at an"
                       " ear: radiation, room and hearing are not in it. The volume is made for listening: full scale"
                       f" is {quantity(one.full_scale, 'm/s', 3)}{level}.") for one in listen.values())


def occurrence_caption(product):
    """Where the loudest peak lies and how it compares with the threshold."""
    harmonics = (product.event_order > 1).any()
    among = " (in parentheses: harmonics of a lower fundamental)" if harmonics else ""
    return ("Highest velocity level in the squeal band at each operating point, its frequency and number of events"
            f"{among}."
            f" Framed: squeal. Highest level {number(product.peak_level.max(), 3)} dB; line in the colour bar:"
            f" threshold, {number(product.threshold, 3)} dB re {quantity(product.reference, 'm/s', 3)}.")


def origin(product, event):
    """'2nd harmonic of 0.81 kHz', or 'fundamental'."""
    order = int(product.event_order[event])
    if order == 1:
        return "fundamental"
    return f"{ordinal(order)} harmonic of {number(product.event_fundamental[event] / 1e3, 2)}{THIN}kHz"


def _conclusion(product):
    where = np.unique(product.event_operating)
    if not len(where):
        short = float(product.threshold) - product.peak_level.max()
        return f"No event: the loudest peak is {number(short, 2)} dB below the threshold."
    return (f"{plural(len(product.event_level), 'event')} at {len(where)} of {len(product.pressure)} operating points:"
            f" {'; '.join(point(product, o) for o in where)}.{_harmonics(product)}")


def _harmonics(product):
    """How many events are harmonics, and of what."""
    above = product.event_order > 1
    if not above.any():
        return " None is a harmonic of a lower fundamental."
    of = f"of a lower fundamental ({span(product.event_fundamental[above] / 1e3, '1', 2)}{THIN}kHz)"
    return f" {plural(np.count_nonzero(above), 'harmonic')} {of}, {plural(np.count_nonzero(~above), 'fundamental')}."


def _table(product, most=15):
    order = np.argsort(-product.event_level, kind="stable")[:most]
    if not len(order):
        return ()
    rows = tuple((point(product, product.event_operating[e]), str(product.sensor_name[product.event_sensor[e]]),
                  quantity(product.event_frequency[e], "Hz"), origin(product, e), number(product.event_level[e], 3),
                  quantity(product.event_start[e], "s", 3), quantity(product.event_duration[e], "s", 3)) for e in order)
    title = f"Loudest {len(rows)} of {plural(len(product.event_level), 'event')}"
    return (Table(("operating point", "sensor", "frequency", "origin", "level / dB", "start", "duration"), rows, title,
                  (2, 4, 5, 6), folded=True),)


def _dotted(published):
    return f" Dotted: squeal in the paper, {quantity(published, 'Hz')}." if len(published) else ""
