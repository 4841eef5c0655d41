"""Systems of a trial: each draws a case from a seed and writes it down as a workshop would, without its truth.

A generator is ``write(draw, folder)`` -> truth: it leaves ``nominal.yaml`` and ``recordings.h5`` in the folder, nothing
else, and returns what ``score`` opens:

    class       effect | pair | control | wrong_value | sensor | solver | foreign | below
    effects     [{name, place, parameters {name: SI value, where it is known}, alike* [{name, place}]}]; empty where
                nothing is hidden; alike: laws of the same force, or those nearest to one that no catalogue holds
    system, size, noise     name of the system; change of what sensors show, and noise, both relative
    parameters  {nominal value by its name in the case: true SI value}, where they are known

and whatever else describes the case. The same draw gives the same files. ConfigError or ConvergenceError where a draw
cannot be made: another seed is tried. SYSTEMS holds them all; to add one is to add its entry.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from pipeline.blind_trial.generators import case_files, real_recordings
from pipeline.blind_trial.generators.belt import belt, belt_files
from pipeline.blind_trial.generators.belt.hidden_friction import FRICTION
from pipeline.blind_trial.generators.benches import bench_cases, flutter, pin_bench
from pipeline.blind_trial.generators.brake import brake_files
from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.placement import places
from pipeline.blind_trial.generators.spring_mass.rig_case import KINDS, kind_of, made
from pipeline.blind_trial.generators.switching import hidden as switching
from pipeline.blind_trial.generators.switching import pulled_files, switching_files

CLASSES = ("effect", "pair", "control", "wrong_value", "sensor", "solver", "foreign", "below")


@dataclass(frozen=True)
class Draw:
    """What a case is to be: ``kind`` is its class, ``hidden`` names what is hidden, '' for nothing.

    ``size``: wanted change of what sensors show, ``noise``: standard deviation of the noise, both relative.
    """

    seed: int
    system: str
    kind: str
    hidden: tuple
    size: float
    noise: float

    @classmethod
    def read(cls, fields):
        """The draw whose fields a file lists, as ``dataclasses.asdict`` wrote them."""
        return cls(**{**fields, "hidden": tuple(fields["hidden"])})


@dataclass(frozen=True)
class System:
    """A generator and what it can hide.

    ``hides`` {class: (names hidden together, ...)}, e.g. {"control": ((),), "effect": (("coulomb",), ...)}; ``sizes``
    and ``noises`` that its cases have; ``motion``: forced, self_excited, disc_brake, micro or recorded; ``weight``: how
    often it is drawn among the systems that can make a class.
    """

    name: str
    write: Callable
    hides: dict
    sizes: tuple
    noises: tuple
    motion: str = "forced"
    weight: float = 1.0


#: masses of a rig; correlation of its noise over a sample
_MASSES, _COLOURS = (1, 2, 2, 2, 3, 4), (0.0, 0.0, 0.0, 0.2)
#: physics of which two act at once: one of each kind that moves a rig in a way of its own
_PAIRED = ("coulomb", "cubic_stiffness", "quadratic_stiffness", "quadratic_damping", "hysteretic_joint", "backlash",
           "viscoelastic_pad", "thermal_softening", "base_shake", "moving_base", "attached_mass", "pressure_ripple")


def _forced(draw, folder):
    """A row of masses that a shaker pushes."""
    random = np.random.default_rng([draw.seed, 1])
    masses, at = _apart(random, [HIDDEN[name] for name in draw.hidden])
    colour = float(random.choice(_COLOURS))
    kind = draw.kind if draw.kind in KINDS else ""
    case = made(draw.seed, draw.hidden, at, draw.noise, masses, colour, draw.size, kind)
    case_files.write(case, folder)
    return {**case_files.truth(case), "system": draw.system}


def _belt(draw, folder):
    """A mass on a belt, alone or before another one, pushed by a shaker."""
    masses = int(np.random.default_rng([draw.seed, 1]).choice((1, 1, 2)))
    case = belt.made(draw.seed, draw.hidden, draw.noise, masses, draw.size, draw.kind if draw.kind in KINDS else "")
    belt_files.write(case, folder)
    return belt_files.truth(case)


def _apart(random, pieces):
    """(masses, (number of a place of each piece, ...)): a rig with room for all, two of them at two links."""
    kinds = [piece.place for piece in pieces]
    masses = 3 if "wall link" in kinds else int(random.choice(_MASSES[len(kinds) > 1:]))
    free = [[at for at, _ in places(piece, masses)] for piece in pieces]
    chosen = [int(random.choice(at)) for at in free]
    if len(chosen) > 1 and chosen[0] == chosen[1] and "link" in kinds[0] and "link" in kinds[1]:
        chosen[1] = int(random.choice([at for at in free[1] if at != chosen[0]]))
    return masses, tuple(index.index(link) for index, link in zip(free, chosen, strict=True))


def _classes(pieces):
    """{class: ((name, ...), ...)} of the pieces of HIDDEN, and of nothing hidden."""
    groups = {"control": ((),), "wrong_value": ((),), "pair": tuple(combinations(_PAIRED, 2))}
    for piece in pieces:
        kind = kind_of((piece.name,))
        groups[kind] = (*groups.get(kind, ()), (piece.name,))
    groups["below"] = groups["effect"]
    return groups


def _on_belts():
    """{class: ((name, ...), ...)} of what a belt hides; a pair is one of its contact and one of the rig."""
    groups = {"control": ((),), "wrong_value": ((),), "effect": tuple((name,) for name in belt.IN_RIG), "foreign": ()}
    for piece in FRICTION.values():
        kind = belt.kind_of((piece.name,))
        groups[kind] = (*groups[kind], (piece.name,))
    groups["below"] = groups["effect"]
    contact = [name for name, in groups["effect"] if name in FRICTION]
    return {**groups, "pair": tuple(product(contact, belt.IN_RIG))}


SYSTEMS = {system.name: system for system in (
    System("forced_rig", _forced, _classes(HIDDEN.values()), sizes=(0.03, 0.1, 0.3), noises=(0.01, 0.03, 0.1)),
    System("belt_rig", _belt, _on_belts(), sizes=(0.03, 0.1, 0.2), noises=(0.03, 0.1), weight=0.03),
    System("pin_on_disc", bench_cases.pin_on_disc, bench_cases.hides(pin_bench.HIDDEN, pin_bench.DECOYS), (0.0,),
           (0.0,),
           "self_excited", weight=0.5),
    System("shoe_on_drum", bench_cases.shoe_on_drum, bench_cases.hides(flutter.HIDDEN, flutter.DECOYS), (0.0,), (0.0,),
           "self_excited", weight=0.1),
    System("worn_pads", bench_cases.worn_pads, bench_cases.hides(bench_cases.worn_names()), (0.0,), (0.0,), "micro",
           weight=0.03),
    System("disc_brake", brake_files.write, brake_files.hides(), (0.0,), (0.0,), "disc_brake", weight=0.14),
    System("switching_rig", switching_files.write, switching.hides(), sizes=(0.0,), noises=(0.01, 0.05), weight=0.1),
    System("pulled_block", pulled_files.write, pulled_files.hides(), sizes=(0.0,), noises=(0.01, 0.05), weight=0.03),
    System("coarse_rig", _forced, {"solver": ((),)}, sizes=(0.0,), noises=(0.003, 0.01)),
)}
#: the same of real recordings, for those who have them: see ``pipeline.blind_trial.generators.real_recordings``
RECORDED = {name: System(name, real_recordings.write, real_recordings.removable(name), (0.0,), (0.0,), "recorded")
            for name in real_recordings.NAMES}
