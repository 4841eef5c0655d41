"""Contact under shear: full contact in closed form, the sliding cylinder, bodies that are alike."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.contact import coupled_compliance
from pipeline.physics.rough.contact.coupled_compliance import CoupledCompliance
from pipeline.physics.rough.contact.normal_contact import apply, interface_stiffness, solve_normal_contact
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import SurfaceCompliance, half_space_compliance

N, FRICTION, POISSON = 64, 0.6, 0.2
SPACING = (1.0, 1.0)
ROUGH = 0.5 * self_affine(np.random.default_rng(3), N, float(N), 8.0, 32.0, 0.8)


def on_rigid(poisson=POISSON, shape=(N, N)):
    """A half-space of modulus 1 that a rigid body rubs."""
    return half_space_compliance(shape, SPACING, 1.0, poisson)


def coupled(pair, sheared=lambda pressure: FRICTION * pressure):
    return CoupledCompliance(pair.normal, pair.lift, sheared)


@pytest.mark.exact
def test_full_contact():
    """Where all nodes touch and shear is a share of the pressure, p = p_mean - g / (C - mu L) at each wavenumber."""
    pair = on_rigid()
    wave = pair.normal - FRICTION * pair.lift
    wave[0, 0] = 1.0
    long = np.hypot(*np.meshgrid(np.fft.rfftfreq(N), np.fft.fftfreq(N))) < 0.2
    gap = 0.1 * np.fft.irfft2(np.fft.rfft2(ROUGH) * long)
    flattening = np.fft.rfft2(-gap) / wave
    exact = np.fft.irfft2(np.where(np.arange(N * (N // 2 + 1)).reshape(N, -1) == 0, 0.0, flattening))
    mean = -1.2 * exact.min()
    found = solve_normal_contact(gap, coupled(pair), mean, tolerance=1e-9)
    np.testing.assert_allclose(found.pressure, mean + exact, atol=1e-6 * exact.max())


@pytest.mark.exact
def test_sliding_cylinder():
    """p ~ (x - x1)^(1/2 - g) (x2 - x)^(1/2 + g), tan(pi g) = beta mu; the contact moves against the shear on the body
    that is not rigid (Johnson, Contact Mechanics, 1985, section 8.3; beta = (1 - 2 nu) / (2 (1 - nu)))."""
    nodes, radius = 4096, 1e5
    pair = on_rigid(0.0, (1, nodes))
    x = np.arange(nodes) - nodes / 2
    gap = (x**2 / (2 * radius))[None, :]
    found = solve_normal_contact(gap, coupled(pair), 2e-5, tolerance=1e-7).pressure[0]
    touching = x[found > 0]
    first, last = touching[0] - 0.5, touching[-1] + 0.5
    exponent = np.arctan(0.5 * FRICTION) / np.pi
    inside = np.clip(x - first, 0, None) ** (0.5 - exponent) * np.clip(last - x, 0, None) ** (0.5 + exponent)
    exact = inside * found.sum() / inside.sum()
    assert np.linalg.norm(found - exact) < 0.02 * np.linalg.norm(exact)
    assert (first + last) / (last - first) == pytest.approx(-2 * exponent, rel=0.1)


@pytest.mark.exact
def test_alike_bodies_do_not_lift_each_other():
    one = half_space_compliance((N, N), SPACING, 2.0, POISSON)
    alone = solve_normal_contact(ROUGH, (one + one).normal, 0.01)
    found = solve_normal_contact(ROUGH, coupled(one + one), 0.01)
    assert not np.any((one + one).lift)
    np.testing.assert_array_equal(found.pressure, alone.pressure)


def test_spots_at_their_shear_limit_settle():
    """A limit that is switched on where a node touches: area and stiffness within some percent of those without."""
    pair = on_rigid()
    limited = coupled(pair, lambda pressure: np.where(pressure > 0, 0.06, 0.0))
    found = solve_yielding_contact(ROUGH, limited, 0.01, tolerance=1e-4)
    alone = solve_yielding_contact(ROUGH, pair.normal, 0.01, tolerance=1e-4)
    touching, before = np.count_nonzero(found.pressure), np.count_nonzero(alone.pressure)
    assert 0.05 < before / N**2 < 0.5 and touching == pytest.approx(before, rel=0.05)
    assert np.abs(found.pressure - alone.pressure).max() > 0.05 * alone.pressure.max()
    stiffness = interface_stiffness(ROUGH, limited, found, 1e-4, 2000)
    assert stiffness == pytest.approx(interface_stiffness(ROUGH, pair.normal, alone, 1e-4, 2000), rel=0.15)
    left = ROUGH + apply(pair.normal, found.pressure) - apply(pair.lift, limited.sheared(found.pressure))
    left -= found.approach
    assert np.sqrt(np.mean(np.minimum(left, 0.0) ** 2)) < 5e-3 * ROUGH.std()


def test_what_does_not_settle_is_refused(monkeypatch):
    monkeypatch.setattr(coupled_compliance, "_ROUNDS", 2)
    with pytest.raises(ConvergenceError, match="under shear"):
        solve_normal_contact(ROUGH, coupled(on_rigid()), 0.01, tolerance=1e-9)


@pytest.mark.exact
def test_the_lift_of_a_point_is_that_of_cerruti():
    """Outwards -(1 - 2 nu) Q x / (4 pi G r^2) beside a force Q along x: a surface moves inwards in front of it."""
    shape, far = (512, 512), 32
    squared = np.add.outer(*2 * [np.minimum(np.arange(512), 512 - np.arange(512)) ** 2])
    traction = np.exp(-squared / 8.0)
    traction /= traction.sum()
    lift = apply(half_space_compliance(shape, SPACING, 1.0, POISSON).lift, traction)
    shear_modulus = 0.5 / (1 + POISSON)
    exact = -(1 - 2 * POISSON) / (4 * np.pi * shear_modulus * far)
    assert lift[0, far] == pytest.approx(exact, rel=0.03) and lift[0, -far] == pytest.approx(-exact, rel=0.03)


def test_compliance_is_told_with_its_lift():
    assert isinstance(on_rigid(), SurfaceCompliance) and on_rigid().lift[0, 0] == 0
