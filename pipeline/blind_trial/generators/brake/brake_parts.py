"""Parts of the practice brake: a disc between two pads under a floating caliper, as matrices and rows.

The disc bends as a thick stepped plate (``annulus.thick``): modes of all orders up to 10 below 25 kHz. Each pad is
rigid, slides along (x), opens (u) and pitches (f) on its abutment; fingers hold the outer one to the caliper (z), a
piston presses the inner one. At the angle t and the radius r a pad opens by

    u + r sin(t) f - side w,      and moves along the disc by      x + height f - side thickness / 2 p_t,

side 1 of the outer and -1 of the inner pad, read at 40 points of Gauss over its face.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from pipeline.blind_trial.generators.brake.annulus import Disc, Waves, thick

#: discs that are drawn: hub, step, rim, web, ring in m
SHAPES = ((0.050, 0.072, 0.155, 0.0095, 0.0130), (0.048, 0.068, 0.148, 0.0085, 0.0120),
          (0.052, 0.076, 0.160, 0.0105, 0.0140))
#: what the drawings say: Pa, kg/m^3, 1; N/m of a lining along its normal and along sliding, and of joints
NOMINAL = {"young": 115e9, "density": 7200.0, "contact": 3e7, "shear": 1.6e7, "friction": 0.35, "abutment_outer": 3e7,
           "abutment_inner": 2.4e7, "fingers": 6e7}
#: damping ratio of the waves of a disc; its Poisson ratio, highest order and frequency in Hz
LOSS, POISSON, ORDERS, HIGHEST = 0.002, 0.26, 10, 25e3
#: weighed: pads and caliper in kg, pitch of a pad in kg m^2; height of its middle over its face
PAD, PITCH, CALIPER, HEIGHT = 0.4, 3.2e-4, 4.0, 0.012
#: pads: half their angle, their width and their distance from the rim in m; points along and across them
HALF_ANGLE, WIDTH, INSET, POINTS = np.radians(22.0), 0.044, 0.006, (10, 4)
#: known joints: seal of the piston, guide of the caliper N/m, N s/m; clips that hold the pitch of a pad N m, N m s
SEAL, GUIDE, CLIP = (2e5, 20.0), (1e5, 50.0), (60.0, 0.01)
ABUTMENT_LOSS, FINGER_LOSS = 120.0, 60.0
#: angles of the lasers on the disc and of the tap, their distance from the rim; what is seen of (x, u, f) of a pad
LASERS, TAPPED, LASER_INSET = tuple(np.radians((100.0, 157.0, 221.0))), np.radians(130.0), 0.01
ON_PAD = (0.6, 0.8, 0.03)
PADS = ("outer", "inner")


@dataclass(frozen=True)
class Brake:
    """Matrices (n, n) of the parts in modes of the disc, (x, u, f) of the outer pad, of the inner one, and z.

    ``normal`` and ``tangent`` (c, n) of the points of the linings, ``share`` (c,) of the face of their pad, ``radius``
    (c,) m; rows of ``sensors`` (s, n), ``taps`` (h, n) and the piston, ``press`` (n,) a N; ``disc`` modes are the first
    coordinates; ``values`` as NOMINAL, ``hidden`` {physics: values}.
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    share: np.ndarray
    radius: np.ndarray
    sensors: np.ndarray
    taps: np.ndarray
    press: np.ndarray
    disc: int
    values: dict
    hidden: dict

    def with_joint(self, row, stiffness, damping):
        """The brake with one more spring (N/m) and damper (N s/m) along ``row`` (n,)."""
        square = np.outer(row, row)
        return replace(self, stiffness=self.stiffness + stiffness * square, damping=self.damping + damping * square)

    def with_coordinate(self, mass):
        """The brake with one more coordinate, of this mass, that nothing holds."""
        rows = {name: np.pad(getattr(self, name), ((0, 0), (0, 1)))
                for name in ("normal", "tangent", "sensors", "taps")}
        square = {name: np.pad(getattr(self, name), (0, 1)) for name in ("mass", "damping", "stiffness")}
        square["mass"][-1, -1] = mass
        return replace(self, **rows, **square, press=np.append(self.press, 0.0))


