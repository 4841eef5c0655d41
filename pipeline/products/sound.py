"""Vibration at the sensors, and the squeal in it."""

import numpy as np

from pipeline.contract import Array, count, product, quantity, text


@product(version=1)
class Response:
    """Vibration of the elastic brake at the sensors, excited by the contact forces."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    time: Array = quantity("s", "time", "time after the static start")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors", np.float32)
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    velocity_spectrum: Array = quantity("m^2/s^2/Hz", "operating sensor frequency", "one-sided power spectral density (Welch)")
    mode_operating: Array = count("mode", "operating point of the superposed mode")
    mode_frequency: Array = quantity("Hz", "mode", "its natural frequency")
    mode_damping: Array = quantity("1", "mode", "its damping ratio, 0 for a rigid motion")
    coupling: Array = text("", "how forces enter: disc, released (open contacts) or assembly (closed contacts)")


@product(version=3)
class Squeal:
    """Squeal events at the sensors, and levels per band."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    sensor_name: Array = text("sensor", "sensor names")
    coupling: Array = text("", "how forces entered the response: disc, released (open contacts) or assembly (closed contacts)")
    reference: Array = quantity("m/s", "", "reference velocity of the level")
    threshold: Array = quantity("1", "", "level above which a peak is a squeal event, dB")
    peak_level: Array = quantity("1", "operating sensor", "highest level in the squeal band, dB")
    peak_frequency: Array = quantity("Hz", "operating sensor", "its frequency")
    band: Array = quantity("Hz", "band", "centre of the third-octave bands")
    band_level: Array = quantity("1", "operating sensor band", "velocity level per band, dB")
    event_operating: Array = count("event", "operating point of the event")
    event_sensor: Array = count("event", "sensor of the event")
    event_frequency: Array = quantity("Hz", "event", "frequency")
    event_level: Array = quantity("1", "event", "largest level, dB")
    event_start: Array = quantity("s", "event", "start")
    event_duration: Array = quantity("s", "event", "duration")
    event_fundamental: Array = quantity("Hz", "event", "fundamental of which the event is an integer multiple; its own frequency if there is none")
    event_order: Array = count("event", "order: 1 = fundamental, 2 and more = harmonic")
