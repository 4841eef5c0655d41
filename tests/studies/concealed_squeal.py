"""'make study_concealed': does the brake squeal whose physics a diagnosis had to find, how likely, and what helps?

The benches of ``brake_stops`` hide an effect. ``brakechain run`` diagnoses one and writes the case that asks whether
the brake squeals; that is run with a scatter of production and a countermeasure, and so is the workshop's own model
without the diagnosis. What is true is computed by the program that made the bench, which the tool never sees: unstable
modes at every operating point, and the share of its own draws of the same scatter that squeal, before and after.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.blind_trial.generators.brake import squealing_brake
from pipeline.blind_trial.generators.brake.brake_parts import SHAPES, built
from pipeline.contract import documents, store
from pipeline.contract.units import to_si
from pipeline.products import ComplexModes, Countermeasures, Probability
from tests.commands import brakechain
from tests.studies import brake_stops

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "configs" / "squealing_brake_bench.yaml"
PRACTICE = ROOT / "data" / "runs" / "practice"
#: coefficients of variation of production: joints, contacts; standard deviation of friction
JOINTS, SPREAD, FRICTION = ("abutment_outer", "abutment_inner", "fingers"), 0.2, 0.05
#: countermeasure: what stands in for the abutments' stiffness, in multiples of it
CHANGED, STIFFER = JOINTS[:2], 1.3
#: growth rate in 1/s that counts as squeal, as some mode grows in nearly all draws; draws of the tool and of the truth
SQUEALS, DRAWS, TRUE_DRAWS = 300.0, 400, 300
#: lowest and highest frequency in Hz that the bench was asked about
BAND = (350.0, 3600.0)


@dataclass(frozen=True)
class Squeal:
    """What is said of a brake: ``roots`` [(r,) 1/s] at the operating points; the share of draws that squeals at any of
    them, ``before`` and ``after`` the countermeasure."""

    roots: list
    before: float
    after: float


def asked(document):
    """The case ``document`` with the scatter and the countermeasure."""
    stiffer = {f"lumped.springs.{name}.stiffness": f"{STIFFER * _stiffness(document, name)!r} N/m" for name in CHANGED}
    kinds = [{"kind": "joint_stiffness", "part": name, "variation": SPREAD} for name in JOINTS]
    kinds += [{"kind": "contact_stiffness", "variation": SPREAD}, {"kind": "friction", "variation": FRICTION}]
    return {**document, "probability": {
        "sources": kinds, "draws": DRAWS, "interval": 0, "least_growth": f"{SQUEALS} 1/s"}, "countermeasures": {
        "variants": {"stiffer_abutments": {"change": stiffer}}}}


def _stiffness(document, name):
    given = document["lumped"]["springs"][name]["stiffness"]
    return to_si(given["value"] if isinstance(given, dict) else given, "N/m", name)


def computed(document, folder):
    """Squeal of a case ``document`` by its products in a folder."""
    file = folder / "case.yaml"
    file.write_text(documents.yaml_text(document), encoding="utf-8")
    brakechain("run", file, "--run", folder)
    modes, drawn, other = (store.read(each, folder / f"{each.name}.h5")
                           for each in (ComplexModes, Probability, Countermeasures))
    roots = [modes.unstable_root[modes.unstable_operating == k] for k in range(len(modes.operating_speed))]
    return Squeal(roots, float(drawn.overall), float(other.variant_overall[0]))


def true(number, points):
    """Squeal of the brake of a practice file at ``points`` [(N, rad/s)], by the program that made it."""
    whole, truth = brake_stops.made(number)
    random, values, hidden = np.random.default_rng(number), truth["values"], whole.hidden
    width = np.sqrt(np.log1p(SPREAD**2))
    hits = np.zeros(2)
    for _ in range(TRUE_DRAWS):
        drawn = {**values, **{name: values[name] * np.exp(width * random.standard_normal())
                              for name in (*JOINTS, "contact")}}
        drawn["friction"] = values["friction"] + FRICTION * random.standard_normal()
        for k, factor in enumerate((1.0, STIFFER)):
            changed = _brake({**drawn, **{name: factor * drawn[name] for name in CHANGED}}, hidden)
            hits[k] += any((_growing(changed, *point).real > SQUEALS).any() for point in points)
    return Squeal([_growing(whole, *point) for point in points], *(float(share) for share in hits / TRUE_DRAWS))


def _brake(values, hidden):
    return squealing_brake.inclined(built(values, SHAPES[0], hidden=hidden), values)


def _growing(whole, load, speed):
    roots = squealing_brake.growing(whole, load, speed)
    return roots[(roots.imag > 2 * np.pi * BAND[0]) & (roots.imag < 2 * np.pi * BAND[1])]


def nominal(document):
    """The case of the workshop's model, not diagnosed, at the operating points of the completed ``document``."""
    given = documents.read_yaml(CONFIG)
    lumped = {**given["lumped"], "load_factors": document["lumped"]["load_factors"]}
    friction = {**document["complex_modes"], "friction": given["bench"]["friction"]}
    return {**{key: document[key] for key in ("chain", "title", "description")}, "lumped": lumped,
            "complex_modes": friction}


