"""Values of the bodies in reduced matrices."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.sensitivity.bodies import body_parameters
from pipeline.case_models.sensitivity.matrices import Case
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_structure


def test_a_body_scales_with_its_modulus_and_density():
    """Its block alone; viscous damping at a damping ratio rises with the root of both."""
    structure = small_structure()
    model = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    found = {name: changed for name, *_, changed in body_parameters(model, structure)}
    disc = np.ix_(*(np.flatnonzero(model.coordinate_body == list(model.body_name).index("disc")),) * 2)
    for name, matrix in (("structure.disc.young", "stiffness"), ("structure.disc.density", "mass")):
        changed = found[name](Case(model, 0, 12.0), 0.21).model
        expected = getattr(model, matrix).copy()
        expected[disc] *= 1.21
        np.testing.assert_allclose(getattr(changed, matrix), expected, rtol=1e-12)
        assert np.linalg.norm(changed.damping[disc] - 1.1 * model.damping[disc]) == pytest.approx(
            0, abs=1e-6 * np.linalg.norm(model.damping[disc]))


def test_a_disc_of_two_materials_scales_as_one():
    """As a deck may give it."""
    structure = small_structure()
    disc = structure.disc
    two = replace(disc, material_name=["A", "B"], density=np.repeat(disc.density, 2),
                  elasticity=np.repeat(disc.elasticity, 2, axis=0), loss_factor=np.repeat(disc.loss_factor, 2),
                  element_material=np.arange(len(disc.element)) % 2)
    model = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    names = {name for name, *_ in body_parameters(model, replace(structure, disc=two))}
    assert {"structure.disc.young", "structure.disc.densities", "structure.disc.loss_factor"} <= names


def test_behind_a_lining_with_a_shim_nothing_has_a_slope():
    """Backplate, rubber and cover are one part of the reduced stiffness, which none of their moduli scales."""
    structure, named = small_structure(), {}
    model = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    for layers in (("lining", "steel"), ("lining", "steel", "shim rubber", "shim cover")):
        pad, count = structure.pad_outer, len(layers)
        pad = replace(pad, material_name=list(layers), density=np.repeat(pad.density[:1], count),
                      elasticity=np.repeat(pad.elasticity[:1], count, axis=0),
                      loss_factor=np.repeat(pad.loss_factor[:1], count))
        named[count] = {name for name, *_ in body_parameters(model, replace(structure, pad_outer=pad))}
    assert named[2] - named[4] == {"structure.pad.backplate_young", "structure.pad.backplate_loss_factor"}
    assert named[4] < named[2] and "structure.pad.lining_young" in named[4]
