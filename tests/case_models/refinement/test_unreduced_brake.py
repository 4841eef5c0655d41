"""Finite elements of a whole brake: what bodies share, what moves, what the fluid adds."""

import numpy as np
import pytest

from pipeline.case_models.bodies.brake_bodies import Piston
from pipeline.case_models.refinement.finer_settings import finer
from pipeline.case_models.refinement.unreduced_brake import BodyMatrices, freedoms, unreduced
from pipeline.systems.disc_brake import build
from tests.case_models.refinement.tiny_brake import SECTION


@pytest.fixture(scope="module")
def brake():
    return build(SECTION)


def test_bodies_that_did_not_change_are_assembled_once(brake):
    matrices = BodyMatrices("superlu")
    first = [matrices.of(*each) for each in zip(brake.names, brake.bodies, strict=True)]
    other = build(finer(SECTION, ["pad_mesh"], 1.5))
    again = [matrices.of(*each) for each in zip(other.names, other.bodies, strict=True)]
    assert [a is b for a, b in zip(first, again, strict=True)] == [True, False, False, True]


@pytest.mark.exact
def test_bodies_move_rigidly_without_strain_and_with_their_mass(brake):
    model = unreduced(brake, BodyMatrices("superlu"), 10.0)
    size = model.mass.shape[0]
    assert size == freedoms(brake) == model.contacts.normal.shape[1] == len(model.coordinate_body)
    caliper = np.where(model.coordinate_body == 3, np.tile([0.0, 0.0, 1.0], size // 3), 0.0)
    volume = caliper @ model.mass @ caliper / brake.bodies[3].density[0]
    nodes = brake.bodies[3].mesh.node
    assert 0 < volume < np.prod(np.ptp(nodes, axis=0))
    assert abs(model.stiffness @ caliper).max() < 1e-9 * abs(model.stiffness.data).max()


def test_contacts_bear_on_disc_and_pad_alike(brake):
    contacts, disc = unreduced(brake, BodyMatrices("superlu"), 10.0).contacts, brake.bodies[0]
    held = 3 * len(disc.supported)
    disc_size = 3 * len(disc.mesh.node) - held
    np.testing.assert_allclose(contacts.normal[:, :disc_size].sum(axis=1), -contacts.normal[:, disc_size:].sum(axis=1))
    assert not contacts.preload.any() and contacts.area.sum() > 0


def test_losses_are_imaginary_and_the_fluid_is_a_spring_to_a_mass():
    caliper = SECTION.caliper.model_copy(update={"inner_radius": 0.092})
    section = SECTION.model_copy(update={"piston": Piston(angular_cells=8), "caliper": caliper})
    model = unreduced(build(section), BodyMatrices("superlu"), 10.0, 0.02)
    assert model.body_name[-1] == "brake_fluid" and model.joints.name[-1] == "fluid_column"
    assert model.joints.stiffness[-1].imag == pytest.approx(0.02 * model.joints.stiffness[-1].real)
    disc = model.coordinate_body == 0
    block = model.stiffness[disc][:, disc]
    np.testing.assert_allclose(block.data.imag, 0.002 * block.data.real, atol=1e-9 * abs(block.data).max())
