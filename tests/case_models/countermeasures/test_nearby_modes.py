"""Modes near roots of the product ComplexModes: the same roots, the same shapes, stable ones beside them."""

from dataclasses import replace

import numpy as np

from pipeline.case_models.countermeasures.nearby_modes import Brake, modes_about, system_of
from pipeline.physics.modal.shape_matching import assurance
from stages.complex_modes import complex_modes
from tests.case_models.countermeasures.two_brakes import MODES, brake
from tests.diagnosis.small_rig import effects


def unstable_found_again(given):
    modes = given.modes
    assert len(modes.unstable_root)
    for operating in np.unique(modes.unstable_operating):
        here = modes.unstable_operating == operating
        roots, shapes = modes_about(given, operating, modes.unstable_reduced[here])
        assert len(roots) > here.sum() and (roots.imag > 0).all() and (roots.real < 0).any()
        for root, shape in zip(modes.unstable_reduced[here], modes.unstable_shape[here], strict=True):
            nearest = np.argmin(abs(roots - root))
            assert abs(roots[nearest] - root) < 1e-7 * abs(root)
            assert assurance(shape.reshape(1, -1), shapes[[nearest]].reshape(1, -1)) > 1 - 1e-6


def test_unstable_modes_are_those_of_the_product():
    unstable_found_again(brake())


def test_viscous_ones_and_those_of_a_case_with_effects_too():
    base = brake()
    falling = effects({"falling_friction": {"pad_outer": {"rise": 0.3, "decay_speed": "0.5 m/s"}}})
    viscous = MODES.model_copy(update={"hysteretic": False})
    modes = complex_modes(base.model, base.friction_map, falling, settings=viscous)
    unstable_found_again(Brake(modes, base.model, base.friction_map, falling))


def test_the_system_is_about_the_operating_point():
    slow, fast = (system_of(brake(), k)[0] for k in (0, 1))
    assert np.array_equal(slow[0], fast[0]) and not np.allclose(slow[1], fast[1])
    still = replace(brake(), friction_map=brake(friction=0.0).friction_map)
    stiffness = system_of(still, 0)[0][2].real
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-6 * abs(stiffness).max())
