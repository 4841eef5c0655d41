"""Stage beam_on_beam: modes of both beams on their supports, and mode coalescence in sliding contact."""

from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, InputFile, Quantity, Section, option, stage
from pipeline.contract.documents import read_yaml
from pipeline.physics.reduction.beam import beam_modes
from pipeline.physics.stability.coalescence import coalescences, friction_over_frequency
from pipeline.products import BeamOnBeam
from pipeline.systems.beam_on_beam import BODIES, build, joined, touching, upwards

#: last friction coefficient at which coalescences are sought
_MOST_FRICTION = 1.0


class Slider(Section):
    """Beam P1: from its tip on the track to A, where it is held along x and in rotation."""

    length: Quantity("m", gt=0) = option("100 mm", "length from the tip to A")
    thickness: Quantity("m", gt=0) = option("5.7 mm", "height of the section, in the plane")
    width: Quantity("m", gt=0) = option("19 mm", "width of the section, across the plane")
    tilt: Quantity("rad") = option("-5 deg", "lean of its axis towards +x, away from the clamp of the track")
    guide_stiffness: Quantity("N/m", gt=0) | None = option(None, "spring that holds A along x; none = rigid")
    guide_rotation_stiffness: Quantity("N m/rad", gt=0) | None = option(
        None, "spring that holds A in rotation; none = rigid")
    cell: Quantity("m", gt=0) = option("2 mm", "plane: longest element along the beam")
    cells_across: int = option(3, "plane: elements across the beam", ge=1)
    degree: int = option(12, "timoshenko: degree of the polynomials on each segment", ge=4, le=24)


class Track(Section):
    """Beam P2: clamped to the driven support, free at its other end."""

    length: Quantity("m", gt=0) = option("377 mm", "length from the clamp to the free end")
    thickness: Quantity("m", gt=0) = option("19.3 mm", "height of the section, in the plane")
    width: Quantity("m", gt=0) = option("10 mm", "width of the section, across the plane")
    clamp_stiffness: Quantity("N/m", gt=0) | None = option(
        None, "springs that hold its support along x and along y; none = rigid")
    clamp_rotation_stiffness: Quantity("N m/rad", gt=0) | None = option(
        None, "spring that holds its support in rotation; none = rigid")
    cell: Quantity("m", gt=0) = option("5 mm", "plane: longest element along the beam")
    cells_across: int = option(3, "plane: elements across the beam", ge=1)
    degree: int = option(14, "timoshenko: degree of the polynomials on each segment", ge=4, le=24)


