"""Friction from rest: Mindlin's curve of one spot, its stiffness at rest, and that of rough surfaces."""

import numpy as np
import pytest

from pipeline.physics.closed_form import cattaneo_mindlin, hertz
from pipeline.physics.rough.contact.normal_contact import interface_stiffness, solve_normal_contact
from pipeline.physics.rough.contact.partial_slip import presliding
from pipeline.physics.rough.contact.shear_limit import full_slip_displacement
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import half_space_compliance

SHARES = np.array([0.2, 0.4, 0.6, 0.8, 1.0])


@pytest.mark.exact
def test_one_spot_gives_mindlins_curve():
    """Of spots that repeat, displacements are those of one less a part in proportion to the load: their neighbours'."""
    nodes, radius = 128, 26.0
    position = np.arange(nodes) - nodes // 2
    pressure = hertz.pressure(np.hypot(position[:, None], position), 4 * radius**3 / 1500, 500.0, 1.0)
    found = presliding(0.4 * pressure, half_space_compliance((nodes, nodes), (1.0, 1.0), 1.0, 0.0), SHARES, 1e-6)
    limit = 0.4 * pressure.sum()
    alone = 3 * limit * 2 / (16 * 0.5 * radius)
    load = found.shear * nodes**2
    neighbours = (alone - found.displacement[-1]) / limit
    exact = cattaneo_mindlin.tangential_load((found.displacement + neighbours * load) / alone, 1.0, limit)
    assert 0 < neighbours * limit < 0.5 * alone
    np.testing.assert_allclose(load, exact, rtol=0.02)
    assert 1 / (1 / found.stiffness / nodes**2 + neighbours) == pytest.approx(1.5 * limit / alone, rel=0.02)


@pytest.mark.exact
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_at_rest_it_is_as_stiff_along_as_mindlin_says(poisson):
    """Tangential over normal stiffness of an interface: (1 - nu) / (1 - nu / 2), whatever its spots (Campana, Persson &
    Mueser, J. Phys.: Condens. Matter 23 (2011) 085001); beside a wave of shorter spots within some percent."""
    nodes = 128
    rough = 0.3 * self_affine(np.random.default_rng(5), nodes, float(nodes), 16.0, 32.0, 0.8)
    compliance = half_space_compliance((nodes, nodes), (1.0, 1.0), 1.0, poisson)
    contact = solve_normal_contact(rough, compliance.normal, 0.002)
    normal = interface_stiffness(rough, compliance.normal, contact, 1e-6, 2000)
    limit = np.where(contact.pressure > 0, 0.02, 0.0)
    found = presliding(limit, compliance, SHARES, 1e-5)
    assert 0.02 < np.mean(contact.pressure > 0) < 0.3
    assert found.stiffness / normal == pytest.approx((1 - poisson) / (1 - poisson / 2), rel=0.05)
    assert np.all(np.diff(found.shear) > 0) and found.shear[-1] == pytest.approx(limit.mean(), rel=1e-3)
    assert found.displacement[-1] == pytest.approx(full_slip_displacement(limit, compliance), rel=1e-12)