def diagnosed(number, folder):
    """The case that a diagnosis of a practice file leads to, as it is written beside it."""
    file = PRACTICE / f"squealing_brake_{number}.h5"
    brakechain("run", CONFIG, "--run", folder, "--set", f"recording.files.0.file={file}", "--set",
               "diagnosis.saturated_squeal=null")
    return documents.read_yaml(folder / f"{CONFIG.stem}_squeal.yaml")


def points_of(document):
    """[(N, rad/s)] of the operating points of a case, in their order."""
    force = to_si(document["lumped"]["inputs"]["press"]["force"], "N", "press")
    loads = [force * to_si(load, "Pa", "load") for load in document["lumped"]["load_factors"]]
    return [(load, to_si(speed, "rad/s", "speed")) for load in loads for speed in document["complex_modes"]["speeds"]]


def compared(truth, told):
    """(largest error of the frequency and of the growth rate of the strongest mode over the operating points, as a
    share; errors of both probabilities) of what is ``told``, a Squeal, beside the ``truth``."""
    none = complex(np.nan, np.nan)
    strongest = [[roots[np.argmax(roots.real)] if len(roots) else none for roots in each.roots]
                 for each in (truth, told)]
    true_roots, roots = np.array(strongest)
    return (float(np.max(abs(roots.imag / true_roots.imag - 1))), float(np.max(abs(roots.real / true_roots.real - 1))),
            told.before - truth.before, told.after - truth.after)


def main():
    """Print truth, completed and nominal brake of each practice file that hides an effect."""
    parser = argparse.ArgumentParser(prog="make study_concealed", description=__doc__)
    parser.add_argument("--numbers", type=int, nargs="*", default=[1, 2, 3], help="practice files")
    parser.add_argument("--folder", type=Path, default=ROOT / "data" / "runs" / "study_concealed")
    given = parser.parse_args()
    for number in given.numbers:
        if not (PRACTICE / f"squealing_brake_{number}.h5").exists():
            brake_stops.practice(PRACTICE, (number,))
        document = diagnosed(number, given.folder / f"{number}" / "bench")
        truth = true(number, points_of(document))
        print(f"{number} {brake_stops.PRACTICE[number][1]}: true brake: squeals in {truth.before:.1%} of the draws,"
              f" with stiffer abutments in {truth.after:.1%}", flush=True)
        for name, case in (("completed", document), ("nominal", nominal(document))):
            folder = given.folder / f"{number}" / name
            folder.mkdir(parents=True, exist_ok=True)
            frequency, growth, before, after = compared(truth, computed(asked(case), folder))
            print(f"  {name}: frequency off by {frequency:.2%}, growth rate by {growth:.1%}; probability by"
                  f" {100 * before:+.1f} points, with stiffer abutments {100 * after:+.1f}", flush=True)


if __name__ == "__main__":
    main()
