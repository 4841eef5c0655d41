"""What makes a mode grow: its growth rate as a sum over friction, contacts and damping, and the bodies that move.

A root s = sigma + i w of M x'' + C x' + K x = 0 and its vector x obey x^H (s^2 M + s C + K) x = 0, so that

    sigma = - sum_j Im(s x^H C_j x + x^H K_j x) / (2 w x^H M x),

a sum over the parts C_j and K_j of the matrices. Symmetric stiffnesses contribute nothing, dampers what they dissipate,
friction what it feeds in.
"""

import numpy as np

#: terms beside those of the friction at the contacts of each body, in order
CONTACT, TURNING, SLIP = "contact damping", "friction turning with the slip", "friction over slip speed"
BODIES = "bodies and joints"


def growth_terms(model, friction, root, shape, contact_body, friction_damping=True):
    """{term: part of the growth rate in 1/s} of a root of a SlidingModel linearised about steady sliding.

    ``friction`` FrictionState or coefficient; ``shape`` (n,) complex; ``contact_body`` (c,): the friction of the
    contacts of each body is a term, 'friction at <body>'. What all of them leave of the growth rate is that of bodies
    and joints, so that the terms add up to it.
    """
    contacts, coefficient = model.contacts, getattr(friction, "coefficient", friction)
    inertia = 2 * root.imag * (shape.conj() @ model.mass @ shape).real
    normal, tangent, lateral = (rows @ shape for rows in (contacts.normal, contacts.tangent, contacts.lateral))
    slopes = (getattr(friction, name, 0.0) for name in ("pressure_slope", "speed_slope"))
    by_pressure, by_speed = slopes
    coupling = model.direction() * (coefficient + contacts.pressure * by_pressure)
    drawn = tangent.conj() * coupling * (contacts.stiffness + root * contacts.damping) * normal
    terms = {f"friction at {model.body_name[body]}": -drawn[contact_body == body].sum().imag / inertia
             for body in np.unique(contact_body)}
    rate = root.imag / inertia
    terms[CONTACT] = -rate * (contacts.damping @ abs(normal) ** 2)
    terms[TURNING] = -rate * (turning_drag(model, coefficient) @ abs(lateral) ** 2) if friction_damping else 0.0
    terms[SLIP] = -rate * ((contacts.preload * by_speed) @ abs(tangent) ** 2)
    terms[BODIES] = root.real - sum(terms.values())
    return {name: float(value) for name, value in terms.items()}


def turning_drag(model, coefficient):
    """mu N0 / |v| (c,) N s/m of friction-induced damping; 0 where a contact does not slide."""
    speed = abs(model.sliding_speed)
    force = coefficient * model.contacts.preload
    return np.divide(force, speed, out=np.zeros(len(speed)), where=speed > 0)


def body_shares(model, shape):
    """(b,) share of the kinetic energy of the motion ``shape`` (n,) in each body of a SlidingModel."""
    moved = (shape.conj() * (model.mass @ shape)).real
    energy = np.bincount(model.coordinate_body, moved, len(model.body_name))
    return energy / energy.sum()
