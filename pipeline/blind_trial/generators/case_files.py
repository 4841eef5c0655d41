"""Files of a case as others would write them: nominal.yaml and recordings.h5; and the truth, which stays apart."""

from pathlib import Path

import h5py
import yaml

from pipeline.blind_trial.generators.spring_mass.imitating_laws import APART, beside_the_other, rivals
from pipeline.blind_trial.generators.spring_mass.reported_values import alike, parameters
from pipeline.blind_trial.generators.spring_mass.rig_case import CORNER, DELAY, GAIN_ERROR, LEVELS, SPREAD
from pipeline.contract.errors import ConfigError

_CONFIGS = Path(__file__).parents[3] / "configs"


def leave(folder, document, runs):
    """Write nominal.yaml and recordings.h5 into a folder that is made where it is missing.

    ``runs`` {run: {"conditions": {name: (value, unit)}, "channels": {name: (samples, unit, quantity, rate Hz, role)},
    "repeat_of"*: run, "topography"* {name: (heights m, pixel m, body, state)}, "friction"* {name: {column: values}},
    "lines"* {name: (frequencies Hz, their tolerance Hz)}}}.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "nominal.yaml").write_text(yaml.safe_dump(document, sort_keys=False), encoding="utf-8")
    with h5py.File(folder / "recordings.h5", "w") as h5:
        for name, run in runs.items():
            group = h5.create_group(f"runs/{name}")
            group.attrs["repeat_of"] = run.get("repeat_of", "")
            for key, (value, unit) in run["conditions"].items():
                _attributes(group.create_dataset(f"conditions/{key}", data=value), units=unit)
            for key, (samples, unit, quantity, rate, role) in run["channels"].items():
                _attributes(group.create_dataset(f"channels/{key}", data=samples, compression="gzip"), units=unit,
                            quantity=quantity, sample_rate=rate, role=role)
            for key, (heights, pixel, body, state) in run.get("topography", {}).items():
                _attributes(group.create_dataset(f"topography/{key}", data=heights, compression="gzip"), units="m",
                            pixel_size=pixel, body=body, state=state)
            for key, (lines, tolerance) in run.get("lines", {}).items():
                group.create_dataset(f"lines/{key}/frequency", data=lines)
                group.create_dataset(f"lines/{key}/frequency_tolerance", data=[tolerance] * len(lines))
            for key, columns in run.get("friction", {}).items():
                for column, values_of in columns.items():
                    group.create_dataset(f"friction/{key}/{column}", data=values_of)


def stated(name):
    """A case of ``configs``: what the drawings of a bench say."""
    path = _CONFIGS / name
    if not path.exists():
        raise ConfigError("trial", f"the case {path}", "none", "make such trials in a checkout of the project")
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def write(case, folder):
    """Write nominal.yaml and recordings.h5 of a Case into a folder."""
    leave(folder, nominal(case), {f"run_{k}": {"conditions": {"level": (LEVELS[k], "N")},
                                               "channels": channels(force, shown, case.rate)}
                                  for k, (force, shown) in enumerate(case.runs)})


def channels(force, shown, rate):
    """Channels of a run: the force of the shaker (n,) N and displacements (sensor, n) m."""
    return {"force": (force, "N", "force", rate, "excitation"),
            **{f"x_{k}": (samples, "m", "displacement", rate, "response") for k, samples in enumerate(shown)}}


def truth(case, looked_for=("effect", "foreign")):
    """What is opened only for the score: see ``pipeline.blind_trial.generators.systems``.

    ``left`` is d of ``spring_mass.detectability``: of the weaker of a pair, the other refitted; of physics that no
    catalogue holds, beside the nearest known law. Laws that leave less than can be told are alike; they are
    ``looked_for`` in cases of these classes.
    """
    near = rivals(case) if case.kind in looked_for else []
    listed = effects(case, parameters)
    hidden = [{**entry, "alike": alike(p, case.truth)} for entry, p in zip(listed, case.planted, strict=True)]
    for taken in ({"name": entry.name, "place": entry.place} for entry in near if entry.left < APART):
        hidden[0]["alike"] += [taken] * (taken not in hidden[0]["alike"])
    left = [*case.left, *(entry.left for entry in near if case.kind == "foreign")]
    left += beside_the_other(case) if case.kind == "pair" else ()
    return {"class": case.kind, "effects": hidden, "system": "forced_rig", "size": case.change,
            "noise": case.level, "parameters": values(case.truth), "seed": case.seed, "colour": case.colour,
            "left": min(left, default=0.0), "wrong": case.far, "reach": case.reach}


def effects(case, told):
    """[{name, place, parameters, left}] of what is planted; ``told(piece, spot, size)`` -> {parameter: SI value}."""
    return [{"name": p.piece.name, "place": p.place, "parameters": told(p.piece, p.spot, p.size), "left": left}
            for p, left in zip(case.planted, case.left, strict=False)]


def values(rig):
    """{name in the case: value} of masses (kg), stiffnesses (N/m) and dampings (N s/m) of a Rig."""
    links = {f"joints.link_{k}.{what}": getattr(link, what) for k, link in enumerate(rig.links)
             for what in ("stiffness", "damping")}
    return {**{f"masses.mass_{k}": m for k, m in enumerate(rig.mass)}, **links}


def beliefs(rig, exact):
    """{name in the case: how far it may be off} of all values of a Rig but those ``exact``, and of the gains."""
    name_of = {f"masses.mass_{k}": f"mass_{k}" for k in range(len(rig.mass))}
    for k in range(len(rig.links)):
        name_of |= {f"joints.link_{k}.{what}": f"{what}_{k}" for what in ("stiffness", "damping")}
    return {**{name: {"spread": SPREAD} for name, short in name_of.items() if short not in exact},
            **{f"channels.x_{k}.gain": {"spread": GAIN_ERROR} for k in range(len(rig.mass))}}


def parts(rig):
    """Section ``lumped`` of a Rig: masses, springs, shaker and sensors."""
    names = range(len(rig.mass))
    return {"masses": {f"mass_{k}": {"mass": f"{m:.6g} kg", "moves": ["x"]} for k, m in enumerate(rig.mass)},
            "springs": {f"link_{k}": _spring(link) for k, link in enumerate(rig.links)},
            "inputs": {"shaker": {"along": {f"mass_{rig.pushed}.x": 1}, "force": "1 N"}},
            "sensors": {f"mass_{k}": {"along": {f"mass_{k}.x": 1}, "quantity": "displacement", "unit": "m"}
                        for k in names}}


def sensors(rig):
    """Channels of the section ``bench`` of a Rig."""
    return {f"x_{k}": {"quantity": "displacement", "source": f"mass_{k}", "corner": f"{CORNER:g} Hz",
                       "delay": f"{DELAY:g} s"} for k in range(len(rig.mass))}


def asked(case, beliefs_of):
    """Section ``diagnosis`` of a case: what may be off, the last run held out, the noise of the sensors."""
    return {"parameters": beliefs_of, "held_out": [f"run_{len(case.runs) - 1}"],
            "noise": {"std": {f"x_{k}": f"{s:.6g} m" for k, s in enumerate(case.noise)}}}


def nominal(case):
    """The case file of the workshop: its beliefs, its sensors, and what of it may be wrong."""
    return {
        "chain": "lumped_bench", "title": "Rig", "description": "Masses between walls, pushed by a shaker.",
        "lumped": parts(case.belief),
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": f"{case.step:g} s", "inputs": {"shaker": {"channel": "force"}},
                  "channels": sensors(case.belief)},
        "diagnosis": asked(case, beliefs(case.belief, case.exact))}


def _spring(link):
    far = f"mass_{link.far}.x" if link.far >= 0 else "ground"
    return {"between": [f"mass_{link.near}.x", far], "stiffness": f"{link.stiffness:.6g} N/m",
            "damping": f"{link.damping:.6g} N s/m"}


def _attributes(dataset, **values):
    for name, value in values.items():
        dataset.attrs[name] = value
