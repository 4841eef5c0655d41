"""What a switching rig can hide: where, by which laws or changes of the rig, and whether a catalogue may hold it."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from pipeline.blind_trial.generators.switching import foreign_laws, joint_laws
from pipeline.blind_trial.generators.switching.rig import WALL


@dataclass(frozen=True)
class Piece:
    """``laws(spot, size)`` of a law, or ``change(rig, index, size)`` -> Rig; at a ``place``: spring, wall spring (to a
    wall), or mass. ``name`` is the catalogue's; ``form`` tells two forms of one name apart.

    ``exact``: kind of value that is stated exactly there, as what is hidden would else be a wrong value of it;
    ``largest`` size that is tried.
    """

    form: str
    name: str
    place: str = "spring"
    laws: Callable | None = None
    change: Callable | None = None
    known: bool = True
    exact: str = ""
    largest: float = 6.0


def _softer(rig, index, size):
    """A massless arm in series: spring and damper as they are in series with it, to first order of the damping."""
    share = 1 / (1 + size)
    return rig.with_values({f"stiffness.{index}": rig.stiffness[index] * share,
                            f"damping.{index}": rig.damping[index] * share**2})


def _damped(rig, index, size):
    return rig.with_values({f"damping.{index}": rig.damping[index] * (1 + size)})


def _heavier(rig, index, size):
    return rig.with_values({f"mass.{index}": rig.mass[index] * (1 + size)})


def _supported(rig, index, size):
    """A spring of a share of the stiffest one from a body to the wall, without a damper."""
    return type(rig)(rig.mass, (*rig.ends, (index, WALL)), (*rig.stiffness, size * max(rig.stiffness)),
                     (*rig.damping, 0.0))


def _law(form, laws, name="", known=True, place="spring"):
    return Piece(form, name or form, place, laws=laws, known=known)


_KNOWN = (
    _law("coulomb", joint_laws.coulomb), _law("asymmetric_friction", joint_laws.asymmetric),
    _law("cubic_stiffness", joint_laws.cubic), _law("quadratic_stiffness", joint_laws.quadratic),
    _law("quadratic_damping", joint_laws.drag), _law("backlash", joint_laws.play),
    _law("jenkins_elements", joint_laws.slipping, "hysteretic_joint"),
    _law("bouc_wen", joint_laws.bouc_wen),
    _law("viscoelastic_pad", joint_laws.relaxing), _law("moving_base", joint_laws.moving_base, place="wall spring"),
    _law("base_shake", joint_laws.shaken_base, place="wall spring"),
    Piece("joint_damping", "joint_damping", change=_damped, exact="damping", largest=3.0),
    Piece("compliant_arm", "compliant_arm", change=_softer, exact="stiffness", largest=0.6),
    Piece("attached_mass", "attached_mass", "mass", change=_heavier, exact="mass", largest=0.6),
    Piece("added_stiffness", "added_stiffness", "mass", change=_supported, exact="stiffness", largest=0.6),
)
_FOREIGN = tuple(_law(name, getattr(foreign_laws, name), known=False) for name in (
    "quintic", "magnet", "lagging", "dead_time", "root_drag", "lift", "slosh", "impacts", "switched_spring",
    "threshold_flow", "rigid_stop", "clamped"))
PIECES = {piece.form: piece for piece in (*_KNOWN, *_FOREIGN)}
#: laws of two strengths, one each way -> the law of their mean, at the same size
MEANS = {"asymmetric_friction": "coulomb"}
#: laws of which two act at once: one of each kind that moves a rig in a way of its own
_PAIRED = ("coulomb", "cubic_stiffness", "quadratic_stiffness", "quadratic_damping", "backlash", "jenkins_elements",
           "viscoelastic_pad")
#: those that are nearly one law at one spring
_ONE_LAW = {"coulomb", "jenkins_elements"}
#: faults of a sensor: form -> name of the catalogue
FAULTS = {"gain": "sensor_gain", "reversed": "reversed_channel", "factor_1000": "unit_factor", "delay": "sensor_delay",
          "clipping": "clipping", "drift": "sensor_offset_drift"}
#: those of them that multiply what a channel shows
RATIOS = ("gain", "factor_1000", "reversed")


def places(piece, rig):
    """Numbers of the springs or bodies of a Rig at which a Piece can be."""
    if piece.place == "mass":
        return list(range(len(rig.mass)))
    return [k for k, (_, far) in enumerate(rig.ends) if piece.place == "spring" or far == WALL]


def row_of(piece, rig, index):
    """(n,) along which a Piece at this number acts."""
    return np.eye(len(rig.mass))[index] if piece.place == "mass" else rig.rows[index]


def known_exactly(piece, rig, index):
    """Names of values that the workshop states exactly beside a Piece at this number: all that could imitate it."""
    if not piece.exact:
        return ()
    if piece.form == "added_stiffness":
        return tuple(f"stiffness.{k}" for k, pair in enumerate(rig.ends) if pair == (index, WALL))
    return (f"{piece.exact}.{index}",)


def pairs():
    """((form, form), ...) of two laws that a rig can hide at once, at one spring or at two."""
    return tuple(pair for pair in combinations(_PAIRED, 2) if set(pair) != _ONE_LAW)


def hides():
    """{class: ((form,), ...)} of what a switching rig can hide."""
    known, foreign = (tuple((p.form,) for p in PIECES.values() if p.known == so) for so in (True, False))
    return {"control": ((),), "wrong_value": ((),), "effect": known, "foreign": foreign,
            "sensor": tuple((form,) for form in FAULTS)}
