"""Constitutive law of a rough interface after Willner & Gaul (1995): summits that do not know of each other.

Two surfaces are one: the sum of their heights against a plane, with both elasticities in the moduli. Summit i of height
z_i and curvature k_i meets the plane at gap d with the overlap x = z_i - d > 0 and, after Hertz,

    P = 4/3 E* sqrt(x^3 / k),    a = sqrt(x / k),                                                                   (1)

and shears after Cattaneo and Mindlin, with the friction limit mu P replaced by a constant yield stress tau_max on
the whole contact, Q_max = pi a^2 tau_max:

    Q = Q_max (1 - (1 - v / v_max)^(3/2)) for v < v_max,    v_max = 3 Q_max / (16 G* a),    else Q_max.              (2)

Pressure, real area and shear stress are sums over the summits on unit area. Heights are Gaussian; the logarithm of the
curvature is Gaussian too and correlated with the height. Lengths m, stresses Pa.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.elastic_constants import plane_strain_modulus, shear_modulus
from pipeline.physics.friction.dry_friction import evolution_curve

#: distribution of standardised heights (SciPy's name), and the height above which none are counted
_HEIGHTS = {"gaussian": ("norm", 7.0), "exponential": ("expon", 40.0)}
_HEIGHT_POINTS, _CURVATURE_POINTS = 60, 12
#: a summit stands higher than its eight neighbours
_NEIGHBOURS = [(y, x) for y in (-1, 0, 1) for x in (-1, 0, 1) if (y, x) != (0, 0)]
_FEWEST_SUMMITS = 30


@dataclass(frozen=True)
class Summits:
    """Population of summits: ``density`` 1/m^2, ``mean`` and ``spread`` of the heights above the mean plane in m.

    ``curvature`` 1/m is the median, ``curvature_spread`` the standard deviation of its logarithm, ``correlation`` that
    of logarithm and height. ``heights`` is gaussian, or exponential above ``mean``.
    """

    density: float
    mean: float
    spread: float
    curvature: float
    curvature_spread: float = 0.0
    correlation: float = 0.0
    heights: str = "gaussian"


@dataclass(frozen=True)
class Moduli:
    """Contact modulus E*, shear modulus G* of the pair, yield stress tau_max in shear; Pa."""

    normal: float
    shear: float
    shear_limit: float


def moduli(young, poisson, shear_limit):
    """Moduli of two bodies; ``young`` and ``poisson`` hold two values each.

    1/E* = sum (1 - nu^2) / E and 1/G* = sum (2 - nu) / G, so that Q = 8 G* a v before slip.
    """
    young, poisson = np.asarray(young, float), np.asarray(poisson, float)
    shear = shear_modulus(young, poisson)
    return Moduli(1 / (1 / plane_strain_modulus(young, poisson)).sum(), 1 / ((2 - poisson) / shear).sum(), shear_limit)


def summits_of(heights, spacing):
    """Summits of a periodic height map (ny, nx) in m: points above their eight neighbours.

    The curvature is the mean of the two central second differences at the ``spacing`` (m) of the map, the resolution
    on which it depends (Greenwood, Proc. R. Soc. A 393 (1984) 133). Raises ConfigError for fewer than 30 summits.
    """
    heights = heights - heights.mean()
    higher = np.logical_and.reduce([heights > np.roll(heights, shift, (0, 1)) for shift in _NEIGHBOURS])
    bend = sum(np.roll(heights, shift, axis) for axis in (0, 1) for shift in (-1, 1)) - 4 * heights
    top, curvature = heights[higher], -bend[higher] / (2 * spacing**2)
    if len(top) < _FEWEST_SUMMITS:
        raise ConfigError("interface law: summits", f"at least {_FEWEST_SUMMITS} on the map", str(len(top)),
                          "take a larger or rougher patch")
    bent = np.log(curvature)
    scatter, covariance = top.std() * bent.std(), np.mean((top - top.mean()) * (bent - bent.mean()))
    return Summits(len(top) / (heights.size * spacing**2), top.mean(), top.std(), np.exp(bent.mean()), bent.std(),
                   np.clip(covariance / scatter, -1, 1) if scatter > 1e-9 * abs(top).max() else 0.0)


def normal_law(summits, modulus, gap):
    """(pressure Pa, real area share, stiffness -dp/dgap Pa/m) at each ``gap`` (g,): distance to the mean plane."""
    overlap, curvature, weight = _meeting(summits, gap)
    pressure = 4 / 3 * modulus * np.sqrt(overlap**3 / curvature)
    stiffness = 2 * modulus * np.sqrt(overlap / curvature)
    return tuple((weight * per_summit).sum(axis=(1, 2)) for per_summit in
                 (pressure, np.pi * overlap / curvature, stiffness))


def shear_law(summits, pair, gap, displacement):
    """Shear stress (g, v) Pa at each ``gap`` (g,) and tangential ``displacement`` (v,) m, from rest."""
    overlap, curvature, weight = _meeting(summits, gap)
    radius = np.sqrt(overlap / curvature)
    return np.stack([(weight * summit_shear(v, radius, pair)).sum(axis=(1, 2)) for v in displacement], axis=1)


def summit_shear(displacement, radius, pair):
    """Equation (2): force N on one summit with contact ``radius`` (m)."""
    limit = np.pi * radius**2 * pair.shear_limit
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(radius > 0, displacement / (3 * limit / (16 * pair.shear * radius)), 0.0)
    return limit * (1 - np.maximum(1 - share, 0.0) ** 1.5)


def gap_at(summits, modulus, pressure):
    """Gap (p,) in m at which the interface carries each ``pressure`` (p,) Pa; ConfigError beyond its range."""
    reach = _HEIGHTS[summits.heights][1] * summits.spread
    low, high = summits.mean - reach, summits.mean + (1 - 1e-6) * reach
    ends = normal_law(summits, modulus, np.array([high, low]))[0]
    gaps = []
    for wanted in np.atleast_1d(pressure):
        if not ends[0] < wanted < ends[1]:
            raise ConfigError("interface law: pressure", f"between {ends[0]:.3g} and {ends[1]:.3g} Pa",
                              f"{wanted:.3g} Pa")
        gaps.append(scipy.optimize.brentq(lambda d, p=wanted: np.log(normal_law(summits, modulus, [d])[0][0] / p),
                                           low, high, xtol=1e-12 * summits.spread, rtol=1e-14))
    return np.array(gaps)


def _meeting(summits, gap):
    """(overlap, curvature, weight), each (g, heights, curvatures): Gauss points of the summits that meet the plane."""
    point, height_weight = np.polynomial.legendre.leggauss(_HEIGHT_POINTS)
    gap = np.atleast_1d(np.asarray(gap, float))
    name, highest = _HEIGHTS[summits.heights]
    shape = getattr(scipy.stats, name).pdf
    deepest = np.maximum(summits.mean + highest * summits.spread - gap, 0.0)
    root = 0.5 * (point + 1)
    overlap = deepest[:, None] * root**2            # the square takes the root at x = 0 out of the integrand
    width = deepest[:, None] * root * height_weight
    standard = (overlap + gap[:, None] - summits.mean) / summits.spread
    weight = summits.density * shape(standard) / summits.spread * width
    node, curvature_weight = np.polynomial.hermite_e.hermegauss(_CURVATURE_POINTS)
    independent = np.sqrt(1 - summits.correlation**2) * node
    logarithm = summits.curvature_spread * (summits.correlation * standard[..., None] + independent)
    return (overlap[..., None], summits.curvature * np.exp(logarithm),
            weight[..., None] * curvature_weight / curvature_weight.sum())


@dataclass(frozen=True)
class Descriptions:
    """Parameters of the three friction descriptions at each pressure: what section 4 of the 1999 paper implements.

    ``stiffness`` Pa/m at rest and ``limit`` Pa of the evolution rule dtau/dv = stiffness (1 - tau / limit)^exponent;
    the elastic stick takes ``elastic_stiffness`` Pa/m up to the limit, the rigid stick the limit alone.
    """

    stiffness: np.ndarray
    limit: np.ndarray
    exponent: np.ndarray
    elastic_stiffness: np.ndarray


def fit_descriptions(summits, pair, gap, displacement, shear):
    """Descriptions fitted to a shear law (g, v).

    Stiffness at rest and limit follow from the summits themselves; the exponent has the least squared error over the
    displacements, the elastic stiffness the same energy lost up to full slip as the law.
    """
    _, area, normal = normal_law(summits, pair.normal, gap)
    stiffness, limit = normal * 4 * pair.shear / pair.normal, area * pair.shear_limit
    exponents = np.linspace(0.5, 3.0, 251)
    best, elastic = [], []
    for k in range(len(gap)):
        curves = np.array([evolution_curve(displacement, limit[k], stiffness[k], m) for m in exponents])
        best.append(exponents[np.argmin(((curves - shear[k]) ** 2).sum(axis=1))])
        missing = np.trapezoid(limit[k] - shear[k], displacement)
        elastic.append(limit[k] ** 2 / (2 * missing))
    return Descriptions(stiffness, limit, np.array(best), np.array(elastic))


def elastic(displacement, stiffness, limit):
    """Shear stress of the elastic stick."""
    return np.minimum(stiffness * np.asarray(displacement), limit)
