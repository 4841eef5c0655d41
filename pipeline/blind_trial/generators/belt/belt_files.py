"""Files of a case on a belt, and its truth: see ``pipeline.blind_trial.generators.case_files``."""

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.belt.belt import HUMIDITIES, LOAD, LOADS, RATE, SPREAD
from pipeline.blind_trial.generators.belt.hidden_friction import FRICTION
from pipeline.blind_trial.generators.spring_mass.reported_values import parameters

#: the workshop's longest step, samples: at 0.25 instants at which friction turns round would be off by more than noise
_STEP = 0.1


def write(case, folder):
    """Write nominal.yaml and recordings.h5 of a Case of ``pipeline.blind_trial.generators.belt.belt`` into a folder."""
    case_files.leave(folder, nominal(case), {f"run_{k}": {
        "conditions": {"normal_load": (LOADS[k], "N"), "humidity": (HUMIDITIES[k], "1")},
        "channels": {**case_files.channels(force, shown, RATE), "belt": (belt, "m/s", "velocity", RATE, "excitation")}}
        for k, (force, belt, shown) in enumerate(case.runs)})


def truth(case):
    """What is opened only for the score: see ``pipeline.blind_trial.generators.systems``."""
    known = {**case_files.values(case.belt.truth), "friction": float(case.belt.friction / case.believed)}
    return {"class": case.kind, "effects": case_files.effects(case, _told), "system": "belt_rig", "size": case.change,
            "noise": case.level, "parameters": known, "seed": case.seed, "left": min(case.left, default=0.0),
            "wrong": case.far}


def _told(piece, spot, size):
    return piece.tell(spot, size) if piece.name in FRICTION else parameters(piece, spot, size)


def nominal(case):
    """The case file of the workshop: the rig, Coulomb friction on a recorded belt, and what may be wrong."""
    contact, friction = {"tangent": {"mass_0.x": 1}, "normal_force": f"{LOAD:g} N"}, round(float(case.believed), 6)
    stated = case_files.beliefs(case.belief, case.exact) | {"friction": {"spread": SPREAD}}
    return {
        "chain": "lumped_bench", "title": "Rig on a belt",
        "description": "Masses pushed by a shaker, the first rubbing on a belt under several loads.",
        "lumped": {**case_files.parts(case.belief), "contacts": {"belt": contact}},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": f"{_STEP / RATE:g} s", "friction": friction, "drive": {"channel": "belt"},
                  "inputs": {"shaker": {"channel": "force"}}, "channels": case_files.sensors(case.belief)},
        "diagnosis": case_files.asked(case, stated)}
