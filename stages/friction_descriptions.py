"""Stage friction_descriptions: cost of the three friction descriptions of the 1999 paper in implicit integration."""

from functools import partial

import numpy as np

from pipeline.contract import Context, Quantity, Section, option, stage
from pipeline.physics.closed_form.cattaneo_mindlin import tangential_load
from pipeline.physics.friction.description_study import block_on_drive, curve_error, run
from pipeline.physics.friction.dry_friction import DESCRIPTIONS
from pipeline.products import FrictionDescriptions, InterfaceLaw

#: initial stiffness of one Hertz contact over limit per sliding displacement, and the exponent of its own curve
HERTZ_STIFFNESS, HERTZ_EXPONENT = 1.5, 1 / 3


class Settings(Section):
    """The block, its pulsating load and the steps."""

    feet: int = option(4, "contacts along each edge of the block", ge=1)
    modulations: tuple[float, ...] = option(
        (0.3, 1.2, 2.0), "amplitudes of the pulsating load over its mean; above 1 contact is lost", min_length=1)
    step: Quantity("s", gt=0) = option("40 us", "time step; that of the paper")
    steps: int = option(200, "steps", ge=10)


@stage
def friction_descriptions(law: InterfaceLaw, settings: Settings, context: Context) -> FrictionDescriptions:
    """Count iterations of three friction descriptions in an implicit calculation.

    Method:
    A block on {feet} x {feet} elastic feet slides on an oscillating drive under a load that pulsates by {modulations}
    of its mean, with the friction of the interface law: {steps} steps of {step} with Newmark's method and Newton
    iterations, with and without the unsymmetric term of the tangent. Damping and normal law were chosen such that the
    block follows its load.
    """
    friction = float(np.median(law.friction))
    tasks = [(full, modulation, name) for full in (False, True) for modulation in settings.modulations
             for name in DESCRIPTIONS]
    counts = context.map(partial(_count, friction, settings), tasks, "descriptions")
    shape = 2, len(settings.modulations), len(DESCRIPTIONS)

    def table(read):
        return np.array([read(count) for count in counts]).reshape(shape)

    cost = table(lambda count: count.cost)
    return FrictionDescriptions(
        description=list(DESCRIPTIONS), modulation=settings.modulations, step=settings.step,
        iterations=table(lambda count: count.iterations.mean()), worst=table(lambda count: count.iterations.max()),
        halvings=table(lambda count: count.halvings), converged=table(lambda count: int(count.converged)),
        cost=cost / cost.min(), sliding_share=table(lambda count: count.sliding_share), mean_shift=table(_mean_shift),
        curve_error=[_curve_error(name) for name in DESCRIPTIONS])


def _count(friction, settings, task):
    full, modulation, name = task
    problem = block_on_drive(settings.feet, friction, modulation=modulation)
    return run(problem, name, settings.step, settings.steps, full)


def _mean_shift(count):
    """Mean displacement of the block along sliding in the second half; 0 where a step was given up."""
    return count.displacement[len(count.displacement) // 2:, -5].mean() if count.converged else 0.0


def _curve_error(name):
    """Deviation of a description from the curve of one Hertz contact (Cattaneo and Mindlin) up to twice full slip."""
    displacement = np.linspace(0, 2, 401)
    force = tangential_load(np.minimum(displacement, 1.0), 1.0, 1.0)
    stiffness = {"rigid": 0.0}.get(name, HERTZ_STIFFNESS)
    return curve_error(displacement, force, 1.0, name, stiffness, HERTZ_EXPONENT if name == "evolution" else 1.0)
