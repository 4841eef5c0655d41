"""Other meshes of a brake, and what they do to its modes."""

import numpy as np
import pytest

from pipeline.case_models.bodies.brake_bodies import Disc
from pipeline.case_models.bodies.free_body import FreeBody
from pipeline.case_models.bodies.other_meshes import off_by_mesh, other_meshes
from pipeline.physics.modal.mode_pairing import grouped
from pipeline.physics.modal.model_updating import ModelModes
from stages.model_update import Settings


def test_a_disc_gets_a_coarser_mesh_and_all_else_a_finer_one():
    given = {"bracket": {"kind": "body"}, "piston": {"kind": "body"}, "pressed": {"force": "1 kN"}}
    (whole, more), (disc, less) = other_meshes(Settings(body="assembly", **given), 1.5)
    assert (disc.disc.web_cells, disc.disc.ring_cells, disc.disc.angular_cells) == (3, 7, 60)
    assert whole.disc == Disc() == disc.disc.model_copy(update={"web_cells": 4, "ring_cells": 10, "angular_cells": 90})
    assert (whole.pad.cells_per_patch, whole.pad.lining_layers, whole.pad.patches_angular) == (3, 3, 6)
    assert whole.bracket.element_size == pytest.approx(0.01 / 1.5) and whole.piston.angular_cells == 24
    assert more == pytest.approx(1.8) and less == pytest.approx(-0.8)


def test_a_disc_that_is_no_part_of_the_test_keeps_its_mesh():
    assert [each.disc for each, _ in other_meshes(Settings(body="assembly"), 1.5)] == [Disc()]
    assert len(other_meshes(Settings(body="pad"), 2.0)) == 1
    (disc, factor), = other_meshes(Settings(body="disc", disc={"web_cells": 2}), 2.0)
    assert disc.disc.web_cells == 2 and factor == pytest.approx(-1 / 3)


def test_groups_are_followed_by_shape_not_by_order():
    """Two modes that change places, a third that only one mesh has."""
    shape = np.eye(3)
    coarse, fine = (ModelModes(np.array(f), np.zeros((len(f), 1)), s) for f, s in (
        ([100.0, 101.0, 150.0], shape), ([98.0, 100.5], shape[:, [1, 0]])))
    single = [np.array([k]) for k in range(3)]
    off = off_by_mesh(coarse, single, lambda x: x, fine, single[:2], lambda x: x)
    np.testing.assert_allclose(off, np.log([100.5 / 100, 98 / 101, 1.0]))


def test_a_coarser_mesh_is_stiffer():
    """Displacement elements are too stiff: all groups of a coarser disc come up, the higher the more."""
    settings = Settings(disc={"web_cells": 2, "ring_cells": 3, "angular_cells": 24}, values={"young": {"spread": 0.1}})
    (coarser, factor), = other_meshes(settings, 1.5)
    bodies = [FreeBody(s, "superlu", 1200.0) for s in (settings, coarser)]
    modes = [body(np.zeros(1)) for body in bodies]
    angle = np.linspace(0, 2 * np.pi, 40)

    def seen(body):
        node = body.nodes["disc"]
        nearest = [np.linalg.norm(node - (0.156 * np.cos(a), 0.156 * np.sin(a), 0.0), axis=1).argmin() for a in angle]
        return lambda shape: shape[3 * np.array(nearest) + 2]

    groups = [grouped(m.frequency, 2e-3) for m in modes]
    off = off_by_mesh(modes[0], groups[0], seen(bodies[0]), modes[1], groups[1], seen(bodies[1]))
    assert len(off) >= 4 and (off >= 0).all() and off.max() > 1e-3 and factor < 0
