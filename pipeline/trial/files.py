"""Files of a case as others would write them: nominal.yaml and recordings.h5; and the truth, which stays apart."""

from pathlib import Path

import h5py
import yaml

from pipeline.trial.case import CORNER, DELAY, GAIN_ERROR, LEVELS, SPREAD
from pipeline.trial.told import parameters


def write(case, folder):
    """Write nominal.yaml and recordings.h5 of a Case into a folder that is made where it is missing."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "nominal.yaml").write_text(yaml.safe_dump(nominal(case), sort_keys=False), encoding="utf-8")
    with h5py.File(folder / "recordings.h5", "w") as h5:
        for number, (force, shown) in enumerate(case.runs):
            run = h5.create_group(f"runs/run_{number}")
            _attributes(run.create_dataset("conditions/level", data=LEVELS[number]), units="N")
            _attributes(run.create_dataset("channels/force", data=force), units="N", quantity="force",
                        sample_rate=case.rate, role="excitation")
            for k, samples in enumerate(shown):
                _attributes(run.create_dataset(f"channels/x_{k}", data=samples), units="m", quantity="displacement",
                            sample_rate=case.rate, role="response")


def truth(case):
    """What is opened only for the score: see ``pipeline.trial.systems``; ``left`` is d of ``pipeline.trial.detectable``
    (of the weaker of a pair)."""
    effects = [{"name": p.piece.name, "place": p.place, "parameters": parameters(p.piece, p.spot, p.size), "left": left}
               for p, left in zip(case.planted, case.left, strict=False)]
    return {"class": case.kind, "effects": effects, "system": "forced_rig", "size": case.change,
            "noise": case.level, "parameters": _values(case.truth), "seed": case.seed, "colour": case.colour,
            "left": min(case.left, default=0.0), "wrong": case.far}


def _values(rig):
    """{name in the case: value} of masses (kg), stiffnesses (N/m) and dampings (N s/m) of a Rig."""
    links = {f"joints.link_{k}.{what}": getattr(link, what) for k, link in enumerate(rig.links)
             for what in ("stiffness", "damping")}
    return {**{f"masses.mass_{k}": m for k, m in enumerate(rig.mass)}, **links}


def nominal(case):
    """The case file of the workshop: its beliefs, its sensors, and what of it may be wrong."""
    rig = case.belief
    names = range(len(rig.mass))
    beliefs = {f"masses.mass_{k}": {"spread": SPREAD} for k in names if f"mass_{k}" not in case.exact}
    for k in range(len(rig.links)):
        beliefs |= {f"joints.link_{k}.{what}": {"spread": SPREAD} for what in ("stiffness", "damping")
                       if f"{what}_{k}" not in case.exact}
    beliefs |= {f"channels.x_{k}.gain": {"spread": GAIN_ERROR} for k in names}
    return {
        "chain": "lumped_bench", "title": "Rig", "description": "Masses between walls, pushed by a shaker.",
        "lumped": {
            "masses": {f"mass_{k}": {"mass": f"{m:.6g} kg", "moves": ["x"]} for k, m in enumerate(rig.mass)},
            "springs": {f"link_{k}": _spring(link) for k, link in enumerate(rig.links)},
            "inputs": {"shaker": {"along": {f"mass_{rig.pushed}.x": 1}, "force": "1 N"}},
            "sensors": {f"mass_{k}": {"along": {f"mass_{k}.x": 1}, "quantity": "displacement", "unit": "m"}
                        for k in names}},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": f"{case.step:g} s", "inputs": {"shaker": {"channel": "force"}},
                  "channels": {f"x_{k}": {"quantity": "displacement", "source": f"mass_{k}", "corner": f"{CORNER:g} Hz",
                                          "delay": f"{DELAY:g} s"} for k in names}},
        "diagnosis": {"parameters": beliefs, "held_out": [f"run_{len(case.runs) - 1}"],
                      "noise": {"std": {f"x_{k}": f"{s:.6g} m" for k, s in enumerate(case.noise)}}}}


def _spring(link):
    far = f"mass_{link.far}.x" if link.far >= 0 else "ground"
    return {"between": [f"mass_{link.near}.x", far], "stiffness": f"{link.stiffness:.6g} N/m",
            "damping": f"{link.damping:.6g} N s/m"}


def _attributes(dataset, **values):
    for name, value in values.items():
        dataset.attrs[name] = value
