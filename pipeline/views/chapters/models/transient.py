"""Chapter: transient motion with contact and friction."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.pad_motion import extremes, point
from pipeline.views.figures.models import transient as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity, span


def chapter(product, look):
    """Chapter of the product Transient."""
    points = list(dict.fromkeys(extremes(product)))
    figures = tuple(figure for operating in points for figure in _figures(product, operating, look))
    sensors, settled = product.settled.size, int(product.settled.sum())
    cycle = "No sensor signal moves in the window." if not product.cycle_amplitude.any() else (
        f"Velocity amplitudes in the last {quantity(float(product.window), 's', 3)}:"
        f" {span(product.cycle_amplitude, 'm/s')}.")
    return Chapter(
        "transient", "Transient motion with contact and friction",
        f"{plural(len(product.pressure), 'operating point')}, {quantity(product.time[-1], 's', 3)} each in steps of"
        f" {quantity(float(product.step), 's', 3)}, {plural(product.normal_force.shape[1], 'contact')}. {cycle}"
        f" The energy balance closes within {percent(product.imbalance.max(), 2)}.",
        _conclusion(product, sensors, settled), figures, (_cycles(product),))


def _conclusion(product, sensors, settled):
    unsettled = sensors - settled
    state = ("All signals have settled in the window." if not unsettled else
            f"{unsettled} of {sensors} signals have NOT settled in the window: their amplitudes and frequencies belong"
            " to a transient or irregular motion, not to a limit cycle.")
    grew = product.grew > 0
    growth = (f" Small motions grew at rates of {span(product.growth_rate[grew], '1/s')}." if grew.any()
              else " No growth from small motion was observed.")
    return state + growth


def _figures(product, operating, look):
    where = point(product, operating)
    sensor = int(np.argmax(product.cycle_amplitude[operating])) if len(product.sensor_name) else None
    if sensor is not None:
        name = product.sensor_name[sensor]
        yield Figure(pictures.velocities(product, operating, look.dpi), f"Velocities at {where}; grey: the window.")
        yield Figure(pictures.phase_portrait(product, operating, sensor, look.dpi),
                     f"Phase portrait of sensor {name} in the window, {where}.")
        yield _spectrum(product, operating, sensor, look)
    if product.normal_force.shape[1]:
        fractions = product.status_share[operating].mean(axis=0)
        yield Figure(pictures.status_band(product, operating, look.dpi),
                     f"Status of the contacts at {where} about the largest slip; over the whole motion open"
                     f" {percent(fractions[0], 2)}, sticking {percent(fractions[1], 2)}, sliding"
                     f" {percent(fractions[2], 2)} of the time.")
        force = product.normal_force[operating, 0]
        yield Figure(pictures.force_and_slip(product, operating, 0, look.dpi),
                     f"Forces and slip of contact 1 at {where} about the largest slip; normal force"
                     f" {span(force[1:], 'N')} in the whole motion.")


def loudest(product, squeal, look):
    """Spectrum of the sensor with the highest peak of ``squeal``, for the first screen."""
    operating, sensor = np.unravel_index(np.argmax(squeal.peak_level), squeal.peak_level.shape)
    return _spectrum(product, operating, sensor, look)


def _spectrum(product, operating, sensor, look):
    return Figure(pictures.spectrum(product, operating, sensor, look.dpi),
                  f"Spectrum of sensor {product.sensor_name[sensor]} in the window, {point(product, operating)}:"
                  f" {_harmonics(product, operating, sensor)}.")


def _harmonics(product, operating, sensor):
    """'2.215 kHz; 2f -18 dB, 3f -31 dB' with the harmonics within 60 dB."""
    base, levels = product.cycle_frequency[operating, sensor], product.harmonic_amplitude[operating, sensor]
    if not base > 0 or not levels[0] > 0:
        return "no motion"
    heard = [f"{k}f {number(20 * np.log10(a / levels[0]), 2)} dB" for k, a in enumerate(levels, 1)
             if k > 1 and a > 1e-3 * levels[0]]
    return "; ".join([quantity(base, "Hz"), ", ".join(heard)]) if heard else f"{quantity(base, 'Hz')}, no harmonics"


def _cycles(product):
    rows = []
    for operating in range(len(product.pressure)):
        for sensor, name in enumerate(product.sensor_name):
            at = operating, sensor
            growth = (f"{number(product.growth_rate[at], 3)} ± {quantity(product.growth_rate_std[at], '1/s', 2)}"
                      if product.grew[at] else "none observed")
            rows.append((point(product, operating), name, quantity(product.cycle_frequency[at], "Hz"),
                         quantity(product.cycle_amplitude[at], "m/s", 3), percent(product.cycle_drift[at], 2),
                         "yes" if product.settled[at] else "NO", growth))
    head = ("operating point", "sensor", "frequency", "velocity amplitude", "drift", "settled", "initial growth")
    return Table(head, tuple(rows), "Cycles in the window", numeric=(2, 3, 4), folded=len(rows) > 8)
