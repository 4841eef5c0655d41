"""Files of a case of a switching rig, in the units of its workshop, and its truth."""

import numpy as np

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.switching.hidden import MEANS, PIECES, RATIOS
from pipeline.blind_trial.generators.switching.recalibration import GAIN_SPREAD, SPREAD
from pipeline.blind_trial.generators.switching.rig import WALL
from pipeline.blind_trial.generators.switching.switching_case import LEAST, LEVELS, made

#: steps of the workshop's model in a period of the fastest mode, at least
_STEPS = 100
#: laws of a wall spring -> those of an input that make the same force
_OF_INPUT = {"base_shake": "pressure_ripple", "viscoelastic_pad": "hydraulic_compliance"}
#: friction of both ways and of one, which are one law but for a constant force
_DRY = ("coulomb", "asymmetric_friction")
#: changes of a linear rig that are one of the scale of its motion, at other values
_RESCALED = ("compliant_arm", "added_stiffness", "attached_mass")
#: kind of a value -> (name in the case, units that it is stated in with their size in SI)
_UNITS = {"mass": {"kg": 1.0, "g": 1e-3}, "stiffness": {"N/m": 1.0, "N/mm": 1e3, "kN/m": 1e3},
          "damping": {"N s/m": 1.0, "kN s/m": 1e3}}
#: third of what a pair hides where its laws act at two springs, or at one
APART, BESIDE = "two springs", "one spring"


def write(draw, folder):
    """Write the case of a Draw into a folder; its truth, as ``generators.systems`` specifies it.

    Of a pair ``draw.hidden`` names the two laws and, third, whether they are APART.
    """
    form, second, where = (*draw.hidden, "", "", "")[:3]
    case = made(draw.seed, draw.kind, form, draw.noise, second, where == APART)
    case_files.leave(folder, nominal(case), recorded(case))
    return {**truth(case), "system": draw.system}


def spring(index):
    return f"mount_{index + 1}"


def body(index):
    return f"body_{index + 1}"


def place(case):
    """Name of the place of what a Case hides."""
    piece = PIECES.get(case.form)
    if piece is None:
        return case.sensors[case.index].name
    return body(case.index) if piece.place == "mass" else spring(case.index)


def alike(case):
    """[{name, place}] of what shows the same: laws of the input whose force is that of the hidden one, at a spring of
    what it pushes; of two channels that see a motion of unknown size the other one, as their ratio is all that shows.

    Friction of two strengths, one each way, is that of their mean and a constant force, which moves the position of
    rest alone: where the difference does not show, it is a name for the mean as well. Of one body seen by one sensor
    all changes of the linear rig but of its damping are a gain of that sensor, at other values; an added spring is one
    with a slider that never slips.
    """
    if case.name in _DRY and (case.beyond < LEAST or all(s.quantity != "displacement" for s in case.sensors)):
        return [{"name": _DRY[1], "place": place(case)}]
    if case.form in _RESCALED and len(case.truth.mass) == len(case.sensors) == 1:
        stuck = [{"name": "jenkins", "place": spring(0)}] if case.form == "added_stiffness" else []
        return [{"name": "sensor_gain", "place": case.sensors[0].name}, *stuck]
    if case.form in RATIOS and len(case.sensors) == 2 and all(run.free for run in case.runs):
        return [{"name": case.name, "place": s.name} for k, s in enumerate(case.sensors) if k != case.index]
    pushed = not any(run.free == "start" for run in case.runs) and case.way != "wall"
    if case.name in _OF_INPUT and pushed and case.truth.ends[case.index] == (case.at, WALL):
        return [{"name": _OF_INPUT[case.name], "place": "push"}]
    return []


def truth(case):
    """What is opened only for the score: see ``pipeline.blind_trial.generators.systems``."""
    values = {_named(name): float(case.truth.value(name)) for name in case.truth.names}
    return {"class": case.kind, "effects": _hidden(case) if case.form else [], "noise": case.level, "size": case.change,
            "parameters": values, "left": case.left, "seed": case.seed, "colour": case.colour, "wrong": case.far,
            "way": case.way, "form": case.form, "gaps": case.gap, "amount": case.size, "bodies": len(case.truth.mass),
            "a_period": case.rate / float(case.truth.frequencies[-1])}