class Material(Section):
    """Both beams."""

    young: Quantity("Pa", gt=0) = option("210 GPa", "Young's modulus")
    poisson: float = option(0.3, "Poisson's ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("7800 kg/m^3", "density")
    mass_damping: Quantity("1/s", ge=0) = option("0 1/s", "Rayleigh damping per mass, alpha 1")
    stiffness_damping: Quantity("s", ge=0) = option("0 s", "Rayleigh damping per stiffness, alpha 2")


class Contact(Section):
    """Contact point of the beams and the normal force."""

    distance: Quantity("m", gt=0) = option("80 mm", "contact from the clamp of the track")
    offset: float = option(0.0, "contact off the axis of the slider over its half thickness, positive towards +x",
                           ge=-1, le=1)
    lever: float = option(1.0, "height at which friction acts on the track over its half thickness", ge=0, le=1)
    patch: Quantity("m", gt=0) = option("4 mm", "plane: length of the patch on the track whose mean motion counts")
    mass: Quantity("kg", ge=0) = option("3 kg", "concentrated mass at A, moving along y")
    force: Quantity("N", gt=0) = option("9 N", "force at A along -y, which presses the beams together")


class ReadingPoint(Section):
    """Point B."""

    height: Quantity("m", gt=0) = option("40 mm", "distance of point B from the tip, along the slider")


class Settings(Section):
    """Both beams, their contact and the modes retained."""

    element: Literal["plane", "timoshenko"] = option("plane", "plane finite elements, or Timoshenko beams (faster)")
    slider: Slider = option(Slider(), "beam P1")
    track: Track = option(Track(), "beam P2")
    material: Material = option(Material(), "steel of both beams")
    contact: Contact = option(Contact(), "contact of the beams and its load")
    sensor: ReadingPoint = option(ReadingPoint(), "point whose velocity along x is read")
    modes_below: Quantity("Hz", gt=0) = option("50 kHz", "limit of the modes of each beam")
    residual_below: Quantity("Hz", gt=0) = option("150 kHz", "limit of the residual shapes for the contact forces")
    coalescences_below: Quantity("Hz", gt=0) = option("10 kHz", "limit of the search for coalescing modes")
    samples: int = option(6000, "frequencies at which that search samples", ge=100)
    findings: InputFile | None = option(
        None, "what a search for the geometry has found: a list of {what, found}, for the report")


@stage
def beam_on_beam(settings: Settings, context: Context) -> BeamOnBeam:
    """Build the two beams and find the coalescences of their modes in sliding.

    Method:
    The beams ({element}) on their supports were reduced to their modes below {modes_below} and residual shapes for the
    contact forces. In steady sliding on a rigid contact each frequency is a mode at exactly one friction coefficient;
    the maxima of that curve are the coalescences. It was sampled below {coalescences_below} at {samples} frequencies.
    """
    other = "timoshenko" if settings.element == "plane" else "plane"
    chosen, check = (_reduced(settings, element, context) for element in (settings.element, other))
    frequency = np.geomspace(settings.coalescences_below / 1e3, settings.coalescences_below, settings.samples)
    modes, direction = joined(*chosen)[0], -1.0
    pairs = coalescences(modes, frequency, direction, _MOST_FRICTION)
    crosscheck = coalescences(joined(*check)[0], frequency, direction, _MOST_FRICTION)
    context.log("coalescences: " + (", ".join(f"{f:.0f} Hz at {mu:.3f}" for f, mu in zip(
        pairs.onset_frequency, pairs.onset_friction, strict=True)) or "none"))
    return BeamOnBeam(
        body_name=BODIES, element=settings.element, curve_frequency=frequency,
        curve_friction=_drawn(friction_over_frequency(modes, frequency, direction)[1]),
        closed_frequency=pairs.frictionless, onset_frequency=pairs.onset_frequency, onset_friction=pairs.onset_friction,
        end_frequency=pairs.end_frequency, end_friction=pairs.end_friction,
        check_frequency=crosscheck.frictionless, check_onset_frequency=crosscheck.onset_frequency,
        check_onset_friction=crosscheck.onset_friction, **_findings(settings.findings), **_joined(*chosen, settings))


def _findings(path):
    """Two columns of text from the file of findings; ConfigError where it is something else."""
    rows = read_yaml(path) if path else []
    if not isinstance(rows, list) or not all(isinstance(r, dict) and set(r) == {"what", "found"} for r in rows):
        raise ConfigError(f"{path}", "a list of {what, found}", "something else",
                          "see data/reference/beam_geometry.yaml")
    return {"finding": [r["what"] for r in rows], "finding_text": [r["found"] for r in rows]}


def _reduced(settings, element, context):
    """(bodies, squared, shapes) of both beams."""
    bodies, modes = build(settings, element), []
    for body in bodies:
        rows = np.vstack((body.contact, body.load))
        modes.append(beam_modes(body.stiffness, body.mass, rows[np.any(rows, axis=1)], settings.modes_below,
                                settings.residual_below, context.solver))
    return bodies, *zip(*modes, strict=True)


def _drawn(friction):
    """The curve where a picture may need it; elsewhere its bound."""
    return np.clip(friction, -_MOST_FRICTION, 2 * _MOST_FRICTION)


def _joined(bodies, squared, shapes, settings):
    """Modal fields of both beams in one numbering."""
    modes, sensor, load = joined(bodies, squared, shapes)
    counts, points = [s.shape[1] for s in shapes], [len(b.position) for b in bodies]
    recovery = np.zeros((sum(points), 3, sum(counts)), np.float32)
    for k, (body, shape) in enumerate(zip(bodies, shapes, strict=True)):
        rows, columns = slice(sum(points[:k]), sum(points[:k + 1])), slice(sum(counts[:k]), sum(counts[:k + 1]))
        recovery[rows, :2, columns] = body.shape @ shape
    flat = np.vstack([b.position for b in bodies])
    first = np.cumsum([0, *points])
    area, touch = settings.slider.width * settings.slider.thickness, touching(settings)
    sensed = touch + settings.sensor.height * upwards(settings)
    return {
        "mode_body": np.repeat([0, 1], counts), "mode_frequency": np.sqrt(np.maximum(modes.squared, 0.0)) / (2 * np.pi),
        "mode_damping": settings.material.mass_damping + settings.material.stiffness_damping * modes.squared,
        "contact_normal": modes.normal[None], "contact_tangent": modes.tangent[None],
        "contact_position": np.r_[touch, 0.0][None], "contact_area": [area], "force": settings.contact.force,
        "load_row": load[None], "sensor_name": ["B_x"], "sensor_position": np.r_[sensed, 0.0][None],
        "sensor_direction": [[1.0, 0.0, 0.0]], "sensor_rows": sensor[None],
        "visible_position": np.column_stack((flat, np.zeros(len(flat)))), "visible_body": np.repeat([0, 1], points),
        "visible_face": np.vstack([b.face + first[k] for k, b in enumerate(bodies)]), "recovery": recovery}
