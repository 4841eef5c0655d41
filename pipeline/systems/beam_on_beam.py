"""The two beams of Meziane & Baillet: the slider P1 stands tilted on the track P2, which a drive pulls along.

Axes: x along the track from its clamp, y out of its rubbed face, in the frame of the track's support, which moves with
the drive along x. The slider touches the face at ``contact.distance`` from the clamp; its axis leans by ``slider.tilt``
towards +x. Its far end A is held along x and in rotation, carries a mass that moves along y and is pressed down. The
track is clamped at x = 0; where its support yields, springs stand for it. Friction acts on the face of the track,
``contact.lever`` half thicknesses above its axis: a moment. The slider touches ``contact.offset`` half thicknesses from
its axis, positive towards +x.

Both beams come as Timoshenko beams or as plane finite elements; held ends stay plane there, so that both have the same
supports, and the contact sees the mean motion of the end face of the slider and of a patch on the track.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.plane_stress import sheet
from pipeline.physics.fem.timoshenko_beam import BeamSection, beam
from pipeline.physics.stability.coalescence import ContactModes

SLIDER, TRACK = range(2)
BODIES = ("slider", "track")
ELEMENTS = ("plane", "timoshenko")
#: a slider that leans more than this lies rather than stands
_STEEPEST = np.pi / 3


@dataclass(frozen=True)
class Body:
    """One beam on its supports, n free coordinates; stiffness and mass (n, n) CSR, all rows dense.

    ``contact``, ``sensor`` (2, n): displacement along x and y; ``load`` (1, n): motion of the loaded end along -y (zero
    on the track); ``position`` (p, 2) m of points for pictures, their displacement ``shape`` (p, 2, n) and the
    quadrilaterals ``face`` (f, 4) between them.
    """

    name: str
    stiffness: "scipy.sparse.csr_matrix"
    mass: "scipy.sparse.csr_matrix"
    contact: np.ndarray
    sensor: np.ndarray
    load: np.ndarray
    position: np.ndarray
    shape: np.ndarray
    face: np.ndarray


@dataclass(frozen=True)
class _Strip:
    """A beam before it is held: ``sections`` maps station -> (3, n) rows of x, y and rotation of the section there."""

    stiffness: np.ndarray
    mass: np.ndarray
    sections: tuple
    position: np.ndarray
    shape: np.ndarray


def build(parameters, element="plane"):
    """(slider, track) of ``parameters``: attributes slider, track, material, contact, sensor as the stage declares.

    Raises ConfigError where the beams cannot be built or do not meet.
    """
    check(parameters)
    if element not in ELEMENTS:
        raise ConfigError("beam_on_beam.element", f"one of {', '.join(ELEMENTS)}", repr(element))
    return slider(parameters, element), track(parameters, element)


def slider(parameters, element):
    """P1 from its tip to A; stations tip, sensor, A."""
    p = parameters.slider
    up = upwards(parameters)
    reach = parameters.contact.offset * p.thickness / 2 * np.array([up[1], -up[0]])
    tip = touching(parameters) - reach
    strip = _strip(parameters, p, tip, up, [0.0, parameters.sensor.height, p.length], element, patch=None)
    foot, sensed, end = strip.sections
    heavy = strip.mass + parameters.contact.mass * end[1:2].T @ end[1:2]
    stiffness, held = _supported(strip.stiffness, end[[0, 2]], (p.guide_stiffness, p.guide_rotation_stiffness))
    return _body("slider", strip, stiffness, heavy, held, _moved(foot, reach), sensed[:2], -end[1:2])


def track(parameters, element):
    """P2 from its clamp to its free end; stations clamp, contact, free end."""
    p, c = parameters.track, parameters.contact
    strip = _strip(parameters, p, np.zeros(2), np.array([1.0, 0.0]), [0.0, c.distance, p.length], element,
                   patch=c.patch)
    clamp, contact, _ = strip.sections
    stiffness, held = _supported(strip.stiffness, clamp, (p.clamp_stiffness, p.clamp_stiffness,
                                                          p.clamp_rotation_stiffness))
    lever = np.array([0.0, c.lever * p.thickness / 2])
    nothing = np.zeros((2, len(clamp[0])))
    return _body("track", strip, stiffness, strip.mass, held, _moved(contact, lever), nothing, nothing[:1])


def touching(parameters):
    """(2,) m: the point of the track where the slider stands."""
    return np.array([parameters.contact.distance, parameters.track.thickness / 2])


def upwards(parameters):
    """(2,) unit vector along the axis of the slider, from its tip to A."""
    return np.array([np.sin(parameters.slider.tilt), np.cos(parameters.slider.tilt)])


def joined(bodies, squared, shapes):
    """(ContactModes, sensor row (m,), load row (m,)) of slider and track in one numbering of their modes.

    Of each body ``squared`` (k,) rad^2/s^2 and mass-normalised ``shapes`` (n, k). Rows of the contact are slider less
    track; the sensor reads x.
    """
    (slider, track), (first, other) = bodies, shapes
    tangent, normal = (np.r_[slider.contact[axis] @ first, -track.contact[axis] @ other] for axis in range(2))
    sensor, load = (np.r_[upper[0] @ first, lower[0] @ other]
                    for upper, lower in ((slider.sensor, track.sensor), (slider.load, track.load)))
    return ContactModes(np.concatenate(squared), normal, tangent), sensor, load


def check(parameters):
    """Refuse a system that cannot be built: ConfigError."""
    p1, p2, c = parameters.slider, parameters.track, parameters.contact
    rules = (
        (c.distance < p2.length, "contact.distance", f"a contact on the track, below {p2.length:g} m",
         f"{c.distance:g} m: the beams never touch"),
        (abs(c.offset) <= 1, "contact.offset", "a contact on the end face of the slider, -1 to 1", f"{c.offset:g}"),
        (abs(p1.tilt) < _STEEPEST, "slider.tilt", "a slider that stands, within 60 degrees",
         f"{np.degrees(p1.tilt):g}"),
        (parameters.sensor.height < p1.length, "sensor.height", f"a point between the tip and A, below {p1.length:g} m",
         f"{parameters.sensor.height:g} m"),
        (c.patch / 2 < min(c.distance, p2.length - c.distance), "contact.patch", "a patch on the track",
         f"{c.patch:g} m"),
    )
    for holds, where, expected, actual in rules:
        if not holds:
            raise ConfigError(f"beam_on_beam.{where}", expected, actual)


def _strip(parameters, member, start, direction, stations, element, patch):
    m = parameters.material
    section = BeamSection(member.thickness, member.width, m.young, m.poisson, m.density)
    if element == "timoshenko":
        return _thin(section, start, direction, stations, member.degree)
    return _plane(section, start, direction, stations, member, patch)


def _thin(section, start, direction, stations, degree):
    """Strip of spectral Timoshenko segments; its pictures show both faces of every node."""
    line = beam(start + np.outer(stations, direction), degree, section)
    each = np.eye(3 * len(line.node)).reshape(len(line.node), 3, -1)
    sections = tuple(each[k * degree] for k in range(len(stations)))
    reach = section.height / 2 * np.array([-direction[1], direction[0]])
    position = np.stack([line.node - reach, line.node + reach], axis=1).reshape(-1, 2)
    shape = np.array([_moved(rows, side * reach) for rows in each for side in (-1, 1)])
    return _Strip(line.stiffness, line.mass, sections, position, shape)


def _plane(section, start, direction, stations, member, patch):
    """Strip of plane finite elements, its last end (slider) or first end (track) made rigid."""
    half = section.height / 2
    ends = [s for s in stations if s == stations[0] or s == stations[-1] or patch is None]
    spot = stations[1] + (patch or 0.0) / 2 * np.array([-1, 0, 1])
    marks = ends if patch is None else [stations[0], *spot, stations[-1]]
    along = _lines(marks, member.cell)
    across = np.linspace(-half, half, member.cells_across + 1)
    part = sheet(start, direction, along, across, section)
    rigid = -1 if patch is None else 0
    basis, section_rows = _with_rigid_end(part, rigid, direction)
    middle = start + np.outer(stations, direction)
    position = [2 * int(np.argmin(abs(along - s))) for s in stations]
    rows = [_mean_section(part, k, c) @ basis for k, c in zip(position, middle, strict=True)]
    rows[rigid] = section_rows
    if patch is not None:
        rows[1] = _over_patch(part, position[1], middle[1], rows[1], half, basis)
    edge = part.lattice[::2][:, [0, -1]].ravel()
    displacement = basis.toarray().reshape(-1, 2, basis.shape[1])[edge]
    return _Strip(basis.T @ part.stiffness @ basis, basis.T @ part.mass @ basis, tuple(rows), part.node[edge],
                  displacement)


def _lines(marks, cell):
    """Lines through ``marks`` (ascending), no further apart than ``cell``."""
    pieces = [np.linspace(a, b, max(1, int(np.ceil((b - a) / cell - 1e-9))) + 1)[:-1]
              for a, b in zip(marks[:-1], marks[1:], strict=True)]
    return np.concatenate((*pieces, marks[-1:]))


def _with_rigid_end(part, end, direction):
    """(basis, rows): nodal displacements from the free nodes and from x, y, rotation of the plane end; the latter."""
    nodes, count = part.lattice[end], len(part.node)
    free = np.setdiff1d(np.arange(2 * count), (2 * nodes[:, None] + np.arange(2)).ravel())
    centre = part.node[nodes].mean(axis=0)
    size = len(free) + 3
    basis = scipy.sparse.lil_matrix((2 * count, size))
    basis[free, np.arange(len(free))] = 1.0
    for node, (x, y) in zip(nodes, part.node[nodes] - centre, strict=True):
        basis[2 * node, size - 3], basis[2 * node, size - 1] = 1.0, -y
        basis[2 * node + 1, size - 2], basis[2 * node + 1, size - 1] = 1.0, x
    return basis.tocsr(), np.eye(size)[-3:]


def _mean_section(part, line, centre):
    """(3, 2n): mean displacement and mean rotation of a section, weighted along its height as quadratics integrate."""
    nodes = part.lattice[line]
    weight = _simpson(len(nodes))
    lever = part.node[nodes] - centre
    inertia = weight @ (lever**2).sum(axis=1)
    rows = np.zeros((3, 2 * len(part.node)))
    rows[0, 2 * nodes], rows[1, 2 * nodes + 1] = weight, weight
    rows[2, 2 * nodes], rows[2, 2 * nodes + 1] = -weight * lever[:, 1] / inertia, weight * lever[:, 0] / inertia
    return rows


def _over_patch(part, line, centre, section_rows, half, basis):
    """Section rows whose displacements are such that the rubbed face moves as the mean of its patch does."""
    nodes = part.lattice[line - 2:line + 3, -1]
    rows = np.zeros((2, 2 * len(part.node)))
    for axis in range(2):
        rows[axis, 2 * nodes + axis] = _simpson(5)
    face = rows @ basis
    turned = section_rows[2]
    return np.array([face[0] + half * turned, face[1], turned])


def _simpson(count):
    """Weights, sum 1, of ``count`` equal distances: exact for quadratics between every second point."""
    weight = np.r_[1.0, np.tile([4.0, 2.0], (count - 3) // 2), 4.0, 1.0]
    return weight / weight.sum()


def _moved(rows, reach):
    """(2, n): displacement of the point at ``reach`` (2,) m from a section with ``rows`` (3, n)."""
    return np.array([rows[0] - reach[1] * rows[2], rows[1] + reach[0] * rows[2]])


def _supported(stiffness, rows, springs):
    """(stiffness with springs, coordinates held): each of ``rows`` (unit rows) on its spring, held where it is None."""
    held = []
    for row, spring in zip(rows, springs, strict=True):
        if spring is None:
            held.append(int(np.argmax(row)))
        else:
            stiffness = stiffness + spring * np.outer(row, row)
    return stiffness, held


def _body(name, strip, stiffness, mass, held, contact, sensor, load):
    free = np.setdiff1d(np.arange(len(contact[0])), held)
    quads = np.arange(0, len(strip.position) - 2, 2)[:, None] + np.array([0, 2, 3, 1])
    return Body(name, *(scipy.sparse.csr_matrix(a)[free][:, free] for a in (stiffness, mass)),
                *(rows[:, free] for rows in (contact, sensor, load)), strip.position, strip.shape[..., free], quads)
