"""Chapter: a lumped system, its parts and loads."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.models.lumped import diagram
from pipeline.views.figures.number_format import number, plural, quantity, span

#: springs and contacts that a diagram shows
_SURVEYED = 40
#: SI unit of what a sensor measures
_SI = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s\u00b2"}


def chapter(lumped, motion, look):
    """Chapter of the product Lumped; ``motion`` is its Transient, or None."""
    drive = " The speed of the drive varies over time." if len(lumped.drive_history) else ""
    return Chapter(
        "lumped", "Masses, springs and contacts",
        f"{plural(len(lumped.coordinate_name), 'coordinate')} of the masses"
        f" {', '.join(lumped.body_name)}; {plural(len(lumped.joint_name), 'spring')} (or dampers),"
        f" {plural(len(lumped.contact_name), 'contact')}.{drive}",
        _load(lumped),
        _picture(lumped),
        tuple(filter(None, (_joints(lumped), _contacts(lumped), _inputs(lumped), _sensors(lumped, motion)))))


def _picture(lumped):
    """The diagram, where a reader can survey it."""
    if len(lumped.joint_name) + len(lumped.contact_name) > _SURVEYED:
        return ()
    return (Figure(diagram(lumped), "Boxes: coordinates; black bar: ground. Zigzag: spring; square: damper; thick"
                   " orange: contact or friction joint; red triangles: input, in its direction; grey dots: sensor. Dots"
                   " mark the coordinates that a part is attached to."),)


def _load(lumped):
    if not lumped.preload.size:
        return "There are no contacts: the masses move on their springs."
    return f"At rest the contacts carry {span(lumped.preload, 'N')}."


def _combination(lumped, row):
    """'block.x - 0.03 wheel.rotation'."""
    terms = [f"{'-' if row[i] < 0 else '+'} {'' if abs(row[i]) == 1 else number(abs(row[i]), 3) + ' '}"
             f"{lumped.coordinate_name[i]}" for i in np.flatnonzero(row)]
    return " ".join(terms).removeprefix("+ ").replace("-", "\u2212") or "none"


def _joints(lumped):
    rows = tuple((str(name), _combination(lumped, row), quantity(k, "N/m"), quantity(d, "N s/m")) for name, row, k, d in
                 zip(lumped.joint_name, lumped.joint_rows, lumped.joint_stiffness, lumped.joint_damping, strict=True))
    head = ("name", "elongation", "stiffness", "damping")
    return Table(head, rows, "Springs and dampers", (2, 3), folded=len(rows) > _SURVEYED / 2) if rows else None


def _contacts(lumped):
    opens = [_combination(lumped, row) if row.any() else "friction joint" for row in lumped.contact_normal]
    rows = tuple((str(name), _combination(lumped, lumped.contact_tangent[i]), opens[i],
                  span(lumped.preload[:, i], "N"), quantity(lumped.contact_stiffness[:, i].max(), "N/m"),
                  quantity(lumped.contact_gap[i], "m")) for i, name in enumerate(lumped.contact_name))
    head = ("name", "slides along", "opens along", "preload", "stiffness (0: hard)", "gap")
    return Table(head, rows, "Contacts", (3, 4, 5), folded=len(rows) > _SURVEYED / 2) if rows else None


def _inputs(lumped):
    largest = [quantity(abs(history).max(), "N") if history.size else "\u2014" for history in lumped.input_history.T]
    rows = tuple((str(name), _combination(lumped, lumped.input_rows[i]), quantity(lumped.input_area[i], "N"),
                  largest[i]) for i, name in enumerate(lumped.input_name))
    head = ("name", "acts along", "constant", "largest over time")
    return Table(head, rows, "Inputs", (2, 3)) if rows else None


def _sensors(lumped, motion):
    rows = []
    for k, name in enumerate(lumped.sensor_name):
        unit, kind, gain = str(lumped.sensor_unit[k]), str(lumped.sensor_quantity[k]), lumped.sensor_gain[k]
        reads = f"{number(gain, 4)} {unit} per {_SI[kind]}"
        largest = "\u2014" if motion is None else f"{number(abs(gain) * _largest(motion, k, kind), 3)} {unit}"
        rows.append((str(name), _combination(lumped, lumped.sensor_rows[k]), kind, reads, largest))
    head = ("name", "measures", "quantity", "sensitivity", "largest reading")
    return Table(head, tuple(rows), "Sensors", (3, 4)) if rows else None


def _largest(motion, sensor, kind):
    """Largest magnitude of what a sensor measures, SI; displacements are relative to the start of the motion."""
    if kind == "acceleration":
        return abs(np.gradient(motion.velocity[:, sensor].astype(float), motion.time, axis=-1)).max()
    return abs(getattr(motion, kind)[:, sensor]).max()
