"""A smooth law over pressure through computed points that scatter: a polynomial in the logarithm of pressure.

Complex modes see the slope p dmu/dp as much as mu itself. A curve through every point takes the scatter of the points
into that slope; a polynomial of low order, fitted by weight of their standard errors, does not. Beyond the points it
levels off: its slope over ln p falls linearly to zero within a factor of two of pressure.
"""

import numpy as np

from pipeline.contract.errors import ConfigError

#: factor of pressure within which the law levels off beyond the points
LEVELLING = 2.0


def levelling_axis(pressure, parts):
    """(F,) Pa: every interval of ``pressure`` (P,) cut into ``parts``, and as many beyond each end, to its factor of
    LEVELLING."""
    inside = np.interp(np.arange((len(pressure) - 1) * parts + 1) / parts, np.arange(len(pressure)), pressure)
    beyond = LEVELLING ** (np.arange(1, parts + 1) / parts)
    return np.r_[pressure[0] / beyond[::-1], inside, pressure[-1] * beyond]


def slope_error(x, deviation):
    """Standard error of the slope of a straight line through values at ``x`` (P,) with independent errors ``deviation``
    (P,); 0 where there is no slope, or no error."""
    if len(x) < 2 or not np.all(np.asarray(deviation) > 0):
        return 0.0
    weight = 1 / np.asarray(deviation) ** 2
    return float(1 / np.sqrt(weight @ (x - weight @ x / weight.sum()) ** 2))


def polynomial_fit(pressure, deviation, order, place):
    """(F, P): values at ``place`` (F,) Pa of the fitted law, per value at ``pressure`` (P,) Pa.

    ``deviation`` (P,): standard errors of the values; ``order`` of the polynomial in ln p. Raises ConfigError where
    there are no more points than its order, or errors that are not positive.
    """
    if len(pressure) <= order or not np.all(np.asarray(deviation) > 0):
        raise ConfigError("friction map: order", f"more than {order} pressures with standard errors above 0",
                          f"{len(pressure)} pressures", "lower the order, or interpolate")
    middle, half, ends = np.log(pressure).mean(), np.ptp(np.log(pressure)) / 2 or 1.0, np.log(pressure[[0, -1]])
    powers = np.arange(order + 1)

    def terms(x):
        return ((x[:, None] - middle) / half) ** powers

    def slopes(x):
        return powers * ((x[:, None] - middle) / half) ** np.maximum(powers - 1, 0) / half

    weight = 1 / np.asarray(deviation)
    solution = np.linalg.pinv(weight[:, None] * terms(np.log(pressure))) * weight
    x, reach = np.log(place), np.log(LEVELLING)
    inside = np.clip(x, *ends)
    gone = np.clip(x - inside, -reach, reach)
    levelled = terms(inside) + slopes(inside) * (gone - np.sign(gone) * gone**2 / (2 * reach))[:, None]
    return levelled @ solution
