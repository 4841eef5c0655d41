"""Chapter: squeal and other noise in the recordings."""

import numpy as np

from pipeline.views.chapters.bench.noise_modes import near_modes, nearest_mode
from pipeline.views.chapters.chapter import Chapter, Figure, Sound, Table, remarks_table
from pipeline.views.figures.bench import noise_events as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity
from pipeline.views.pages.sound_file import wav

#: spectrograms and rows that are shown
_SHOWN, _ROWS = 6, 60
#: overloaded records that are named
_OVERLOADED = 4
#: ratio of frequencies up to which two channels hear one tone
_ALIKE = 1.01
_PAIRS = (("pressure", "speed"), ("pressure", "temperature"), ("speed", "temperature"))


def chapter(product, look):
    """Chapter of the product NoiseEvents."""
    return Chapter("noise_events", "Squeal and other noise in the recordings", _searched(product), conclusion(product),
                   tuple(_figures(product, look)),
                   (*_tables(product), *remarks_table(product.remarks, "Channels that were not searched")),
                   sounds=_sounds(product))


def _sounds(product):
    return tuple(Sound(wav(one), f"The loudest squeal as recorded (squeal.wav): {one.content}, from"
                       f" {quantity(one.begin, 's', 3)} on. The volume is made for listening: full scale is"
                       f" {quantity(one.full_scale, str(one.unit), 3)}." + (
                           "" if str(one.unit) == "Pa" else " It is how the surface moves, not the sound at an ear."))
                 for one in product.listen.values())


def squeals(product):
    """Indices of the squeal events, the loudest first; of microphones, then of accelerometers in runs without any."""
    rows = np.flatnonzero(pictures.heard(product))
    sound = product.record_kind[product.event_record[rows]] == "sound"
    return rows[np.lexsort((-product.event_level[rows], ~sound))]


def counted(product):
    """The same, each squeal once, however many channels of its run have it at that time and frequency."""
    kept = np.array([], int)
    for event in squeals(product):
        kept = kept if _same(product, event, kept).any() else np.append(kept, event)
    return kept


def _same(product, event, others):
    """(k,) which of ``others`` (k,) are the squeal ``event`` in another channel."""
    record, begin, low, high = (getattr(product, f"event_{n}") for n in ("record", "start", "lowest", "highest"))
    end, run = begin + product.event_duration, product.record_run[record]
    return ((record[others] != record[event]) & (run[others] == run[event])
            & (np.maximum(begin[others], begin[event]) < np.minimum(end[others], end[event]))
            & (np.maximum(low[others], low[event]) < _ALIKE * np.minimum(high[others], high[event])))


def runs(product):
    """(runs that squeal, all runs that were searched), in their order."""
    noisy = set(product.record_run[product.event_record[squeals(product)]])
    every = list(dict.fromkeys(map(str, product.record_run)))
    return [name for name in every if name in noisy], every


def headline(product):
    """(text, tone) of the first screen; None where nothing was searched."""
    if not len(product.record_run):
        return None
    noisy, every = runs(product)
    cut = "; overloaded, levels are lower bounds" if product.record_overload.any() else ""
    if not noisy:
        return f"No squeal in {plural(len(every), 'run')}{cut}", "warning" if cut else "quiet"
    loudest = squeals(product)[0]
    return (f"Squeal in {len(noisy)} of {plural(len(every), 'run')}, loudest at"
            f" {quantity(product.event_frequency[loudest], 'Hz', 3)}{cut}", "squeal")