@dataclass(frozen=True)
class _Family:
    """Waves of one order around the disc: w goes with ``wave`` (cos or sin) and its turn with ``turned``.

    ``squared`` (m,) rad^2/s^2, ``loss`` (m,) damping ratios, ``size`` (m,) of a wave of modal mass 1 kg over its own.
    """

    waves: Waves
    squared: np.ndarray
    loss: np.ndarray
    size: np.ndarray
    wave: object
    turned: object


def built(values, shape, scale=None, hidden=None):
    """The Brake of ``values`` (those of NOMINAL, and loss_N of the waves of order N) and one of SHAPES.

    ``scale`` {(frequency, mass or damping, order): factor} of the first wave of an order. Other pads than PAD have
    ``values["pad"]`` kg, of the same shape.
    """
    families = _families(Disc(*shape, values["young"], POISSON, values["density"]), values, scale or {})
    squared, loss = (np.concatenate([getattr(family, name) for family in families]) for name in ("squared", "loss"))
    disc, laser = len(squared), shape[2] - LASER_INSET
    pads = np.zeros((2, disc + 7))
    pads[0, disc:disc + 3] = pads[1, disc + 3:disc + 6] = ON_PAD
    struck, *seen = (np.pad(_seen(families, np.array([angle]), np.array([laser]))[0], ((0, 0), (0, 7)))
                     for angle in (TAPPED, *LASERS))
    press, none, heavier = np.zeros(disc + 7), np.zeros(7), values.get("pad", PAD) / PAD
    press[[disc + 4, disc + 6]] = -1.0
    pads_mass = heavier * np.array((PAD, PAD, PITCH, PAD, PAD, PITCH))
    brake = Brake(np.diag(np.concatenate((np.ones(disc), pads_mass, (CALIPER,)))),
                  np.diag(np.append(2 * loss * np.sqrt(squared), none)), np.diag(np.append(squared, none)),
                  *_linings(families, shape, disc), np.vstack((*seen, pads[[0, 0, 1]])), np.vstack((struck, pads)),
                  press, disc, values, hidden or {})
    for weights, stiffness, damping in _joints(values):
        brake = brake.with_joint(np.append(np.zeros(disc), weights), stiffness, damping)
    return _with_hidden(brake, families)


def _families(plate, values, scale):
    """[_Family] of the cosines and sines of all orders."""
    families = []
    for order in range(ORDERS + 1):
        waves = _thick(plate, order)
        waves = waves.first(max(1, int(np.sum(waves.frequency < HIGHEST))))
        squared, size = waves.squared.copy(), np.ones(len(waves.squared))
        loss = np.full(len(squared), values.get(f"loss_{order}", LOSS))
        squared[0] *= scale.get(("frequency", order), 1.0) ** 2
        size[0] /= np.sqrt(scale.get(("mass", order), 1.0))
        loss[0] *= scale.get(("damping", order), 1.0)
        around = (np.cos, np.sin), (np.sin, lambda angle: -np.cos(angle))
        families += [_Family(waves, squared, loss, size, *pair) for pair in around[:1 + (order > 0)]]
    return families


@lru_cache(maxsize=64)
def _thick(plate, order):
    return thick(plate, order)


def _seen(families, angle, radius):
    """(w, p_t), each (points, modes), of the disc at points of these angles and radii."""
    rings, ring = np.unique(radius, return_inverse=True)
    deflection, turn = [], []
    for family in families:
        w, p = (part[ring] * family.size for part in family.waves.at(rings))
        deflection.append(w * family.wave(family.waves.order * angle)[:, None])
        turn.append(p * family.turned(family.waves.order * angle)[:, None])
    return np.hstack(deflection), np.hstack(turn)


