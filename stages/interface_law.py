"""Stage interface_law: pressure, real area and shear of the rough interface from its summits (Willner & Gaul)."""

from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.physics.friction.dry_friction import evolution_curve
from pipeline.physics.rough.summit_model import (
    Summits,
    elastic,
    fit_descriptions,
    gap_at,
    moduli,
    normal_law,
    shear_law,
    summits_of,
)
from pipeline.products import InterfaceLaw, Surface


class Material(Section):
    """Elasticity of one body."""

    young: Quantity("Pa", gt=0) = option("70 GPa", "Young's modulus")
    poisson: float = option(0.33, "Poisson's ratio", ge=0, lt=0.5)


class FromSurface(Section):
    """Summits of the summed height maps."""

    kind: Literal["surface"] = "surface"


class Given(Section):
    """Summits by their parameters, where there is no map."""

    kind: Literal["given"] = "given"
    density: Quantity("1/m^2", gt=0) = option(..., "summits per area")
    mean: Quantity("m") = option("0 um", "mean height of the summits above the mean plane")
    spread: Quantity("m", gt=0) = option(..., "standard deviation of their heights")
    curvature: Quantity("1/m", gt=0) = option(..., "median of their curvatures")
    curvature_spread: float = option(0.0, "standard deviation of the logarithm of the curvatures", ge=0)
    correlation: float = option(0.0, "correlation of that logarithm and the height", gt=-1, lt=1)


class Settings(Section):
    """Materials of the pair and range of its law."""

    summits: FromSurface | Given = option(FromSurface(), "where the summits come from", discriminator="kind")
    disc: Material = option(Material(), "disc")
    pad: Material = option(Material(), "the body that rubs on it: the pin")
    shear_limit: Quantity("Pa", gt=0) = option("385 MPa", "yield stress in shear of the contact spots, tau_max of a"
                                                          " summit")
    lowest_pressure: Quantity("Pa", gt=0) = option("1 kPa", "lowest nominal pressure of the law")
    highest_pressure: Quantity("Pa", gt=0) = option("470 MPa", "highest nominal pressure of the law")
    pressure_steps: int = option(48, "pressures of the shear law, spread evenly over their logarithm", ge=2)
    largest_displacement: Quantity("m", gt=0) = option("1 um", "tangential displacement up to which the law is"
                                                               " computed")
    displacement_steps: int = option(201, "displacements of the shear law, from 0", ge=10)
    gap_steps: int = option(200, "gaps of the normal law", ge=10)


@stage
def interface_law(surface: Surface | None, settings: Settings, context: Context) -> InterfaceLaw:
    """Compute pressure, real area and shear stress of the rough interface from its summits.

    Method:
    Following Willner and Gaul, the rough interface is a population of summits with Gaussian heights that deform
    according to Hertz and shear according to Cattaneo and Mindlin up to a yield stress of {shear_limit}. The parameters
    of the Dahl model and of the elastic sticking stiffness were fitted to the shear law at {pressure_steps} pressures.
    """
    if not settings.lowest_pressure < settings.highest_pressure:
        raise ConfigError("interface_law.highest_pressure", f"above the lowest, {settings.lowest_pressure:g} Pa",
                          f"{settings.highest_pressure:g} Pa")
    summits, source = _summits(surface, settings)
    context.log(f"{summits.density:.3g} summits per m^2, spread {summits.spread:.3g} m, radius"
                f" {1 / summits.curvature:.3g} m")
    pair = moduli(*zip(*((m.young, m.poisson) for m in (settings.disc, settings.pad)), strict=True),
                  settings.shear_limit)
    pressure = np.geomspace(settings.lowest_pressure, settings.highest_pressure, settings.pressure_steps)
    ends = gap_at(summits, pair.normal, [settings.lowest_pressure, settings.highest_pressure])
    gap = np.linspace(*ends, settings.gap_steps)
    normal = normal_law(summits, pair.normal, gap)
    return InterfaceLaw(
        source=source, summit_density=summits.density, summit_mean=summits.mean, summit_spread=summits.spread,
        summit_curvature=summits.curvature, curvature_spread=summits.curvature_spread,
        curvature_correlation=summits.correlation, shear_limit=settings.shear_limit, gap=gap, gap_pressure=normal[0],
        real_area=normal[1], normal_stiffness=normal[2], pressure=pressure,
        **_shear(summits, pair, pressure, settings))


def _summits(surface, settings):
    """Summits and where they come from."""
    if settings.summits.kind == "given":
        return Summits(**settings.summits.model_dump(exclude={"kind"})), "given parameters"
    if surface is None:
        raise ConfigError("interface_law.summits", "kind: given, with parameters", "a chain without surfaces")
    summits = summits_of(surface.disc_height[0] + surface.pad_height[0], surface.x[1] - surface.x[0])
    return summits, f"{' and '.join(map(str, surface.source))}, resolution {surface.x[1] - surface.x[0]:.3g} m"


def _shear(summits, pair, pressure, settings):
    """The shear law at each pressure and its three descriptions."""
    gap = gap_at(summits, pair.normal, pressure)
    displacement = np.linspace(0.0, settings.largest_displacement, settings.displacement_steps)
    shear = shear_law(summits, pair, gap, displacement)
    fit = fit_descriptions(summits, pair, gap, displacement, shear)
    rows = range(len(pressure))
    return {"displacement": displacement, "shear": shear,
            "evolution_shear": [evolution_curve(displacement, fit.limit[k], fit.stiffness[k], fit.exponent[k])
                                for k in rows],
            "elastic_shear": [elastic(displacement, fit.elastic_stiffness[k], fit.limit[k]) for k in rows],
            "tangential_stiffness": fit.stiffness, "limit": fit.limit, "exponent": fit.exponent,
            "elastic_stiffness": fit.elastic_stiffness, "friction": fit.limit / pressure}
