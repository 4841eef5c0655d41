"""A shoe on a drum: a block that slides and is pressed, a mass on a tail behind it; it flutters by mode coupling.

After N. Hoffmann, M. Fischer, R. Allgaier, L. Gaul, Mech. Res. Commun. 29 (2002) 197: an inclined spring couples the
motion along the drum with that onto it, and friction closes the loop. Coordinates are tail x, block x, block y; the
march, the hidden physics of the contact and the sensors are those of ``pin_bench``.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.benches import pin_bench
from pipeline.blind_trial.generators.benches.pin_bench import Bench, with_structure

#: what can be hidden, as in ``pin_bench``: no doublets; friction that falls more, because a block is heavier; and less
#: runout, because its guide carries two thirds of the load
HIDDEN = {name: ends for name, ends in pin_bench.HIDDEN.items() if name != "doublet_split"} | {
    "falling_friction": {"rise": (0.15, 0.4), "decay_speed": (0.05, 0.12)},
    "runout": {"amplitude": (5e-7, 1.2e-6), "phase": (-3.0, 3.0)}}
DECOYS = pin_bench.DECOYS
#: masses kg, stiffnesses N/m, dampings N s/m, friction, as drawn
NOMINAL = {"tail": 0.06, "block": 0.1, "tie": 2e6, "along": 9.3e6, "onto": 7e6, "inclined": 1.5e6, "guide": 3.0,
           "sliding": 24.0, "pressing": 24.0, "contact": 3e6, "shear": 2.4e6, "friction": 0.3}
#: relative standard deviation of each about the drawing; weighed parts are better known than joints. The damper that
#: presses is exact, as more of it is what may be hidden
SPREAD = {"tail": 0.03, "block": 0.03, "guide": 0.3, "sliding": 0.3, "pressing": 0.0, "contact": 0.2, "shear": 0.2,
          "friction": 0.15}
STIFFNESS_SPREAD = 0.1
#: names of the sensors of ``pin_bench`` here
CHANNELS = {"laser_disc": "laser_tail", "laser_pin": "laser_block", "accelerometer": "accelerometer",
            "load_cell": "load_cell"}
_SEEN = (0.6, 0.8)
#: blows at rest and in sliding, N s: soft enough in sliding that growth is seen before it saturates
_TAPS = (1e-4, 1e-6)


@dataclass(frozen=True)
class Truth:
    """``factors`` {value: truth over drawing}, ``hidden`` {physics or decoy: its values}."""

    factors: dict
    hidden: dict


def make(seed, hidden=(), decoys=()):
    """(Bench, Truth) of a draw: every value off, with effects ``hidden`` and sensors that are wrong (``decoys``)."""
    random = np.random.default_rng(seed)
    values = {name: {key: float(random.uniform(*ends)) for key, ends in {**HIDDEN, **DECOYS}[name].items()}
              for name in (*hidden, *decoys)}
    for name in decoys:
        values[name]["channel"] = str(random.choice(("laser_pin", "accelerometer")))
    factors = {name: float(np.exp(SPREAD.get(name, STIFFNESS_SPREAD) * random.standard_normal())) for name in NOMINAL}
    bench = replace(built({name: factors[name] * value for name, value in NOMINAL.items()}), hidden=values)
    return with_structure(bench, values), Truth(factors, values)


def built(values):
    """Bench of the named ``values`` (those of NOMINAL), nothing hidden."""
    v, half = values, values["inclined"] / 2
    mass = np.array([v["tail"], v["block"], v["block"]])
    stiffness = np.array([v["tie"], v["tie"] + v["along"] + half, v["onto"] + half])
    coupling = np.zeros((3, 3))
    coupling[0, 1] = coupling[1, 0] = -v["tie"]
    coupling[1, 2] = coupling[2, 1] = -half
    normal, tail = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    seen = np.array([0.0, *_SEEN])
    return Bench(mass, stiffness / mass, np.array([v["guide"], v["sliding"], v["pressing"]]), coupling, normal,
                 np.array([0.0, 1.0, 0.0]), -normal, np.array([tail, seen, seen]), np.array([tail, normal]),
                 v["contact"], v["shear"], v["friction"], v["onto"] * normal)


def record(bench, seed):
    """{run: dict} of a campaign as ``pin_bench.record`` makes it, under the names of these sensors."""
    return {name: {**run, "channels": {CHANNELS[key]: samples for key, samples in run["channels"].items()}}
            for name, run in pin_bench.record(bench, seed, _TAPS).items()}


def nominal():
    """The case of the workshop, but for the file of recordings."""
    v, spread = NOMINAL, {"spread": STIFFNESS_SPREAD}

    def spring(first, second, stiffness=0.0, damping=0.0):
        return {"between": [first, second], "stiffness": f"{stiffness:g} N/m", "damping": f"{damping:g} N s/m"}

    parameters = {f"bodies.{name}.mass": {"spread": SPREAD[name]} for name in ("tail", "block")}
    parameters |= {f"joints.{name}.stiffness": spread for name in ("tie", "along", "onto", "inclined")}
    parameters |= {f"joints.{name}.damping": {"spread": SPREAD[kind]} for name, kind in (
        ("guide", "guide"), ("along", "sliding"))}
    parameters |= {name: {"spread": SPREAD[kind]} for name, kind in (
        ("contact.stiffness", "contact"), ("friction.stiffness", "shear"), ("friction", "friction"))}
    return {
        "chain": "lumped_bench", "title": "Shoe on a drum",
        "description": "Tapped lifted, at rest and in sliding under several loads and speeds.",
        "lumped": {
            "masses": {"tail": {"mass": f"{v['tail']:g} kg", "moves": ["x"]},
                       "block": {"mass": f"{v['block']:g} kg", "moves": ["x", "y"]}},
            "springs": {"tie": spring("tail.x", "block.x", v["tie"]),
                        "guide": spring("tail.x", "ground", 0.0, v["guide"]),
                        "along": spring("block.x", "ground", v["along"], v["sliding"]),
                        "onto": spring("block.y", "ground", v["onto"], v["pressing"]),
                        "inclined": {"along": {"block.x": 0.5**0.5, "block.y": -(0.5**0.5)},
                                     "stiffness": f"{v['inclined']:g} N/m"}},
            "contacts": {"shoe": {"tangent": {"block.x": 1}, "normal": {"block.y": 1},
                                  "stiffness": f"{v['contact']:g} N/m", "lever": f"{pin_bench.RADIUS} m"}},
            "inputs": {"press": {"along": {"block.y": -1}, "force": "15 N"}},
            "sensors": {"tail": {"along": {"tail.x": 1}},
                        "block": {"along": {"block.x": _SEEN[0], "block.y": _SEEN[1]}}}},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": "20 us", "contact": "penalty", "contact_stiffness": f"{v['contact']:g} N/m",
                  "friction": v["friction"], "description": "elastic", "tangential_stiffness": f"{v['shear']:g} N/m",
                  "poles": {"low": "400 Hz", "high": "3 kHz", "resolution": 4e-4},
                  "channels": {"laser_tail": {"quantity": "velocity", "source": "tail"},
                               "laser_block": {"quantity": "velocity", "source": "block"},
                               "accelerometer": {"quantity": "acceleration", "source": "block"},
                               "load_cell": {"quantity": "joint_force", "source": "onto"}}},
        "diagnosis": {"forward": "poles", "solver": False, "kept": 2, "parameters": parameters,
                      "effects": [*HIDDEN, *DECOYS],
                      "places": ["contact", "onto", "laser_block", "accelerometer"],
                      "priors": {"runout.order": {"prior": "uniform", "low": 0.99, "high": 1.01}}}}
