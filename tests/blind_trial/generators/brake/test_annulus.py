"""Waves of a clamped disc: against Kirchhoff's exact solution, Timoshenko's beam, and each other."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

from pipeline.blind_trial.generators.brake import annulus
from pipeline.physics.closed_form.timoshenko_cantilever import cantilever_frequencies
from tests.blind_trial.generators.imported import imported

PLATE = annulus.Disc(0.06, 0.1, 0.2, 0.0005, 0.0005, 1.15e11, 0.26, 7200.0)
BRAKE = annulus.Disc(0.05, 0.072, 0.155, 0.0095, 0.013, 1.15e11, 0.26, 7200.0)


def exact(disc, order):
    """Lowest frequency in Hz of a thin even annulus, clamped inside and free outside, from Bessel's functions.

    w = A J + B Y + C I + D K of k r, k^4 = rho h w^2 / D; at the rim M_r = 0 and V_r = 0 (A. W. Leissa, NASA SP-160
    (1969), equations 1.15 and 2.1).
    """
    n, v, inner, outer = order, disc.poisson, disc.hub, disc.rim
    bending = disc.young * disc.ring**3 / (12 * (1 - v**2))

    def mismatch(k):
        rows = np.zeros((4, 4))
        for c, (f, df, sign) in enumerate(((jv, jvp, -1), (yv, yvp, -1), (iv, ivp, 1), (kv, kvp, 1))):
            w, slope = f(n, k * outer), k * df(n, k * outer)
            curved = sign * k**2 * w        # its Laplacian, sign k^2 w everywhere
            moment = curved - (1 - v) * (slope / outer - n**2 * w / outer**2)
            shear = sign * k**2 * slope - (1 - v) * n**2 / outer**2 * (slope - w / outer)
            rows[:, c] = f(n, k * inner), k * df(n, k * inner), moment, shear
        return np.linalg.det(rows / np.abs(rows).max(axis=0))

    tried = np.linspace(0.5, 8.0, 400) / outer
    found = [mismatch(k) for k in tried]
    first = next(i for i in range(len(tried) - 1) if found[i] * found[i + 1] < 0)
    k = brentq(mismatch, tried[first], tried[first + 1])
    return k**2 * np.sqrt(bending / (disc.density * disc.ring)) / (2 * np.pi)


def test_it_uses_nothing_of_this_project():
    name = "pipeline.blind_trial.generators.brake.annulus"
    assert imported(name) == {name}


@pytest.mark.exact
@pytest.mark.parametrize("order", range(6))
def test_a_thin_plate_is_kirchhoffs(order):
    """Cubic cells fine enough, and the thick plate where it is thin (a 400th of its radius)."""
    wanted = exact(PLATE, order)
    assert annulus.thin(PLATE, order, 20).frequency[0] == pytest.approx(wanted, rel=2e-6)
    assert annulus.thick(PLATE, order).frequency[0] == pytest.approx(wanted, rel=3e-4)


@pytest.mark.exact
def test_cubic_cells_converge_with_the_fourth_power():
    """Frequencies of cubic finite elements err with h^4 (G. Strang, G. Fix 1973, section 6.3)."""
    wanted = exact(PLATE, 3)
    error = [annulus.thin(PLATE, 3, parts).frequency[0] / wanted - 1 for parts in (4, 8)]
    assert np.log2(error[0] / error[1]) == pytest.approx(4, abs=0.3) and 0 < error[1] < 2e-6


@pytest.mark.exact
def test_a_narrow_thick_ring_is_timoshenkos_cantilever():
    """Far from the axis waves without diameters bend a strip: E / (1 - v^2), 5/6 G."""
    far = annulus.Disc(1000.0, 1000.05, 1000.1, 0.02, 0.02, 1.15e11, 0.26, 7200.0)
    wanted = cantilever_frequencies(0.1, 0.02, 0.02**3 / 12, far.young / (1 - far.poisson**2),
                                    annulus.SHEAR * far.young / (2 + 2 * far.poisson) * 0.02, far.density, 2e4)
    np.testing.assert_allclose(annulus.thick(far, 0).frequency[:len(wanted)], wanted, rtol=1e-4)


@pytest.mark.exact
def test_a_finer_thick_disc_is_the_same_and_a_thin_one_is_stiffer():
    for order in (0, 2, 5):
        frequency = annulus.thick(BRAKE, order).frequency
        np.testing.assert_allclose(annulus.thick(BRAKE, order, 3, 9).frequency[:3], frequency[:3], rtol=1e-6)
        assert 1 < annulus.thin(BRAKE, order).frequency[0] / frequency[0] < 1.06


@pytest.mark.exact
@pytest.mark.parametrize("make, within", [(annulus.thin, 1e-9), (annulus.thick, 1e-3)])
def test_modes_have_a_mass_of_1_kg(make, within):
    """pi int rho h W^2 r dr; the rest of a thin one's thick sister is what turns."""
    place, weight = np.polynomial.legendre.leggauss(60)
    edges, thickness = PLATE.edges(2)
    radius = np.concatenate([(a + b) / 2 + (b - a) / 2 * place for a, b in zip(edges[:-1], edges[1:], strict=True)])
    share = np.concatenate([(b - a) / 2 * weight * h for a, b, h in zip(edges[:-1], edges[1:], thickness, strict=True)])
    shape = make(PLATE, 2).at(radius)[0][:, 0]
    assert np.pi * PLATE.density * np.sum(share * radius * shape**2) == pytest.approx(1, rel=within)


@pytest.mark.exact
def test_turns_follow_the_slope_of_a_thin_plate():
    radius = np.array([0.09, 0.15, 0.19])
    thin, thick = annulus.thin(PLATE, 3, 20).at(radius), annulus.thick(PLATE, 3).at(radius)
    sign = np.sign(thin[0][0, 0] * thick[0][0, 0])
    for one, other in zip(thin, thick, strict=True):
        np.testing.assert_allclose(sign * other[:, 0], one[:, 0], rtol=1e-3)
    np.testing.assert_allclose(thin[1], 3 * thin[0] / radius[:, None])


def test_waves_scale_with_the_square_root_of_stiffness_over_mass():
    stiffer = replace(BRAKE, young=1.21 * BRAKE.young)
    np.testing.assert_allclose(annulus.thick(stiffer, 1).frequency, 1.1 * annulus.thick(BRAKE, 1).frequency)
    assert len(annulus.thick(BRAKE, 1).first(2).frequency) == 2
