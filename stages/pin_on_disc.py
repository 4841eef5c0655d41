"""Stage pin_on_disc: disc and pin as finite elements on hub, clamp and guide, and the load states of their contact."""

from dataclasses import fields
from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.contact.static_preload import contact_law
from pipeline.physics.fem.supports import held_modes
from pipeline.physics.friction.tangential_law import TangentialLaw
from pipeline.physics.modal.disc_modes import describe
from pipeline.products import InterfaceLaw, PinOnDisc
from pipeline.systems.fem_bodies import assembly_fields, body_product, incidence
from pipeline.systems.pin_on_disc import BODIES, SENSORS, build, pin, sliding_flexibility

_GRAVITY = 9.81
#: modes of the free-standing pin that are told
_PIN_MODES = 6
#: of the gaps of the interface law, every so many shape the contact law
_LAW_STRIDE = 5


class Disc(Section):
    """The disc. Its (3,0) and (2,0) modes follow from size and material; the shaft is fitted to the rocking mode."""

    outer_radius: Quantity("m", gt=0) = option("179 mm", "outer radius")
    thickness: Quantity("m", gt=0) = option("25 mm", "thickness")
    hub_radius: Quantity("m", gt=0) = option("18.8 mm", "radius up to which the hub is rigid")
    shaft_radius: Quantity("m", gt=0) = option("8 mm", "radius of the shaft that is held")
    rocking_stiffness: Quantity("N m/rad", gt=0) = option("0.82 MN m/rad", "moment per angle of the hub on its shaft")
    young: Quantity("Pa", gt=0) = option("70 GPa", "Young's modulus")
    poisson: float = option(0.33, "Poisson's ratio", ge=0, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("2700 kg/m^3", "density")
    damping_ratio: float = option(0.002, "damping ratio of all modes", ge=0, lt=1)
    radial_cells: int = option(10, "cells from hub to rim", ge=2)
    angular_cells: int = option(48, "cells around", ge=12)
    axial_cells: int = option(2, "cells through the thickness; one makes the (3,0) mode 0.4 % too high", ge=1)


class Pin(Section):
    """The pin, its clamp and its accelerometer."""

    length: Quantity("m", gt=0, le=0.2) = option("151.5 mm", "free length; up to 200 mm")
    side: Quantity("m", gt=0) = option("10 mm", "side of the square section")
    tilt: Quantity("rad", gt=-1, lt=1) = option("4 deg", "angle to the normal of the disc; positive: clamp upstream")
    young: Quantity("Pa", gt=0) = option("70 GPa", "Young's modulus")
    poisson: float = option(0.33, "Poisson's ratio", ge=0, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("2700 kg/m^3", "density")
    damping_ratio: float = option(0.01, "damping ratio of all modes", ge=0, lt=1)
    tip_mass: Quantity("kg", ge=0) = option("1.3 g", "mass of the accelerometer, on the last cell of the tip")
    tip_cell: Quantity("m", gt=0) = option("2 mm", "length of that cell")
    clamp_length: Quantity("m", gt=0) = option("20 mm", "depth of the jaws")
    clamp_stiffness: Quantity("N/m", gt=0) = option("10 GN/m", "clamp and guide across, each direction; rigid")
    loss_time: Quantity("s", ge=0) = option("0 s", "damping over stiffness of clamp and guide")
    base_mass: Quantity("kg", gt=0) = option("5 g", "mass that moves with the clamp along the guide")
    axial_cells: int = option(24, "cells along the free length", ge=4)
    cells_across: int = option(1, "cells along each side of the section", ge=1)


class Contact(Section):
    """Contact of the tip."""

    radius: Quantity("m", gt=0) = option("159 mm", "distance of the contact from the axis of the disc")
    offset: Quantity("m") = option("-4.5 mm", "contact off the middle of the tip, along sliding; a tilted tip touches"
                                   " with its edge")
    length: Quantity("m", gt=0) = option("0.5 mm", "length of the contact along sliding")
    width: Quantity("m", gt=0) = option("10 mm", "width of the contact across sliding")
    hard: bool = option(False, "contact that does not yield, instead of the interface law")


class Sensors(Section):
    """Accelerometer and laser point."""

    pin_side: Literal["outer", "upstream", "downstream"] = option("outer", "side of the pin with the accelerometer")
    pin_height: Quantity("m", gt=0) = option("50 mm", "height of the accelerometer above the tip, along the pin")
    disc_radius: Quantity("m", gt=0) = option("159 mm", "radius of the laser point on the disc")
    disc_angle: Quantity("rad") = option("180 deg", "its angle from the contact")


class Settings(Section):
    """Geometry, materials, supports, contact and loads."""

    disc: Disc = option(Disc(), "disc, hub and shaft")
    pin: Pin = option(Pin(), "pin, clamp and guide")
    contact: Contact = option(Contact(), "contact of tip and disc")
    sensors: Sensors = option(Sensors(), "sensors")
    loads: Quantities("kg", gt=0) = option(("1.5 kg",), "weights on the pin")
    lengths: Quantities("m", gt=0, le=0.2) = option(("146.5 mm", "151.5 mm", "181.5 mm"),
                                                    "free lengths of the pin whose own frequencies are compared")
    frequency_max: Quantity("Hz", gt=0) = option("15 kHz", "modes of the disc below it")


def _check(sections):
    """Refuse a drive that turns backwards under a heavy clamp: whether the pin locks is judged for forward sliding."""
    pin = sections["pin_on_disc"].pin
    if _light(pin):
        return
    speeds = {f"{name}.speeds": sections[name].speeds for name in ("complex_modes", "transient", "lock_in")
              if name in sections}
    speeds |= {"lock_in.speed": (sections["lock_in"].speed,)} if "lock_in" in sections else {}
    for name, values in speeds.items():
        if min(values, default=0.0) < 0:
            raise ConfigError(name, "speeds above 0, where a heavy clamp may lock the pin",
                              f"{min(values):.3g} rad/s with a base_mass of {pin.base_mass:g} kg",
                              "to slide the other way, change the signs of pin.tilt and contact.offset")


@stage(check=_check)
def pin_on_disc(interface_law: InterfaceLaw, settings: Settings, context: Context) -> PinOnDisc:
    """Mesh disc and pin, attach hub, clamp, guide and contact, and compute real modes.

    Method:
    Disc and pin were meshed with quadratic hexahedra. The disc is mounted on a rigid hub whose shaft is compliant in
    rocking; the pin is held in a clamp that moves normal to the disc on a frictionless guide, so that the weight is the
    static contact force. The normal and tangential contact laws follow from the interface law. Modes of the disc were
    computed below {frequency_max}.
    """
    model = build(settings)
    force = np.array(settings.loads) * _GRAVITY
    area = float(model.contacts.area[0])
    law = _law(interface_law, force / area, settings)
    _refuse_locking(model, settings, law["friction"].max(), context)
    disc = model.bodies[0]
    frequency, shape = held_modes(*disc.matrices(), disc.supported, context.solver, below=settings.frequency_max)
    diameters, out_of_plane = describe(disc.mesh.node, shape)
    return PinOnDisc(
        body_name=BODIES, disc=body_product(disc, frequency, shape), pin=body_product(model.bodies[1]),
        **assembly_fields(model), sensor_name=SENSORS, load=settings.loads, pressure=force / area,
        preload=force[:, None], closed=np.ones((len(force), 1), int), **law, disc_frequency=frequency,
        disc_diameters=diameters, disc_out_of_plane=out_of_plane, **_pin_modes(settings, context),
        tilt=settings.pin.tilt, contact_offset=settings.contact.offset, base_mass=settings.pin.base_mass,
        load_rows=incidence(model.load), load_area=area)


def _law(interface_law, pressure, settings):
    """Normal and tangential law of the contact, its normal stiffness and its friction at each pressure."""
    shear = TangentialLaw(interface_law.pressure, interface_law.friction, interface_law.tangential_stiffness,
                          interface_law.elastic_stiffness, interface_law.exponent)
    read = {f"shear_{f.name}": getattr(shear, f.name) for f in fields(shear)}
    read["friction"] = shear.at(pressure).friction
    area = settings.contact.length * settings.contact.width
    if settings.contact.hard:
        return {**read, "law_closure": [], "law_pressure": [], "contact_stiffness": np.zeros((len(pressure), 1))}
    thinned = slice(None, None, _LAW_STRIDE)
    closure, carried = contact_law(interface_law.gap_pressure[thinned], interface_law.normal_stiffness[thinned],
                                   interface_law.gap_pressure[-1])
    stiffness = [force_at_rest(np.interp([p], carried, closure), np.array([area]), closure, carried)[1]
                 for p in pressure]
    return {**read, "law_closure": closure, "law_pressure": carried, "contact_stiffness": stiffness}


def _light(p):
    """A clamp lighter than the pin gives way where the tip digs in."""
    return p.base_mass < p.density * p.side**2 * p.length


def _refuse_locking(model, settings, friction, context):
    """A clamp heavier than the pin holds still while the tip digs in."""
    p = settings.pin
    if p.tilt >= 0 or _light(p):
        return
    flexibility = sliding_flexibility(model, friction, context.solver)
    if flexibility <= 0:
        raise ConfigError("pin_on_disc.pin.tilt", f"a pin that slides: a tilt outside the friction cone of"
                          f" {np.degrees(np.arctan(friction)):.3g} deg, or trailing",
                          f"{np.degrees(p.tilt):.3g} deg against the motion, closing {flexibility:.3g} m/N: it locks",
                          "turn the pin the other way, or further, or lower the friction")


def _pin_modes(settings, context):
    """Own frequencies of the pin at the lengths compared, rigidly clamped."""
    lengths = (settings.pin.length, *settings.lengths)
    longer = [settings.model_copy(update={"pin": settings.pin.model_copy(update={"length": length})})
              for length in lengths]
    modes = context.map(partial(_clamped_pin, context.solver), longer, "real modes of the pin")
    return {"pin_length": lengths, "pin_frequency": modes}


def _clamped_pin(solver, settings):
    body = pin(settings)
    block = np.unique(body.mesh.element[body.element_material == body.material_name.index("clamp")])
    return held_modes(*body.matrices(), block, solver, count=_PIN_MODES)[0]