def _hidden(case):
    """What a Case hides, in the words of the catalogue, where friction of one way comes on top of that of both ways:
    of two strengths the mean, and what differs where it shows."""
    told = {"place": place(case), "parameters": case.told, "alike": alike(case)}
    if case.second:
        second = case.second
        return [{"name": case.name, **told, "alike": []},
                {"name": second.name, "place": spring(second.index), "parameters": second.told, "alike": []}]
    if case.form not in MEANS:
        return [{"name": case.name, **told}]
    mean = {"name": MEANS[case.form], **told}
    return [mean] if told["alike"] else [mean, {**mean, "name": case.name}]


def _named(name):
    """Name in the case of a value of a Rig."""
    kind, index = name.split(".")
    return f"masses.{body(int(index))}" if kind == "mass" else f"joints.{spring(int(index))}.{kind}"


def recorded(case):
    """{run: its conditions and channels} as ``case_files.leave`` takes them."""
    runs = {}
    for k, (run, shown) in enumerate(zip(case.runs, case.shown, strict=True)):
        channels = {s.name: (row, s.unit, s.quantity, case.rate, "response")
                    for s, row in zip(case.sensors, shown, strict=True)}
        if not run.free:
            unit, size, quantity = ("um", 1e-6, "displacement") if case.way == "wall" else ("kN", 1e3, "force")
            channels["drive"] = (run.drive.shown(run.time) / size, unit, quantity, case.rate, "excitation")
        runs[f"take_{k + 1}"] = {"conditions": {} if run.free else {"level": (LEVELS[k], "1")}, "channels": channels}
    return runs


def nominal(case):
    """The case file of the workshop: its beliefs, its sensors, and what of it may be wrong."""
    free = {_named(name): {"spread": SPREAD} for name in case.truth.names if name not in case.exact}
    gains = {f"channels.{s.name}.gain": {"spread": GAIN_SPREAD} for s in case.sensors}
    return {
        "chain": "lumped_bench", "title": "Bench", "description": "Bodies on mounts.",
        "lumped": {"masses": {body(k): {"mass": _stated(case, "mass", k), "moves": ["x"]}
                              for k in range(len(case.belief.mass))},
                   "springs": {spring(k): _spring(case, k) for k in range(len(case.belief.ends))},
                   **_inputs(case),
                   "sensors": {body(s.body): {"along": {f"{body(s.body)}.x": 1}, "quantity": s.quantity,
                                                      "unit": s.si} for s in case.sensors}},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": f"{_step(case):.9g} s", **_fed(case), "channels": {s.name: {
            "quantity": s.quantity, "source": body(s.body), "corner": f"{s.stated_corner:.6g} Hz",
            "delay": f"{s.stated_delay:.6g} s"} for s in case.sensors}},
        "diagnosis": {"parameters": free | gains, "held_out": [f"take_{len(case.runs)}"],
                      "noise": {"std": {s.name: f"{std:.6g} {s.si}"
                                        for s, std in zip(case.sensors, case.noise, strict=True)}}}}


def _step(case):
    """Longest step, a whole fraction of the sampling interval."""
    return 1 / (case.rate * np.ceil(_STEPS * case.truth.frequencies[-1] / case.rate))


def _stated(case, kind, index):
    """A value with a unit that depends on the case."""
    units = _UNITS[kind]
    unit = list(units)[(case.seed + index) % len(units)]
    return f"{getattr(case.belief, kind)[index] / units[unit]:.6g} {unit}"


def _spring(case, index):
    near, far = case.belief.ends[index]
    return {"between": [f"{body(near)}.x", "ground" if far == WALL else f"{body(far)}.x"],
            "stiffness": _stated(case, "stiffness", index), "damping": _stated(case, "damping", index)}


def _inputs(case):
    """Section ``inputs`` of the model: none of a release."""
    if case.way == "release":
        return {}
    if case.way == "wall":
        return {"inputs": {"wall": {"displaces": spring(case.at), "displacement": "1 m"}}}
    return {"inputs": {"push": {"along": {f"{body(case.at)}.x": 1}, "force": "1 N"}}}


def _fed(case):
    """What of the section ``bench`` says how runs begin and are driven."""
    if case.way == "release":
        return {"start": "fitted"}
    if case.way == "blow":
        return {"blow": "push"}
    hold = "step" if case.way == "steps" else "band_limited"
    return {"inputs": {"wall" if case.way == "wall" else "push": {"channel": "drive", "hold": hold}}}
