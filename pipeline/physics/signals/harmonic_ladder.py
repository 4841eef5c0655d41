"""Which tones of one instant are whole multiples of another one: own tones and their harmonics.

A stick-slip or saturated motion repeats itself without being a sine: its spectrum is a ladder n g of its fundamental g.
An arbitrary tone, too, is near some multiple of a low one. So the fundamental must be a tone that is there, and the
multiple must be met more closely than chance would:

    |f - n g_m| <= tolerance = (n / m + 1) accuracy,    g_m = f_m / m,

where f_m is the highest step of the ladder found so far (m = 1: the fundamental itself). Each step found tells the
fundamental m times more accurately, so that high orders count where the steps below them are there, and only there.

Chance of a false match: a tone without relation to g lies anywhere between two multiples of g, so that a share of
2 tolerance / g of such tones matches. A match whose share exceeds the ``chance`` allowed does not count, whatever the
frequencies. With k unrelated fundamentals at once the chance is up to k times as large; steady tones err alike in every
frame, so that it does not shrink with their length. Example, accuracy 5 Hz and g = 800 Hz: 3.8 % at order 2,
3.1 % at order 3 after order 2, falling to 2.5 %; order 8 with no step below it would have 11 %, too much for 10 %.
"""

import numpy as np


def ladders(frequency, accuracy, chance):
    """(order, fundamental) of each tone of one instant.

    Parameters
    ----------
    frequency : (tone,) [Hz], above 0, in any order
    accuracy : largest error of each of them [Hz]
    chance : largest share of unrelated tones that may match a fundamental by accident; see above

    Returns
    -------
    order : (tone,) 1 = a tone of its own
    fundamental : (tone,) [Hz] the tone whose multiple it is; of an own tone, its own frequency
    """
    order, fundamental = np.ones(len(frequency), dtype=int), np.array(frequency, dtype=float)
    highest = {}                # own tone -> (order, frequency) of the highest step of its ladder
    for tone in np.argsort(frequency, kind="stable"):
        matches = [(*_match(frequency[tone], *step, accuracy), ladder) for ladder, step in highest.items()]
        share, multiple, ladder = min(matches, default=(np.inf, 1, tone))
        if share > chance:
            multiple, ladder = 1, tone
        order[tone], fundamental[tone] = multiple, frequency[ladder]
        highest[ladder] = (multiple, frequency[tone])
    return order, fundamental


def comb(frequency, order, fundamental, accuracy, least):
    """(order, fundamental) of the tones of one instant where ``least`` or more of them are equidistant multiples of
    their distance: a series whose fundamental need not be heard, as that of a creak. Others keep what ``ladders`` told.

    ``frequency`` (tone,) [Hz], ``order`` and ``fundamental`` as of ``ladders``, ``accuracy`` of a frequency [Hz].
    """
    rising = np.sort(frequency)
    if len(rising) < least:
        return order, fundamental
    distance = np.median(np.diff(rising))
    for _ in range(2):          # of the highest order found the distance is known best
        steps = np.maximum(np.round(frequency / distance), 1.0)
        fits = np.abs(frequency - steps * distance) <= 2.0 * accuracy + 0.02 * distance
        if np.count_nonzero(fits) < least:
            return order, fundamental
        distance = np.sum(steps[fits] * frequency[fits]) / np.sum(steps[fits] ** 2)
    if 4.0 * accuracy > 0.3 * distance:
        return order, fundamental
    own = order > 1
    return (np.where(fits & ~own, steps.astype(int), order), np.where(fits & ~own & (steps > 1), distance, fundamental))


def _match(frequency, step_order, step_frequency, accuracy):
    """(share of unrelated tones that match too, order); the share is infinite without a match above the last step."""
    fundamental = step_frequency / step_order
    order = round(frequency / fundamental)
    tolerance = (order / step_order + 1) * accuracy
    if order <= step_order or abs(frequency - order * fundamental) > tolerance:
        return np.inf, order
    return 2 * tolerance / fundamental, order