def conclusion(product):
    """What was found, in sentences."""
    if not len(product.record_run):
        return ("No channel of the recordings measures sound or acceleration at a rate that reaches the squeal band."
                + _unsearched(product))
    rows = counted(product)
    noisy, every = runs(product)
    others = {kind: np.count_nonzero(product.event_kind == kind) for kind in pictures.KINDS if kind != "squeal"}
    beside = ", ".join(f"{count} of {kind}" if kind in ("broadband", "series", "clipping") else plural(count, kind)
                       for kind, count in others.items() if count)
    if not len(rows):
        sound = product.record_kind == "sound"      # levels of sound and of vibration are not compared
        peak = int(np.argmax(np.where(sound | ~sound.any(), product.record_peak, -np.inf)))
        return (f"No steady tone reaches the threshold. The loudest tone in the band has"
                f" {_least(product, peak)}{number(product.record_peak[peak], 3)} {_unit(product, peak)} at"
                f" {quantity(product.record_peak_frequency[peak], 'Hz', 3)}, run {product.record_run[peak]}."
                + (f" Told beside: {beside}." if beside else "") + overloaded(product) + _unsearched(product))
    first = rows[0]
    return (f"{plural(len(rows), 'squeal event')} in {len(noisy)} of {plural(len(every), 'run')}"
            f" ({percent(len(noisy) / len(every), 2)}){_heard_by(product)}. The loudest:"
            f" {_least(product, product.event_record[first])}{number(product.event_level[first], 3)}"
            f" {_unit(product, product.event_record[first])} at"
            f" {quantity(product.event_frequency[first], 'Hz', 4)} for"
            f" {quantity(product.event_duration[first], 's', 2)}, run {product.record_run[product.event_record[first]]}"
            f"{_at(product, first)}.{_bands(product, rows)}{near_modes(product, rows)}"
            + (f" Told beside: {beside}." if beside else "") + overloaded(product) + _unsearched(product))


def _unsearched(product):
    """The first channel that was not searched, and how many more, with a space before; '' of none."""
    more = f" (and {len(product.remarks) - 1} more)" if len(product.remarks) > 1 else ""
    return f" {product.remarks[0]}{more}." if len(product.remarks) else ""


def overloaded(product):
    """What is overloaded, and what that means, in sentences with a space before; '' of nothing."""
    rows = np.flatnonzero(product.record_overload)
    if not len(rows):
        return ""
    told = "; ".join(f"run {product.record_run[k]}, {product.record_channel[k]}:"
                     f" {percent(product.record_overload[k], 2)} of the samples stand at"
                     f" {quantity(product.record_range[k], _range_unit(product, k), 3)}" for k in rows[:_OVERLOADED])
    more = f"; and {len(rows) - _OVERLOADED} more" if len(rows) > _OVERLOADED else ""
    made = " Multiples of its tones come from that." if "clipping" in product.event_kind else ""
    return f" Overloaded at the end of its range, so that levels are lower bounds: {told}{more}.{made}"


def _range_unit(product, record):
    return "Pa" if product.record_kind[record] == "sound" else "m/s^2"


def _least(product, record):
    return "at least " if product.record_overload[record] else ""


def _heard_by(product):     # where one squeal may be an event in several channels
    channels = set(product.record_channel[product.event_record[squeals(product)]])
    return f", each counted once among {len(channels)} channels" if len(channels) > 1 else ""


def _searched(product):
    low, high = product.band
    names = ", ".join(dict.fromkeys(f"{c} ({k})" for c, k in zip(product.record_channel, product.record_kind,
                                                                 strict=True)))
    return (f"Squeal is a steady tone of at least {number(product.threshold, 3)} dB(A) between {quantity(low, 'Hz', 3)}"
            f" and {quantity(high, 'Hz', 3)} (SAE J2521). Channels searched: {names or 'none'}.")


def _unit(product, record):
    return "dB(A)" if product.record_kind[record] == "sound" else "dB re 1 µm/s²"


def _at(product, event):
    """Conditions of an event, in brackets."""
    units = {"pressure": "Pa", "speed": "rad/s", "temperature": "K"}
    known = [f"{name} {quantity(value, units[str(name)], 3)}" for name, value, is_known in zip(
        product.condition, product.event_condition[event], product.event_condition_known[event], strict=True)
        if is_known]
    return f" ({', '.join(known)})" if known else ""


def _bands(product, rows):
    """The frequencies at which it squeals, by third octaves, and how many events each has."""
    octave = np.round(10 * np.log10(product.event_frequency[rows])).astype(int)
    bands = [(b, np.count_nonzero(octave == b)) for b in np.unique(octave)]
    if len(bands) < 2:
        return ""
    told = ", ".join(f"{quantity(product.event_frequency[rows][octave == b].mean(), 'Hz', 3)} ({count})"
                     for b, count in bands)
    return f" Frequencies, with the number of events: {told}."


