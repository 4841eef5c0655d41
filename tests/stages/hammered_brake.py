"""A brake at rest under the hammer: full finite-element matrices with springs added by hand, responses with noise.

Nothing here reduces a body or knows the model of a stage: modes are those of the sparse matrices of the whole brake.
"""

from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.physics.contact.static_preload import condense, contact_law, solve_preload
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.products import ModalTest, ResponseFunctions, TestModes, TestResponses
from pipeline.systems import disc_brake
from stages.structure import Settings as Structure

COARSE = {"disc": {"web_cells": 2, "ring_cells": 3, "angular_cells": 20},
          "pad": {"patches_angular": 3, "patches_radial": 2, "cells_per_patch": 1, "lining_layers": 1},
          "caliper": {"radial_cells": 2, "angular_cells": 4, "housing_cells": 2, "bridge_cells": 2}}
FINER = {"disc": {"web_cells": 2, "ring_cells": 4, "angular_cells": 26},
         "pad": {"patches_angular": 3, "patches_radial": 2, "cells_per_patch": 2, "lining_layers": 1},
         "caliper": {"radial_cells": 2, "angular_cells": 5, "housing_cells": 3, "bridge_cells": 2}}
#: points in mm and directions of measurement, by body
POINTS = {
    "disc": [(155, 0, 3.4), (140, 66, 3.4), (80, 133, 3.4), (-40, 150, 3.4), (-155, 0, 3.4), (-100, -118, 3.4),
             (53, -146, 3.4)],
    "pad_outer": [(86, 40, 20), (150, 0, 20), (122, 0, 20), (95, 0, 20), (136, 63, 20), (136, -63, 20)],
    "pad_inner": [(86, 40, -20), (150, 0, -20), (122, 0, -20), (95, 0, -20), (136, 63, -20), (136, -63, -20)],
    "caliper": [(180, 0, 30), (165, 73, -30), (165, -73, -30), (97, 0, 35), (92, 40, -65), (92, -40, -65)]}


def points():
    """The points as the section model_update states them."""
    return [{"place": f"{body} {k}", "position": [f"{x} mm" for x in position], "body": body}
            for body, each in POINTS.items() for k, position in enumerate(each)]


def brake_of(sections):
    """(DiscBrake, its settings) of sections of ``structure``."""
    settings = Structure(**sections)
    parts = {name: getattr(settings, name) for name in ("disc", "pad", "caliper", "bracket", "piston", "joints")}
    return disc_brake.build(SimpleNamespace(**parts, sensors=())), settings


def full_modes(sections, below, pressed=None):
    """(DiscBrake, frequency (m,) Hz, shape (3 nodes of all bodies, m)) of the whole brake below a frequency.

    ``pressed``: force of the piston in N, normal and tangential stiffness in Pa/m at the mean pressure, in proportion
    to which each patch is stiff; None of lifted pads.
    """
    brake, _ = brake_of(sections)
    matrices = [body.matrices() for body in brake.bodies]
    first = np.cumsum([0, *(len(m[0].indptr) - 1 for m in matrices)])
    free = np.concatenate([a + free_freedoms(len(b.mesh.node), b.supported)
                           for a, b in zip(first, brake.bodies, strict=False)])
    stiffness, mass = (scipy.sparse.block_diag([m[k] for m in matrices], "csr") for k in (0, 1))
    joints = brake.joints
    stiffness = stiffness + joints.rows.matrix.T @ scipy.sparse.diags(joints.stiffness) @ joints.rows.matrix
    stiffness, mass = stiffness[free][:, free], mass[free][:, free]
    if pressed is not None:
        normal, along = _contacts(brake, stiffness, free, *pressed)
        contacts = brake.contacts
        for rows, size in ((contacts.normal, normal), (contacts.tangent, along), (contacts.lateral, along)):
            stiffness = stiffness + rows.matrix[:, free].T @ scipy.sparse.diags(size) @ rows.matrix[:, free]
    frequency, modes = lowest_modes(stiffness, mass, "superlu", below=below)
    shape = np.zeros((first[-1], len(frequency)))
    shape[free] = modes
    return brake, frequency, shape


