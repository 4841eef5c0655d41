"""Stage friction_map: mu(pressure, speed, distance) of the interface as a table for other programs."""

import numpy as np

from pipeline.contract import Context, Section, option, stage
from pipeline.physics.friction.friction_table import refine
from pipeline.products import FrictionMap, MicroFriction


class Settings(Section):
    """Refinement of the computed points."""

    pressure_subdivisions: int = option(10, "parts of each interval between computed pressures", ge=1)
    speed_subdivisions: int = option(5, "parts of each interval between computed speeds", ge=1)
    distance_subdivisions: int = option(5, "parts of each interval between recorded distances", ge=1)


def companions(product, case=None):
    """friction_map.csv: the long table, one line per point, SI units in the head."""
    grids = np.meshgrid(product.pressure, product.speed, product.distance, indexing="ij")
    rows = zip(*(a.ravel() for a in (*grids, product.friction, product.friction_std)), strict=True)
    head = "pressure [Pa],speed [m/s],distance [m],friction [1],friction_std [1]"
    return {"friction_map.csv": "\n".join([head, *(",".join(f"{v:.10g}" for v in row) for row in rows)]) + "\n"}


@stage(companions=companions)
def friction_map(micro_friction: MicroFriction, settings: Settings, context: Context) -> FrictionMap:
    """Map the friction coefficient over pressure, speed and sliding distance.

    Method:
    The computed points were interpolated by monotone cubics (PCHIP along pressure, speed and distance, each interval
    divided into {pressure_subdivisions}, {speed_subdivisions} and {distance_subdivisions} parts). The map is read by
    multilinear interpolation and, as in the paper, is constant outside the computed range.
    """
    parts = (settings.pressure_subdivisions, settings.speed_subdivisions, settings.distance_subdivisions)
    axes = (micro_friction.pressure, micro_friction.speed, micro_friction.distance)
    fine, friction = refine(axes, micro_friction.friction, parts)
    _, scatter = refine(axes, micro_friction.friction_std, parts)
    _, stiffness = refine(axes[::2], micro_friction.normal_stiffness.mean(axis=1), parts[::2])
    return FrictionMap(pressure=fine[0], speed=fine[1], distance=fine[2], friction=friction, friction_std=scatter,
                       normal_stiffness=stiffness, computed_pressure=micro_friction.pressure,
                       computed_speed=micro_friction.speed)
