"""Cases on practice benches as a trial draws them: pin on disc, shoe on drum, and pads that wear.

What a draw says of size and noise does not count here: both are those of the benches, drawn within their ranges.
"""

import numpy as np

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.benches import flutter, pin_bench, worn_pad

#: which joint carries the arm of each bench
_ARM = {"pin_on_disc": "arm", "shoe_on_drum": "onto"}
_BESIDE = {"kind": "hdf5", "file": "recordings.h5"}
#: factor of a mode -> what a diagnosis calls it
_OF_MODES = {"mass": "modal_mass", "frequency": "frequency", "damping": "damping"}
#: names of the catalogue for what a worn pad hides
_WORN = {"third_body": "third_body_film", "transfer": "material_transfer"}


def pin_on_disc(draw, folder):
    """A tilted pin on a turning disc, tapped until it squeals."""
    bench, about = pin_bench.make(draw.seed, *_split(draw, pin_bench.DECOYS))
    document = case_files.stated("pin_on_disc_bench.yaml")
    truth = _self_excited(draw, folder, document, pin_bench.record(bench, draw.seed), about["hidden"], about["factors"])
    return {**truth, "parameters": _values(bench, about["factors"])}


def _values(bench, factors):
    """{parameter of a diagnosis: true value} of a pin_bench.Bench: the arm in SI, else factors of the nominal value."""
    modes = {f"bodies.{body}.{_OF_MODES[kind]}": factor for (body, kind), factor in (
        (name.split("."), factor) for name, factor in factors.items() if "." in name) if body not in ("arm", "contact")}
    return {**modes, "joints.arm.stiffness": float(abs(bench.arm[-1])), "friction": factors["friction"],
            "contact.stiffness": factors["contact.stiffness"],
            "friction.stiffness": factors["contact.tangential_stiffness"]}


def shoe_on_drum(draw, folder):
    """A shoe on a drum that flutters by mode coupling."""
    bench, about = flutter.make(draw.seed, *_split(draw, flutter.DECOYS))
    return _self_excited(draw, folder, flutter.nominal(), flutter.record(bench, draw.seed), about.hidden, about.factors)


def worn_pads(draw, folder):
    """Replicas of a pad, worn under several pressures: friction and faces."""
    hidden = draw.hidden[0] if draw.hidden else ""
    bench, description = worn_pad.make(draw.seed, next((key for key, name in _WORN.items() if name == hidden), ""))
    document = case_files.stated("worn_pad.yaml")
    for body in ("disc", "pad"):
        document["surface"][body]["file"] = "recordings.h5"
    document["recording"]["files"] = [_BESIDE]
    case_files.leave(folder, document, _neutral(worn_pad.record(bench, draw.seed)))
    known = {name: description["hidden"]["third_body"][name] for name in ("gain", "distance")} if (
        hidden == "third_body_film") else description["hidden"].get("transfer", {})
    return {"class": draw.kind, "system": draw.system, "seed": draw.seed, "parameters": {},
            "effects": [{"name": hidden, "place": "asperities", "parameters": known}] if hidden else [],
            "factors": description["factors"]}


def hides(physics, decoys=()):
    """{class: ((name,), ...)} of the physics and decoys of a bench."""
    groups = {"control": ((),), "effect": tuple((name,) for name in physics)}
    return {**groups, "sensor": tuple((name,) for name in decoys)} if decoys else groups


def worn_names():
    """Names of the catalogue of what worn pads hide."""
    return tuple(_WORN.values())


def _split(draw, decoys):
    """(physics, decoys) among what a draw hides."""
    return tuple(n for n in draw.hidden if n not in decoys), tuple(n for n in draw.hidden if n in decoys)


def _self_excited(draw, folder, document, runs, hidden, factors):
    document["recording"]["files"] = [_BESIDE]
    case_files.leave(folder, document, _neutral(runs))
    effects = [_told(name, values, draw.system) for name, values in hidden.items()]
    return {"class": draw.kind, "system": draw.system, "seed": draw.seed, "parameters": {}, "effects": effects,
            "factors": factors}


def _told(name, values, system):
    """{name, place, parameters} of what is hidden, in the words of the catalogue where they mean the same."""
    location, known = "contact", values
    if name in pin_bench.DECOYS:
        location = flutter.CHANNELS[values["channel"]] if system == "shoe_on_drum" else values["channel"]
        known = {key: value for key, value in values.items() if key != "channel"}
    elif name in ("moving_base", "joint_damping"):
        location = _ARM[system]
    elif name == "doublet_split":
        location, known = {2: "two 1", 3: "three 1"}[values["order"]], {}
    elif name == "pressure_dependent_friction":
        known = {"exponent": -values["exponent"]}
    elif name == "contact_damping":
        known = {}
    return {"name": name, "place": location, "parameters": known}


def _neutral(runs):
    """Runs as ``files.leave`` takes them, of those that a bench records."""
    return {name: {**run, "channels": {key: (np.asarray(samples, np.float32), unit, quantity, rate, "response")
                                       for key, (samples, unit, quantity, rate) in run["channels"].items()}}
            for name, run in runs.items()}
