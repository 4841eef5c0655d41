"""'make worn_bench': practice recordings of configs/worn_pad.yaml, each with its truth; and how they are diagnosed."""

import json
from functools import cache
from pathlib import Path

from pipeline.blind_trial.generators.benches.worn_pad import make, record
from pipeline.contract import documents
from pipeline.contract.settings import without_origins
from pipeline.diagnosis.output.files import as_json
from pipeline.products import Recording
from pipeline.recordings.neutral import read_neutral, write_neutral
from stages.diagnosis import diagnosis
from stages.friction_map import friction_map
from stages.micro_friction import micro_friction
from stages.surface import surface
from tests.studies.forced import filled

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "configs" / "worn_pad.yaml"
#: what the practice files hide, in the order of their numbers; '' is the control
PRACTICE = ("third_body", "transfer", "")


def write(path, seed, hidden):
    """Recordings of one bench at ``path``; returns what is true of it."""
    bench, truth = make(seed, hidden)
    write_neutral(path, record(bench, seed))
    return truth


def practice(folder):
    """worn_0.h5 ... of PRACTICE, each with its truth beside it."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, hidden in enumerate(PRACTICE):
        told = write(folder / f"worn_{number}.h5", number, hidden)
        (folder / f"worn_{number}_truth.json").write_text(json.dumps(told, indent=1) + "\n")


def rubbed(path, context=None, **micro):
    """(Surface, MicroFriction, FrictionMap, Recording) of a file of recordings under the case worn_pad, with other
    values of micro_friction."""
    more = {} if context is None else {"context": context}
    document = _document()
    faces = {body: {"kind": "recorded", "file": str(path), "map": f"{body}_new"} for body in ("disc", "pad")}
    rough = surface(settings=filled(document, surface, **faces))
    pair = micro_friction(rough, settings=filled(document, micro_friction, **micro), **more)
    told = Recording(source=[path.name], runs=read_neutral(path))
    return rough, pair, friction_map(pair, settings=filled(document, friction_map)), told


def solved(path, context=None, **micro):
    """diagnosis.json of the same."""
    rough, pair, mapped, told = rubbed(path, context, **micro)
    more = {} if context is None else {"context": context}
    return as_json(diagnosis(recording=told, surface=rough, micro=pair, friction_map=mapped,
                             settings=filled(_document(), diagnosis), **more))


@cache
def _document():
    """The case worn_pad."""
    return without_origins(documents.read_yaml(CONFIG), CONFIG.stem)


if __name__ == "__main__":
    practice(ROOT / "data" / "runs" / "practice")
