"""A shaft that slows down evenly from 25 to 5 revolutions per second, and signals of its orders."""

import numpy as np

from pipeline.physics.signals.orders.order_tracking import shaft_of, smooth, track

RATE, END = 8000.0, 20.0
T = np.arange(round(END * RATE)) / RATE
FIRST, LAST = 2 * np.pi * 25.0, 2 * np.pi * 5.0
#: revolutions of a linear ramp
TURNS = (FIRST * T + (LAST - FIRST) * T**2 / (2 * END)) / (2 * np.pi)
SLOW = np.linspace(FIRST, LAST, 401)                 # speed at 20 Hz


def order(number, amplitude=1.0):
    return amplitude * np.cos(2 * np.pi * number * TURNS + 0.4)


def ramp():
    return shaft_of(SLOW, 20.0, 0.0)


def tracked(samples, revolutions=8, highest=20.0):
    return track(smooth(samples, RATE, 0.0, highest * 25.0), ramp(), highest, revolutions, 0.9 * LAST)
