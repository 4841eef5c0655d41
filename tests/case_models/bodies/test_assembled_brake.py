"""The assembled brake as a model of its values, against full finite-element matrices."""

import numpy as np
import pytest
import scipy

from pipeline.case_models.bodies import assembled_brake
from pipeline.case_models.bodies.assembled_brake import AssembledBrake, sections
from pipeline.case_models.bodies.measured_points import rows
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.modal.natural_modes import lowest_modes
from stages.model_update import Settings
from tests.stages.hammered_brake import COARSE, full_modes, points

#: the least that has all bodies and joints
WHOLE = {"disc": {"web_cells": 2, "ring_cells": 2, "angular_cells": 12},
         "pad": {"patches_angular": 2, "patches_radial": 2, "cells_per_patch": 1, "lining_layers": 1},
         "caliper": {"inner_radius": "92 mm", "radial_cells": 2, "angular_cells": 3, "housing_cells": 2,
                     "bridge_cells": 1},
         "bracket": {"kind": "body", "element_size": "30 mm"},
         "piston": {"kind": "body", "angular_cells": 8, "element_size": "20 mm"}}


def model(values, highest=1500.0, **more):
    given = {name: {"spread": spread} for name, spread in values.items()}
    return AssembledBrake(Settings(body="assembly", values=given, **COARSE | more), "superlu", highest)


def slopes_by_differences(brake, count, step=1e-3):
    return np.array([np.log(brake(step * u).frequency / brake(-step * u).frequency) / (2 * step)
                     for u in np.eye(count)]).T


def test_lifted_pads_leave_the_modes_of_the_full_matrices():
    brake = model({"joints.finger_stiffness": 0.3})
    frequency = full_modes(COARSE, brake.below)[1]
    found = brake(np.zeros(1)).frequency
    assert len(found) == len(frequency) > 20
    np.testing.assert_allclose(found[frequency < 1500], frequency[frequency < 1500], rtol=1e-6)
    np.testing.assert_allclose(found, frequency, rtol=1e-4)


def test_pressed_pads_are_as_stiff_as_their_pressure():
    """Modes of the test to 1e-5; none of the patches is open, and those of each pad carry the whole force."""
    brake = model({"pressed.stiffness": 0.3}, pressed={"force": "5 kN", "stiffness": "1.2 MPa/um"})
    frequency = full_modes(COARSE, brake.below, (5e3, 1.2e12, 0.8e12))[1]
    found = brake(np.zeros(1)).frequency
    assert len(found) == len(frequency) > 15
    np.testing.assert_allclose(found[frequency < 1500], frequency[frequency < 1500], rtol=1e-5)
    contacts = brake.brake(brake.declared.stated).contacts
    outer = contacts.body == 1
    assert (brake.weights > 0).all()
    assert brake.weights[outer].sum() == pytest.approx(contacts.area[outer].sum(), rel=0.02)


@pytest.mark.slow
def test_slopes_are_those_of_differences_whether_of_springs_or_of_bodies():
    values = {"joints.finger_stiffness": 0.3, "pressed.tangential_stiffness": 0.2, "caliper.density": 0.1,
              "pad.lining_young_normal": 0.1}
    brake = model(values, pressed={"force": "5 kN"}, highest=900.0)
    np.testing.assert_allclose(brake(np.zeros(4)).slope, slopes_by_differences(brake, 4), atol=2e-6)


def test_correlated_priors_turn_the_slopes():
    values = {"joints.finger_stiffness": {"spread": 0.3},
              "joints.guide_pin_stiffness": {"spread": 0.1, "correlation": {"finger_stiffness": 0.8}}}
    brake = AssembledBrake(Settings(body="assembly", values=values, **COARSE), "superlu", 900.0)
    np.testing.assert_allclose(brake(np.zeros(2)).slope, slopes_by_differences(brake, 2), atol=2e-6)


@pytest.mark.slow
def test_bodies_are_reduced_once_while_only_joints_vary(monkeypatch):
    calls, reduce = [], assembled_brake.reduced_body
    monkeypatch.setattr(assembled_brake, "reduced_body", lambda *given: calls.append(1) or reduce(*given))
    brake = model({"joints.finger_stiffness": 0.3, "caliper.young": 0.1}, highest=600.0)
    for finger in (0.0, 0.5, 1.0):
        brake(np.array([finger, 0.0]))
    assert len(calls) == 4
    brake(np.array([0.0, 0.5]))
    assert len(calls) == 4      # the caliper has the same modes
    other = model({"pad.lining_young_normal": 0.1}, highest=600.0)
    other(np.zeros(1))
    other(np.ones(1))
    assert len(calls) == 4 + 4 + 2


@pytest.mark.slow
def test_bracket_piston_and_fluid_are_part_of_it():
    """Against the sparse matrices of the whole with the fluid as a spring that ends on the inertia of the line."""
    values = {"joints.mount_stiffness": 0.2, "joints.shim_stiffness": 0.2}
    settings = Settings(body="assembly", values={n: {"spread": s} for n, s in values.items()}, **WHOLE)
    model_ = AssembledBrake(settings, "superlu", 800.0)
    brake = model_.brake(model_.declared.stated)
    assert set(sections(settings)) == {"disc", "pad", "caliper", "bracket", "piston", "joints", "pressed"}
    found = model_(np.zeros(2))
    parts = [b.matrices() for b in brake.bodies]
    free = np.concatenate([first + free_freedoms(len(b.mesh.node), b.supported) for b, first in zip(
        brake.bodies, np.cumsum([0, *(p[0].shape[0] for p in parts)]), strict=False)])
    stiffness, mass = (scipy.sparse.block_diag([p[k] for p in parts], "csr")[free][:, free] for k in (0, 1))
    joints = brake.joints.rows.matrix[:, free]
    column = scipy.sparse.hstack([brake.piston.matrix[:, free], [[-1.0]]])
    stiffness = scipy.sparse.block_diag([stiffness + joints.T @ scipy.sparse.diags(brake.joints.stiffness) @ joints,
                                         [[0.0]]]) + brake.fluid.stiffness * column.T @ column
    mass = scipy.sparse.block_diag([mass, [[brake.fluid.inertia]]])
    frequency = lowest_modes(stiffness.tocsr(), mass.tocsr(), "superlu", below=model_.below)[0]
    assert len(found.frequency) == len(frequency) > 10
    np.testing.assert_allclose(found.frequency[frequency < 800], frequency[frequency < 800], rtol=1e-5)
    np.testing.assert_allclose(found.share.sum(axis=0) < 1 + 1e-9, True)
    assert found.share[model_.names.index("bracket")].max() > 0.1


def test_shapes_show_what_is_observed():
    brake = model({"joints.finger_stiffness": 0.3}, highest=600.0)
    places = ["pad_outer 1 direction 3", "caliper 0 direction 1"]
    seen = rows(Settings(points=points()).points, places, places[1:] * 2, ["m/s^2/N"] * 2, brake.nodes, "test")
    whole = brake(np.zeros(1)).shown
    compact = brake.observe(seen)
    shown = brake(np.zeros(1)).shown
    assert shown.shape[0] == 4 < whole.shape[0]
    np.testing.assert_allclose(compact.products(shown[:, :2]), seen.products(whole[:, :2]), atol=1e-12)
