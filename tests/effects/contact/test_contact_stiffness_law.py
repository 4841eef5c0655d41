"""Contacts that stiffen."""

import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.response import respond
from tests.effects.benches import slider, steady, tabled


@pytest.mark.exact
@pytest.mark.parametrize("law", [None, tabled()])
@pytest.mark.parametrize("load", [5.0, 40.0, 400.0])
def test_closure_under_a_load(law, load):
    """p = p_b (p_b / p_0)^a with p_b = k c / A: c = (p p_0^a)^(1 / (1 + a)) A / k."""
    bench = named("contact_stiffness_law").on(slider(law), "contact", {"exponent": 0.5, "pressure": 4e4})
    closure = (load / 1e-3 * 4e4**0.5) ** (1 / 1.5) * 1e-3 / 2e4
    assert -respond(bench, steady(load))["y"][-1] == pytest.approx(closure, rel=1e-3)


def test_contacts_that_do_not_yield_are_refused():
    with pytest.raises(ConfigError, match="that yield"):
        named("contact_stiffness_law").on(slider(Hard()), "contact", {"exponent": 0.5, "pressure": 4e4})
