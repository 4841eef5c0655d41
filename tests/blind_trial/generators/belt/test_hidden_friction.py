"""Friction hidden in a contact: nothing at size 0, and told values that give it in the equations that others use."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.belt.hidden_friction import FRICTION, Contact, Rubbed, plain
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical

CONTACT, RUN = Contact(0.3, 0.01, 8.0, 5.0, (0.3, 0.6, 0.9)), Rubbed(0.25, 12.0, 0.7)
V, X = 0.2, 0.004
#: factor on mu N at the slip V under RUN, by the equations of the catalogue with told values
FACTOR = {
    "falling_friction": lambda p: 1 + p["rise"] * np.exp(-V / p["decay_speed"]),
    "directional_friction": lambda p: 1 + p["asymmetry"], "viscous": lambda p: 1 + p["slope"] * V,
    "pressure_dependent_friction": lambda p: 1.5 ** -p["exponent"], "moisture": lambda p: 1 + 0.2 * p["slope"],
    "contact_ageing": lambda p: 1 + p["share"] * np.log(2), "friction_over_distance": lambda p: 1 + p["rise"],
    "thermal_fade": lambda p: 1.0, "third_body_film": lambda p: 1.0, "plateau_dynamics": lambda p: 1.2,
}


@pytest.mark.exact
@pytest.mark.parametrize("name", FACTOR)
def test_told_values_give_the_force(name):
    drag = FRICTION[name].build(CONTACT, 0.2)
    told = FRICTION[name].tell(CONTACT, 0.2)
    assert drag.force(RUN, V, X, np.zeros(drag.states)) == pytest.approx(0.25 * 12 * FACTOR[name](told), rel=1e-6)


@pytest.mark.exact
def test_what_the_workshop_knows_is_coulomb():
    assert plain(CONTACT).force(RUN, V, X, ()) == pytest.approx(3.0)
    assert plain(CONTACT).force(RUN, -V, X, ()) == pytest.approx(-3.0)


@pytest.mark.parametrize("name", [n for n in FRICTION if n != "micro_slip"])
def test_without_size_it_is_what_the_workshop_knows(name):
    drag = FRICTION[name].build(CONTACT, 0.0)
    for slip in (V, -V):
        known = plain(CONTACT).force(RUN, slip, X, ())
        assert drag.force(RUN, slip, X, np.zeros(drag.states)) == pytest.approx(known, rel=1e-4)


@pytest.mark.exact
def test_micro_slip_builds_up_friction_over_the_way():
    """T = mu N (1 - exp(-s / (c mu N))) from rest, c scaled by the load (Allgaier and others 1999, m = 1)."""
    drag, told = FRICTION["micro_slip"].build(CONTACT, 0.2), FRICTION["micro_slip"].tell(CONTACT, 0.2)["compliance"]
    step, z = 1e-5, np.zeros(1)
    for _ in range(1000):
        z = z + step * drag.rates(RUN, V, drag.force(RUN, V, X, z), z)
    way, limit = 1000 * step * V, 3.0
    assert z[0] == pytest.approx(limit * (1 - np.exp(-way / (told * CONTACT.load / RUN.load * limit))), rel=1e-2)


@pytest.mark.exact
@pytest.mark.parametrize("name", ["contact_ageing", "plateau_dynamics", "thermal_fade", "third_body_film"])
def test_states_settle_where_their_source_and_loss_meet(name):
    """theta = L / |v|; x = (1 + k) / (1 + k P); x = heat; x = p / p_0: each in its own units."""
    size = 0.2
    drag, z = FRICTION[name].build(CONTACT, size), np.zeros(1)
    for _ in range(20000):
        z = z + 5e-3 * drag.rates(RUN, V, drag.force(RUN, V, X, z), z)
    power = RUN.load * V / (CONTACT.load * CONTACT.speed)
    settled = {"contact_ageing": 1 + size * np.log1p(CONTACT.speed / V),
               "plateau_dynamics": (1 + size) / (1 + size * power), "third_body_film": 1 + size * 1.5}
    settled["thermal_fade"] = (np.sqrt(1 + 4 * size * 0.25 * power / 0.3) - 1) / (2 * size * 0.25 * power / 0.3)
    assert drag.force(RUN, V, X, z) == pytest.approx(3.0 * settled[name], rel=1e-3)


def test_names_are_those_of_the_catalogue_but_for_what_it_lacks():
    for piece in FRICTION.values():
        effect = next((e for e in CATALOGUE if e.name == piece.name), None)
        assert (effect is not None) == piece.known
        known = {p.name for p in effect.parameters(Typical())} if effect else set()
        assert set(piece.tell(CONTACT, 0.1)) <= known
    assert sum(not piece.known for piece in FRICTION.values()) >= 3
