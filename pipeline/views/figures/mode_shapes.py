"""Scenes of the brake: assembled mesh, mode shapes of the disc, unstable complex modes."""

import numpy as np

from pipeline.views.figures.scene import Scene, Solid
from pipeline.views.figures.style import BLUE, GREEN, ORANGE, PURPLE, RED, SKY

BODY_COLOURS = {"disc": "#b8bec6", "pad_outer": ORANGE, "pad_inner": GREEN, "caliper": BLUE, "bracket": PURPLE,
                "piston": RED}
#: bodies around the others, drawn so that these are seen
_OUTSIDE = ("caliper", "bracket")

#: largest displacement drawn, as a share of the size of the body; pictures of one period
_EXAGGERATED, _FRAMES = 0.06, 16


def assembly(structure):
    """Scene of all bodies with the edges of their elements."""
    bodies = [(str(name), structure.body(str(name))) for name in structure.body_name]
    return Scene(tuple(
        Solid(body.node, body.element, body.kind.item(), colour=BODY_COLOURS.get(name, SKY), edges=True,
              opacity=0.35 if name in _OUTSIDE else 1.0) for name, body in bodies), direction=(0.7, -1.0, 1.0))


def disc_mode(disc, mode):
    """Scene of one real mode of the disc, displaced; colour = axial displacement."""
    return Scene((_displaced(disc.node, disc.element, disc.kind.item(), disc.shape[mode]),), size=(640, 480))


def unstable_mode(model, modes, index):
    """Scene of one period of an unstable complex mode, from its instant of largest displacement on.

    Colour = axial displacement; bodies without contacts are translucent.
    """
    shape, points = modes.unstable_shape[index], np.asarray(model.visible_position)
    motion = shape * np.exp(-0.5j * np.angle(np.sum(shape**2)))
    motion = motion * _EXAGGERATED * np.ptp(points, axis=0).max() / max(np.linalg.norm(motion, axis=1).max(), 1e-300)
    limit = max(np.percentile(np.abs(motion[:, 2]), 92), 1e-300)
    solids = tuple(Solid(points, faces, "quad", motion=motion, limit=limit, opacity=opacity)
                   for faces, opacity in _visible_bodies(model))
    return Scene(solids, size=(600, 460), frames=_FRAMES)


def _visible_bodies(model):
    """(faces, opacity) of each body with a surface: those that neither rub nor are rubbed are translucent."""
    face, body = np.asarray(model.visible_face), np.asarray(model.visible_body)
    rubbing = {*map(int, model.contact_body), *np.flatnonzero(np.array(model.body_name) == "disc")}
    return [(face[body[face[:, 0]] == b], 1.0 if b in rubbing else 0.3) for b in np.unique(body[face[:, 0]])]


def diameters(disc, mode):
    """Dominant number of nodal diameters of the axial motion of a disc mode."""
    axial = disc.shape[mode][:, 2]
    angle = np.arctan2(disc.node[:, 1], disc.node[:, 0])
    orders = np.arange(25)
    content = np.abs(np.exp(-1j * orders[:, None] * angle) @ axial)
    content[0] /= np.sqrt(2.0)
    return int(np.argmax(content))


def distinct(frequency, count):
    """First ``count`` modes, rigid motions and the second of each pair of equal frequencies left out."""
    elastic = np.flatnonzero(frequency > 1.0)
    apart = np.diff(frequency[elastic], prepend=0.0) > 5e-3 * frequency[elastic]
    return elastic[apart][:count]


def _displaced(points, cells, kind, displacement):
    largest = max(np.linalg.norm(displacement, axis=1).max(), 1e-300)
    motion = _EXAGGERATED * np.ptp(points, axis=0).max() / largest * displacement
    limit = max(np.percentile(np.abs(motion[:, 2]), 92), 1e-300)
    return Solid(points, cells, kind, motion=motion, limit=limit)
