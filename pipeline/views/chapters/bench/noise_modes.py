"""What is said of recorded squeal beside the modes that it is compared with."""

import numpy as np

from pipeline.products.sound import OWN_TONES
from pipeline.views.figures.number_format import percent, plural

#: what is said of a mode by ``mode_unstable``
_STATES = {1: ", unstable", 0: ", stable", -1: ""}


def nearest_mode(product, event):
    """The mode near an event, and how far the event lies above or below it."""
    mode = product.event_mode[event]
    if mode < 0:
        return f"none within {percent(product.near, 2)}" if str(product.event_kind[event]) in OWN_TONES else ""
    away = product.event_frequency[event] / product.mode_frequency[mode] - 1.0
    sign = "+" if away >= 0 else ""
    return f"{product.mode_name[mode]}, {sign}{percent(away, 2)}{_STATES[product.mode_unstable[mode]]}"


def near_modes(product, rows):
    """How many frequencies of the events ``rows`` lie near a mode, and how many would by chance; '' without modes.

    Events nearer to each other than to a mode near them are one frequency: together they tell no more than one.
    """
    if not len(product.mode_name) or not len(rows):
        return ""
    rows = rows[np.argsort(product.event_frequency[rows], kind="stable")]
    apart = np.diff(np.log(product.event_frequency[rows]), prepend=-np.inf) > product.near
    rows = np.array([part[np.argmax(product.event_level[part])] for part in np.split(rows, np.flatnonzero(apart)[1:])])
    near, chance = product.event_mode[rows], product.event_chance[rows].mean(axis=0)
    told = (f" Squeal frequencies within {percent(product.near, 2)} of one of {plural(len(product.mode_name), 'mode')}:"
            f" {np.count_nonzero(near >= 0)} of {len(rows)}; by chance {percent(chance[0], 2)} would be, as dense as"
            " modes lie there.")
    if np.any(product.mode_unstable == 1):
        unstable = np.count_nonzero(product.mode_unstable[near[near >= 0]] == 1)
        told += f" Of one that is predicted to be unstable: {unstable}; by chance {percent(chance[1], 2)}."
    return told
