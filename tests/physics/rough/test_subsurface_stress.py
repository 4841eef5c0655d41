"""Stress under Hertz contacts in closed form: pressed sphere, sliding cylinder, uniform load."""

import numpy as np
import pytest

from pipeline.physics.closed_form import hertz
from pipeline.physics.rough.subsurface_stress import stress_at, von_mises

NODES, RADIUS, SPACING = 256, 24.0, (1.0, 1.0)


@pytest.fixture(scope="module")
def sphere():
    """Hertz pressure of a sphere in the middle, its peak 1."""
    position = np.arange(NODES) - NODES // 2
    load = 2 * np.pi * RADIUS**2 / 3
    pressure = hertz.pressure(np.hypot(position[:, None], position), load, 4 / 3 * RADIUS**3 / load, 1.0)
    return pressure / pressure.max()


@pytest.mark.exact
def test_under_a_pressed_sphere(sphere):
    """On the axis s_z = -1 / (1 + z^2 / a^2), s_r = -s_z / 2 - (1 + nu) (1 - z / a atan(a / z)) (Johnson, equation
    3.45); von Mises is greatest, .620 of the peak pressure, at .481 a for nu = .3."""
    middle, found = NODES // 2, []
    for depth in np.linspace(0.1, 1.2, 45) * RADIUS:
        stress = stress_at(depth, sphere, np.zeros_like(sphere), SPACING, 0.3)
        at, z = stress[:, middle, middle], depth / RADIUS
        axial = -1 / (1 + z**2)
        radial = -axial / 2 - 1.3 * (1 - z * np.arctan(1 / z))
        np.testing.assert_allclose(at[[2, 0, 1]], [axial, radial, radial], atol=0.02)
        np.testing.assert_allclose(at[3:], 0, atol=1e-3)
        found.append(von_mises(stress).max())
    assert max(found) == pytest.approx(0.620, abs=0.01)
    assert np.linspace(0.1, 1.2, 45)[np.argmax(found)] == pytest.approx(0.481, abs=0.03)


@pytest.mark.exact
def test_on_the_surface_behind_a_sliding_cylinder():
    """Shear q0 sqrt(1 - x^2 / a^2) stretches the surface behind it by 2 q0 (Johnson, equation 7.7), antiplane shear
    does not; pressure makes s_x = s_z there."""
    x = np.arange(4096) - 2048.0
    push = np.sqrt(np.maximum(1 - (x / 200) ** 2, 0))[None, :]
    stress = stress_at(0.0, 0 * push, 0.3 * push, (1.0, 1.0), 0.25)[:, 0]
    inside = abs(x) < 180
    np.testing.assert_allclose(stress[0, inside], -0.6 * x[inside] / 200, atol=0.01)
    assert x[stress[0].argmax()] == pytest.approx(-200, abs=3) and stress[0].max() == pytest.approx(0.6, abs=0.02)
    np.testing.assert_allclose(stress[4], -0.3 * push[0], atol=1e-9)
    pressed = stress_at(0.0, push, 0 * push, (1.0, 1.0), 0.25)[:, 0]
    np.testing.assert_allclose(pressed[0, inside] - pressed[0].mean(), pressed[2, inside] + push.mean(), atol=1e-6)
    turned = stress_at(30.0, 0 * push.T, push.T, (1.0, 1.0), 0.25)[:, :, 0]
    np.testing.assert_allclose(turned[[0, 1, 2, 3]], 0, atol=1e-9)        # a line along the shear: antiplane


@pytest.mark.exact
def test_uniform_tractions_are_carried_down_as_by_an_oedometer():
    stress = stress_at(50.0, np.full((4, 4), 3.0), np.full((4, 4), 0.5), SPACING, 0.25)[:, 2, 1]
    np.testing.assert_allclose(stress, [-1, -1, -3, 0, -0.5, 0], atol=1e-12)


@pytest.mark.exact
def test_forces_balance_at_every_depth():
    """What acts on the surface acts on every plane below it; d s_xz / dz = - d s_xx / dx - d s_xy / dy."""
    random = np.random.default_rng(1)
    wave = np.hypot(*np.meshgrid(np.fft.rfftfreq(32), np.fft.fftfreq(32)))
    pressure, shear = (np.fft.irfft2((wave < 0.2) * np.fft.rfft2(random.standard_normal((32, 32)))) for _ in range(2))
    above, here, below = (stress_at(z, pressure, shear, SPACING, 0.3) for z in (1.999, 2.0, 2.001))
    ky, kx = 2j * np.pi * np.fft.fftfreq(32)[:, None], 2j * np.pi * np.fft.rfftfreq(32)[None, :]
    for z, x, y in ((2, 4, 3), (4, 0, 5), (3, 5, 1)):
        sideways = np.fft.irfft2(kx * np.fft.rfft2(here[x]) + ky * np.fft.rfft2(here[y]))
        np.testing.assert_allclose((below[z] - above[z]) / 0.002, -sideways, atol=1e-5)
