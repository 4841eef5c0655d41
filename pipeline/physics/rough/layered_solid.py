"""Surface compliance of an elastic block, one wavenumber at a time.

A laterally periodic block of hex8 layers has a block-circulant stiffness: the DFT splits it into independent chains of
layers. Eliminating the layers from the clamped base upwards (a Schur complement per wavenumber) leaves the 3 x 3
surface stiffness of the finite-element model itself: static condensation without a dense matrix and without error.

Arrays over wavenumbers follow ``numpy.fft.rfft2`` of maps (y, x): shape (ny, nx // 2 + 1).
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.layer_element import brick_stiffness


@dataclass(frozen=True)
class SurfaceCompliance:
    """Surface displacement per traction in m/Pa, each (ny, nx // 2 + 1); compliances of two bodies add up.

    ``normal`` serves the normal contact; ``along`` (xx), ``across`` (yy) and ``cross`` (xy) the shear; ``lift`` (zx,
    imaginary) is how far the surface moves outwards by shear along x. The body added to one faces it: it is sheared the
    other way, so that ``lift`` of both is their difference, none where they are alike.
    """

    normal: np.ndarray
    along: np.ndarray
    across: np.ndarray
    cross: np.ndarray
    lift: np.ndarray

    def __add__(self, other):
        return SurfaceCompliance(self.normal + other.normal, self.along + other.along,
                                 self.across + other.across, self.cross + other.cross, self.lift - other.lift)


def graded_depth(first, thickness, growth):
    """Layer boundaries (layers + 1,) in m from 0 to ``thickness``: layers grow by ``growth`` from about ``first``."""
    if not 0.0 < first <= thickness or growth < 1.0:
        raise ConfigError("layered solid", "0 < first layer <= thickness and growth >= 1",
                          f"first layer {first:g} m, thickness {thickness:g} m, growth {growth:g}")
    layers, total = 1, first
    while total < thickness:
        total += first * growth ** layers
        layers += 1
    boundaries = np.concatenate([[0.0], np.cumsum(growth ** np.arange(layers))])
    return boundaries * (thickness / boundaries[-1])


def layered_compliance(shape, spacing, depth, youngs_modulus, poisson_ratio):
    """SurfaceCompliance of a block on a rigid base.

    ``shape`` (ny, nx) surface nodes, ``spacing`` (dy, dx) in m, ``depth`` (layers + 1,) layer boundaries in m from 0
    at the surface to the clamped base, ``youngs_modulus`` in Pa.
    """
    below = None
    for layer in layer_symbols(shape, spacing, depth[::-1], youngs_modulus, poisson_ratio):
        top, coupling, bottom = layer[..., :3, :3], layer[..., :3, 3:], layer[..., 3:, 3:]
        clamped = below is None
        below = top if clamped else top - coupling @ np.linalg.solve(bottom + below, layer[..., 3:, :3])
    compliance = np.linalg.inv(below) * (spacing[0] * spacing[1])
    normal, along, across, cross = (compliance[..., i, j].real.copy() for i, j in ((2, 2), (0, 0), (1, 1), (0, 1)))
    return SurfaceCompliance(normal, along, across, cross, 1j * compliance[..., 2, 0].imag)


def layer_symbols(shape, spacing, depth, youngs_modulus, poisson_ratio):
    """Yield the stiffness (ny, nx // 2 + 1, 6, 6) in N/m of each layer between boundaries ``depth``, in their order, at
    every wavenumber: upper face x y z, lower face x y z; arguments as of ``layered_compliance``."""
    phases = _phases(shape)
    for thickness in abs(np.diff(depth)):
        yield _symbol(brick_stiffness((spacing[1], spacing[0], thickness), youngs_modulus, poisson_ratio), phases)


def half_space_compliance(shape, spacing, youngs_modulus, poisson_ratio):
    """SurfaceCompliance of a homogeneous half-space; its uniform part (wavenumber 0) is left out, i.e. zero.

    Source: Johnson, Contact Mechanics (1985), section 2 and 3; in Fourier space normal (1 - nu) / (G k), tangential
    (1 - nu kx^2 / k^2) / (G k), outwards by shear i (1 - 2 nu) kx / (2 G k^2).
    """
    wave_y = 2 * np.pi * np.fft.fftfreq(shape[0], spacing[0])[:, None]
    wave_x = 2 * np.pi * np.fft.rfftfreq(shape[1], spacing[1])[None, :]
    wave = np.hypot(wave_y, wave_x)
    wave[0, 0] = np.inf
    base = 2.0 * (1.0 + poisson_ratio) / (youngs_modulus * wave)
    return SurfaceCompliance((1.0 - poisson_ratio) * base, base * (1.0 - poisson_ratio * (wave_x / wave) ** 2),
                             base * (1.0 - poisson_ratio * (wave_y / wave) ** 2),
                             -base * poisson_ratio * wave_x * wave_y / wave ** 2,
                             0.5j * (1.0 - 2.0 * poisson_ratio) * base * wave_x / wave)


def _phases(shape):
    """Phase factors (ny, nx // 2 + 1, 9) of a step of 0, 1, -1 nodes along x, then along y."""
    steps = np.array([0, 1, -1])
    phase_y = np.exp(2j * np.pi * np.outer(np.fft.fftfreq(shape[0]), steps))
    phase_x = np.exp(2j * np.pi * np.outer(np.fft.rfftfreq(shape[1]), steps))
    return (phase_x[None, :, :, None] * phase_y[:, None, None, :]).reshape(shape[0], -1, 9)


def _symbol(element, phases):
    """Layer stiffness (ny, nx // 2 + 1, 6, 6): upper face x y z, lower face x y z."""
    steps = np.zeros((3, 3, 2, 3, 2, 3))
    for a, b, a_other, b_other in product((0, 1), repeat=4):
        steps[a_other - a, b_other - b] += element[a, b, :, :, a_other, b_other]
    return (phases @ steps.reshape(9, 36).astype(complex)).reshape(*phases.shape[:2], 6, 6)
