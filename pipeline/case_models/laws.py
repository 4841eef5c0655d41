"""Laws of contact and friction as a case gives them: for transients and for benches alike."""

from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Quantity, Section, option
from pipeline.physics.friction.dry_friction import constant, falling
from pipeline.physics.friction.tangential_law import tangential_law
from pipeline.physics.time_stepping.simulate import Forward, Hard, Lagrange, Penalty, Table


class Laws(Section):
    """How contacts press and rub."""

    contact: Literal["hard", "penalty", "table", "lagrange", "forward"] = option(
        "hard", "hard: impulses on velocities; penalty: linear spring and damper; table: the contact law of the model;"
        " lagrange: multipliers on displacements under Newmark's rule; forward: multipliers as explicit codes set them,"
        " a step ahead")
    restitution: float = option(0.0, "hard: rebound velocity over impact velocity", ge=0, le=1)
    contact_stiffness: Quantity("N/m", gt=0) | None = option(
        None, "penalty: stiffness of each contact; none = that of the model about its preload")
    contact_damping: Quantity("N s/m", ge=0) = option("0 N s/m", "penalty: damping of each contact")
    damping_speed: Quantity("m/s", gt=0) = option("1 m/s", "table: closing speed that doubles the contact force")
    gamma: float = option(0.5, "Newmark's gamma; 0.5 trapezoidal, more damps the highest modes", ge=0.5, le=1)
    rule: Literal["exact", "newmark"] = option(
        "exact", "penalty: exact: linear part exactly; newmark: all by Newmark's rule, as FE codes do")
    friction: float | None = option(
        None, "coefficient of friction at high slip speed; none = that of the model about its preload", ge=0)
    friction_at_rest: float | None = option(None, "coefficient as the slip speed goes to zero; none = the same", ge=0)
    decay_speed: Quantity("m/s", gt=0) = option("10 mm/s", "slip speed over which friction falls from one to the other")
    static_factor: float = option(1.0, "hold of a sticking contact over friction at rest", ge=1)
    description: Literal["rigid", "elastic", "evolution"] = option("rigid", "how a contact sticks (1999, section 4)")
    tangential_stiffness: Quantity("N/m", gt=0) | None = option(
        None, "elastic and evolution: stiffness of each contact; none = that of the model about its preload")
    exponent: float | None = option(
        None, "evolution: how gradually slip sets in, 1/3 is one Hertz contact; none = that of the model", gt=0)


def normal_law(model, contacts, settings, where):
    """Normal law of the ``contacts`` of a product ReducedModel; ``where`` is the stage, for messages."""
    if settings.contact == "table":
        if not len(model.law_closure):
            raise ConfigError(f"{where}.contact", "hard, penalty, lagrange or forward: no law comes with the contacts",
                              "table")
        return Table(model.law_closure, model.law_pressure, settings.damping_speed, model.contact_gap)
    gap = model.contact_gap
    if settings.contact == "penalty":
        stiffness = contacts.stiffness if settings.contact_stiffness is None else settings.contact_stiffness
        return Penalty(stiffness, settings.contact_damping, gap, settings.gamma if settings.rule == "newmark" else None)
    return {"hard": Hard(settings.restitution, gap), "lagrange": Lagrange(settings.gamma, gap),
            "forward": Forward(gap)}[settings.contact]


def friction_law(model, contacts, settings, where):
    """Friction of the ``contacts``: of the settings, or of the product ReducedModel about its preload."""
    sticking = {"static_factor": settings.static_factor, "description": settings.description}
    if settings.description != "rigid":
        sticking |= _sticking(model, contacts, settings)
    if settings.friction is None:
        if settings.friction_at_rest is not None:
            raise ConfigError(f"{where}.friction", "a coefficient beside friction_at_rest", "none",
                              "give both, or neither for the tangential law of the model")
        return constant(_own_friction(model, contacts), **sticking)
    at_rest = settings.friction if settings.friction_at_rest is None else settings.friction_at_rest
    return falling(at_rest, settings.friction, settings.decay_speed, **sticking)


def _own_friction(model, contacts):
    """Coefficient of the model about its preload, mean weighted by the preload; 0 without contacts."""
    if not len(contacts.area):
        return 0.0
    return float(np.average(tangential_law(model).at(contacts.pressure).friction, weights=contacts.preload))


def _sticking(model, contacts, settings):
    """Stiffness (c,) N/m and exponent of the elastic and the evolution description."""
    stiffness, exponent = settings.tangential_stiffness, settings.exponent
    if stiffness is None or (exponent is None and settings.description == "evolution"):
        tangential = tangential_law(model).at(contacts.pressure)
        per_area = tangential.elastic_stiffness if settings.description == "elastic" else tangential.stiffness
        stiffness = per_area * contacts.area if stiffness is None else stiffness
        exponent = float(tangential.exponent.mean()) if exponent is None else exponent
    return {"stiffness": stiffness, "exponent": 1.0 if exponent is None else exponent}
