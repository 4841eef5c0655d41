"""Contact that stiffens with pressure: p = p_b (p_b / p_0)^a, p_b the pressure of the nominal law, p_0 a reference.

a = 1 is the elastic foundation turned into a quadratic law, a = 1/2 Hertz's; at p_0 the pressure stays as it was.
"""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.simulate import Penalty, Table

#: pressures that the table spans above the reference, and its samples
_SPAN, _SAMPLES = 100.0, 400


def parameters(typical):
    return (Parameter("exponent", "1", 0.3, HalfNormal(0.5), null=0.0),
            Parameter("pressure", "Pa", typical.pressure, LogNormal(typical.pressure, 0.3)))


def apply(bench, location, values):
    if values["exponent"] == 0:
        return bench
    members, area = bench.contacts(location), bench.model.contacts.area

    def steeper(law):
        closure, pressure = _table(law, members, area, values["pressure"])
        speed = law.damping_speed if isinstance(law, Table) else np.inf
        return Table(closure, pressure * (pressure / values["pressure"]) ** values["exponent"], speed, law.gap, True)

    return bench.with_law(location, steeper)


def _table(law, members, area, reference):
    """(closure, pressure) of the nominal law, finely sampled from 0 to far beyond the reference pressure."""
    if isinstance(law, Table):
        closure, pressure = np.asarray(law.closure, float), np.asarray(law.pressure, float)
    elif isinstance(law, Penalty):
        each = (np.broadcast_to(law.stiffness, len(area)) / area)[members]
        if np.ptp(each) > 1e-9 * each[0] or np.broadcast_to(law.damping, len(area))[members].any():
            raise ConfigError("effect contact_stiffness_law", "contacts of one stiffness per area, without damping",
                              "others", "give the contacts a table")
        closure, pressure = np.array([0.0, 1.0]), np.array([0.0, each[0]])
    else:
        raise ConfigError("effect contact_stiffness_law", "contacts that yield", type(law).__name__)
    last = (pressure[-1] - pressure[-2]) / (closure[-1] - closure[-2])
    wanted = _SPAN * reference * np.linspace(0, 1, _SAMPLES) ** 3
    beyond = np.maximum(wanted - pressure[-1], 0.0) / last
    return np.interp(wanted, pressure, closure) + beyond, wanted


EFFECT = Effect(
    name="contact_stiffness_law", summary="contacts whose stiffness changes with pressure", location="pressed contact",
    stage="contact", parameters=parameters, apply=apply,
    family="nonlinear stiffness",
    source="K. Willner, L. Gaul, Proc. Contact Mechanics II (1995); J. A. Greenwood, J. B. P. Williamson (1966)",
    valid="Valid to a hundred times the reference pressure, beyond which the last slope goes on.")