def _linings(families, shape, disc):
    """(normal, tangent, share, radius) of the points of the outer pad, then of the inner one."""
    (along, weight_along), (across, other) = (legendre.leggauss(count) for count in POINTS)
    radius = shape[2] - INSET - WIDTH / 2 * (1 - across)
    t, r = (grid.ravel() for grid in np.meshgrid(HALF_ANGLE * along, radius, indexing="ij"))
    share = np.outer(weight_along, other * radius).ravel()
    deflection, turn = _seen(families, t, r)
    normal, tangent = np.zeros((2, 2, len(t), disc + 7))
    for k, side in enumerate((1, -1)):
        x, u, f = disc + 3 * k + np.arange(3)
        normal[k, :, :disc], normal[k, :, u], normal[k, :, f] = -side * deflection, 1.0, r * np.sin(t)
        tangent[k, :, :disc], tangent[k, :, x], tangent[k, :, f] = -side * shape[4] / 2 * turn, 1.0, HEIGHT
    return np.vstack(normal), np.vstack(tangent), np.tile(share / share.sum(), 2), np.tile(r, 2)


def _joints(values):
    """[(weights of (x, u, f, x, u, f, z), stiffness, damping)] of all joints."""
    return [((1, 0, 0, 0, 0, 0, 0), values["abutment_outer"], ABUTMENT_LOSS),
            ((0, 0, 0, 1, 0, 0, 0), values["abutment_inner"], ABUTMENT_LOSS),
            ((0, 1, 0, 0, 0, 0, -1), values["fingers"], FINGER_LOSS), ((0, 0, 0, 0, 1, 0, 1), *SEAL),
            ((0, 0, 0, 0, 0, 0, 1), *GUIDE), ((0, 0, 1, 0, 0, 0, 0), *CLIP), ((0, 0, 0, 0, 0, 1, 0), *CLIP)]


def _with_hidden(brake, families):
    """What is hidden in the parts: waves that part, a mass, a spring or a clip at a point, a base that moves."""
    hidden = brake.hidden
    if split := hidden.get("doublet_split"):
        brake = replace(brake, stiffness=brake.stiffness + _parting(split, families, len(brake.mass)))
    for name, matrix in (("attached_mass", "mass"), ("added_stiffness", "stiffness")):
        if at := hidden.get(name):
            row = brake.sensors[at["sensor"]]
            brake = replace(brake, **{matrix: getattr(brake, matrix) + at[matrix] * np.outer(row, row)})
    if base := hidden.get("moving_base"):
        brake = _on_base(brake, base["pad"], 1 / base["compliance"], base["frequency"])
    if clip := hidden.get("resonant_clip"):
        rate, row = 2 * np.pi * clip["frequency"], np.append(brake.sensors[clip["sensor"]], -1.0)
        brake = brake.with_coordinate(clip["mass"]).with_joint(row, clip["mass"] * rate**2, 0.01 * clip["mass"] * rate)
    return brake


def _parting(split, families, size):
    """(n, n) N/m of a plate whose stiffness varies as share cos 2 n (t - angle), n the order that it parts."""
    first = np.cumsum([0, *(len(family.squared) for family in families)])
    indices = [start + np.arange(len(family.squared)) for start, family in zip(first, families, strict=False)
           if family.waves.order == split["order"]]
    squared = next(family.squared for family in families if family.waves.order == split["order"])
    a, b = (split["share"] * wave(2 * split["angle"]) * squared for wave in (np.cos, np.sin))
    matrix = np.zeros((size, size))
    for rows, columns, part in ((0, 0, a), (1, 1, -a), (0, 1, b), (1, 0, b)):
        matrix[indices[rows], indices[columns]] = part
    return matrix


def _on_base(brake, pad, stiffness, frequency):
    """The abutment of a pad on a mass on a spring, instead of the ground."""
    row = np.zeros(len(brake.mass) + 1)
    row[brake.disc + 3 * pad] = 1.0
    held = brake.values[f"abutment_{PADS[pad]}"], ABUTMENT_LOSS
    free = brake.with_coordinate(stiffness / (2 * np.pi * frequency) ** 2).with_joint(row, *(-part for part in held))
    base = np.eye(len(row))[-1]
    return free.with_joint(base, stiffness, 0.0).with_joint(row - base, *held)