def _contacts(brake, stiffness, free, force, normal, along):
    """Normal and tangential stiffness (c,) N/m of the patches under a force of the piston."""
    rows, piston = brake.contacts.normal.matrix[:, free], brake.piston.matrix[:, free].toarray()[0]
    pressure = force / brake.pad_area
    law = contact_law([10 * pressure], [10 * normal], 100 * pressure)       # k = p times normal / pressure
    found = solve_preload(*condense(stiffness, rows, piston * force, "superlu"), brake.contacts.area, *law)
    return found.force * normal / pressure, found.force * along / pressure


def motions(brake, shape):
    """(names [n], motion (n, m)) of all points in all three directions, at the nodes next to them."""
    names, moved, first = [], [], 0
    for body, solid in zip(brake.names, brake.bodies, strict=True):
        for k, position in enumerate(POINTS.get(body, ())):
            node = np.linalg.norm(solid.mesh.node - 1e-3 * np.array(position), axis=1).argmin()
            names += [f"{body} {k} direction {axis + 1}" for axis in range(3)]
            moved.append(shape[first + 3 * node:first + 3 * node + 3])
        first += 3 * len(solid.mesh.node)
    return names, np.vstack(moved)


def hammered(sections, struck, band, pressed=None, seed=7, error=2e-5, noise=0.01):
    """(ResponseFunctions, ModalTest): modes in a ``band`` in Hz as a test with 1 % noise finds them.

    Accelerances at all points for blows at the places ``struck``. Modes that none of the responses shows above the
    noise of the strongest are missing.
    """
    random = np.random.default_rng(seed)
    brake, frequency, shape = full_modes(sections, band[1], pressed)
    names, motion = motions(brake, shape)
    residue = np.vstack([motion * motion[names.index(name)] for name in struck]).T * -2j * np.pi * frequency[:, None]
    size = noise * abs(residue).max() * frequency.min() / frequency[:, None]
    seen = (frequency > band[0]) & (abs(residue).max(axis=1) > 3 * size[:, 0])
    frequency, residue, size = frequency[seen], residue[seen], size[seen]
    count, lines, empty, places = len(frequency), np.arange(3.0), np.zeros(0), names * len(struck)
    references = [name for name in struck for _ in names]
    test = TestModes(
        frequency=frequency * (1 + error * random.standard_normal(count)), frequency_std=error * frequency,
        damping_ratio=np.full(count, 4e-3), damping_ratio_std=np.full(count, 1e-5), narrow=np.zeros(count, int),
        partner=np.arange(count), place=places, reference=references,
        shape=residue + noise * abs(residue).max(axis=1, keepdims=True) * random.standard_normal(residue.shape),
        shape_std=noise * abs(residue), likeness=np.eye(count), noise=np.zeros(len(places)), line=lines, measured=lines,
        fitted=lines, order=empty.astype(int), pole_frequency=empty, pole_damping=empty, stable=empty.astype(int),
        chosen=empty.astype(int))
    return given(places, references, lines, np.ones((len(places), 3), complex)), ModalTest(runs={"hammer": test})


def given(places, references, line, response):
    """ResponseFunctions of accelerances."""
    return ResponseFunctions(tests={"hammer": TestResponses(
        line=line, response=response, coherence=np.empty((0, len(line))), label=places,
        unit=["m/s^2/N"] * len(places), place=places, reference=references, method="given", averages=[0], left_out=[],
        decay=0.0, remark=[])})


def responses(names, frequency, motion, struck, line, damping=0.004, noise=0.01):
    """ResponseFunctions of accelerances at all points for hammer blows at places ``struck``, noise of 1 %."""
    random, omega = np.random.default_rng(7), 2 * np.pi * line
    poles = (2 * np.pi * frequency)[:, None]
    modal = -omega**2 / (poles**2 - omega**2 + 2j * damping * poles * omega)
    rows, places, references = [], [], []
    for name in struck:
        rows.append((motion * motion[names.index(name)]) @ modal)
        places, references = places + names, references + [name] * len(names)
    clean = np.vstack(rows)
    size = noise * np.sqrt(np.mean(abs(clean) ** 2, axis=1, keepdims=True) / 2)
    noisy = clean + size * (random.standard_normal(clean.shape) + 1j * random.standard_normal(clean.shape))
    return given(places, references, line, noisy)
