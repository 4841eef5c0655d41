"""Practice files of configs/squealing_brake_bench.yaml: hammer taps at rest, and stops that squeal.

'make brake_bench' writes them, after those of taps alone. ``python -m tests.studies.brake_stops`` diagnoses them and
prints what each held-out stop shows.
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from pipeline.blind_trial.generators import case_files
from pipeline.blind_trial.generators.brake import brake, brake_files, squealing_brake, squealing_stops
from pipeline.blind_trial.generators.brake.brake_parts import SHAPES, built
from pipeline.contract import documents
from tests.studies.forced import by_stages, recorded

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "configs" / "squealing_brake_bench.yaml"
#: (class, what is hidden) of the files, in the order of their names
PRACTICE = (("control", ""), ("effect", "falling_friction"), ("effect", "pressure_dependent_friction"),
            ("effect", "contact_stiffness_law"))
#: slowest growth in 1/s that saturates within a record; seeds that a draw is tried with, and how far apart they lie
_SLOWEST, _TRIES, _APART = 60.0, 20, 100_000


def made(number):
    """(Brake, truth) of a practice file: of the first seed whose brake squeals at all operating points."""
    kind, hidden = PRACTICE[number]
    for attempt in range(_TRIES):
        seed = number + attempt * _APART
        random = np.random.default_rng([seed, 2])
        values = brake_files.drawn_values(random)
        sizes = {hidden: brake_files.sizes(random, hidden)} if hidden else {}
        whole = squealing_brake.inclined(built(values, SHAPES[0], hidden=sizes), values)
        roots = {squealing_stops.name(*point): squealing_stops.growing(whole, *point)
                 for point in squealing_stops.POINTS}
        if min(root.real for root in roots.values()) > _SLOWEST:
            break
    truth = {"class": kind, "seed": seed, "values": values,
             "effects": [brake_files.named(*effect) for effect in sizes.items()],
             "stops": {name: {"growth_rate": root.real, "frequency": root.imag / (2 * np.pi)}
                       for name, root in roots.items()}}
    return whole, truth


def write(number, folder):
    """recordings.h5 and truth.json of a practice file in a folder; returns the truth."""
    whole, truth = made(number)
    taps = [run for run in brake.campaign() if run.speed == 0]
    runs = brake.record(whole, truth["seed"], taps) | squealing_stops.record(whole, truth["seed"])
    case_files.leave(folder, {}, runs)
    (folder / "nominal.yaml").unlink()
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n")
    return truth


def practice(folder, numbers=None):
    """squealing_brake_0.h5 ... of PRACTICE, each with its truth beside it; ``numbers``: of these alone."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(len(PRACTICE)) if numbers is None else numbers:
        with TemporaryDirectory(dir=folder) as there:
            write(number, Path(there))
            (Path(there) / "recordings.h5").replace(folder / f"squealing_brake_{number}.h5")
            (Path(there) / "truth.json").replace(folder / f"squealing_brake_{number}_truth.json")


def solved(path, **asked):
    """diagnosis.json of a file of recordings under the case squealing_brake_bench."""
    return by_stages(documents.read_yaml(CONFIG), recorded(path), **asked)


def main():
    """Diagnose the practice files, print their verdicts."""
    for number in range(len(PRACTICE)):
        answer = solved(ROOT / "data" / "runs" / "practice" / f"squealing_brake_{number}.h5", saturated_squeal=None)
        named = ", ".join(f"{e['name']} at {e['place']}" for e in answer["effects"])
        print(f"{number} {PRACTICE[number][1] or 'control':<28} -> {answer['verdict']:<10} {named}", flush=True)


if __name__ == "__main__":
    main()