def _figures(product, look):
    squeal = set(product.event_record[squeals(product)])
    order = sorted(range(len(product.record_run)), key=lambda k: (k not in squeal, product.record_kind[k] != "sound",
                                                       -product.record_peak[k]))
    drawn = " White: modes, stable ones dotted." if len(product.mode_name) else ""
    for record in order[:_SHOWN]:
        yield Figure(pictures.spectrogram(product, record, look.dpi),
                     f"Run {product.record_run[record]}, {product.record_channel[record]}: level over time and"
                     f" frequency; lines are events, red squeal.{drawn}")
    if np.any(product.record_kind[product.event_record] == "sound"):
        yield Figure(pictures.level_frequency(product), "Events of the microphones: level over frequency; dashed: the"
                     " threshold. Those below the band are not A-weighted.")
    pair = next((pair for pair in _PAIRS if np.count_nonzero(pictures.told(product, *pair)) > 1), None)
    if pair is not None:
        yield Figure(pictures.over_conditions(product, *pair), f"Squeal over {pair[0]} and {pair[1]}: one marker an"
                     " event, the larger the louder.")
    yield from _maps(product)


def _maps(product):
    """Figures of squeal over two conditions of which both vary."""
    for one in product.maps.values():
        if min(one.time.shape) > 1 and one.squealing.any():
            first, second = one.condition
            counts = f"over {first} and {second}; runs that squealed there / runs that were there."
            yield Figure(pictures.occurrence(one), f"Share of the time with squeal {counts} Without: no run was.")
            yield Figure(pictures.loudest(one), f"Largest level of squeal {counts} White: no squeal.")


def _tables(product):
    rows = tuple((str(product.record_run[r]), str(product.record_channel[r]), str(product.event_kind[k]),
                  quantity(product.event_frequency[k], "Hz", 4), _level(product, r, product.event_level[k]),
                  quantity(product.event_start[k], "s", 3), quantity(product.event_duration[k], "s", 2),
                  _at(product, k).strip(" ()"), *([nearest_mode(product, k)] if len(product.mode_name) else []))
                 for k in _in_order(product)[:_ROWS] for r in [product.event_record[k]])
    if rows:
        more = len(product.event_record) - len(rows)
        title = "Events" + (f", the loudest; {more} more in noise_events.csv" if more else "")
        head = ("run", "channel", "kind", "frequency", "level / dB", "begin", "length", "conditions", "nearest mode")
        yield Table(head[:len(rows[0])], rows, title, numeric=(3, 4, 5, 6), wide=(7,), folded=len(rows) > 12)
    peaks = tuple((str(product.record_run[k]), str(product.record_channel[k]),
                   _level(product, k, product.record_peak[k]), quantity(product.record_peak_frequency[k], "Hz", 4),
                   number(product.record_background[k], 3), quantity(product.record_duration[k], "s", 3))
                  for k in range(len(product.record_run)))
    if peaks:
        yield Table(("run", "channel", "loudest tone / dB", "at", "background / dB", "length"), peaks, "Records",
                    numeric=(2, 3, 4, 5), folded=len(peaks) > 12)


def _level(product, record, value):
    return f"{'≥ ' if product.record_overload[record] else ''}{number(value, 3)}"


def _in_order(product):
    """Indices of all events: squeal first, then by level."""
    return sorted(range(len(product.event_record)), key=lambda k: (product.event_kind[k] != "squeal",
                                                                   -product.event_level[k]))


def key_figure(product, look):
    """Figure of the first screen: the spectrogram of the loudest squeal."""
    rows = squeals(product)
    if not len(rows):
        return None
    record = product.event_record[rows[0]]
    return Figure(pictures.spectrogram(product, record, look.dpi),
                  f"The loudest squeal: run {product.record_run[record]}, {product.record_channel[record]}.")
