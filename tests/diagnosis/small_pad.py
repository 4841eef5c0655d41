"""A small rough pair of the chain and recordings of it: full runs, with other values and hidden physics."""

import json
from functools import cache

import numpy as np

from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, rubbing_with_effects
from pipeline.case_models.rough.pair import Settings, rubbing
from pipeline.contract.settings import fill
from pipeline.physics.rough.sliding_pair import slide, states
from pipeline.products import MeasuredFriction, Recording, Run, Topography
from stages.micro_friction import micro_friction
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface

PRESSURES, SPEEDS, CYCLES = (1e6, 1.6e6, 2.4e6, 3.4e6), (0.9, 1.3, 1.8), (0, 3, 6, 12)
SECTION = {"pressures": ["1 MPa", "3 MPa"], "disc_speeds": ["7 rad/s", "14 rad/s"], "cycles": 12, "realisations": 1,
           "recorded_distances": ["0 mm", "5 mm", "10 mm"], "refinement": [1.0]}
ASKED = {"forward": "friction", "held_out": ["drag_2"], "draws": 2000,
         "rubbing": {"pressures": 5, "distances": 6, "model_error": 0.01},
         "parameters": {"disc_strength": {"spread": 0.15}, "pad.wear_coefficient": {"spread": 0.2},
                        "disc.wear_coefficient": {"spread": 0.2}}}
STD = 0.004
FILM = {"third_body_film": {"asperities": {"gain": 0.5, "distance": "2 mm", "pressure": "2 MPa"}}}
TRANSFER = {"material_transfer": {"asperities": {"share": 0.6}}}


@cache
def rough():
    """Product Surface: 32 nodes, 8 on the shortest wavelength."""
    return surface(settings=SurfaceSettings(nodes=32, shortest_wavelength="250 um"))


@cache
def micro():
    """Product MicroFriction as the case has it."""
    return micro_friction(rough(), settings=Settings(**SECTION))


def effects(given):
    return product(fill(EffectSettings, given, "effects"))


def values(strength=1.0, wear=1.0):
    """The section with other values."""
    found = Settings(**SECTION)
    return found.model_copy(update={"disc_strength": strength * found.disc_strength, "pad": found.pad.model_copy(
        update={"wear_coefficient": wear * found.pad.wear_coefficient})})


def recording(hidden=None, section=None, faces=True, seed=0):
    """Product Recording of full runs, with noise: friction of every pressure, the faces before and after. Read only:
    made once."""
    key = json.dumps(hidden), (section or values()).model_dump_json(), faces, seed
    if key not in _RECORDINGS:
        _RECORDINGS[key] = _recorded(hidden, section or values(), faces, seed)
    return _RECORDINGS[key]


_RECORDINGS = {}


def _recorded(hidden, section, faces, seed):
    random = np.random.default_rng(seed)
    pair = rubbing_with_effects(rubbing(rough(), section), hidden and effects(hidden))
    new = {b: getattr(rough(), f"{b}_height")[0] for b in ("pad", "disc")}
    runs = {"faces": _run({}, {f"{b}_new": _map(random, h, b, "new") for b, h in new.items()})} if faces else {}
    for number, pressure in enumerate(PRESSURES):
        *_, worn = states(pair, pressure)
        shown = {b: _map(random, new[b] - getattr(worn, f"{b}_wear"), b, "worn") for b in new} if faces else {}
        runs[f"drag_{number}"] = _run({"load_cell": _friction(random, pair, pressure)}, shown)
    return Recording(source=["small pad"], runs=runs)


def _friction(random, pair, pressure):
    told = slide(pair, pressure, np.array(SPEEDS), list(CYCLES)).friction.T.ravel()
    way, speed = np.meshgrid(np.array(CYCLES) * pair.wearing.distance, SPEEDS, indexing="ij")
    even = np.ones(told.size)
    return MeasuredFriction(friction=told + STD * random.standard_normal(told.size), friction_std=STD * even,
                            pressure=pressure * even, speed=speed.ravel(), distance=way.ravel(),
                            temperature=293.15 * even)


def _map(random, height, body, state):
    seen = height + 1e-6 + 5e-9 * random.standard_normal(height.shape)
    return Topography(y=rough().y, x=rough().x, height=seen, body=body, state=state)


def _run(friction, topography):
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "lines")}
    return Run(description="", repeat_of="", friction=friction, topography=topography, **empty)
