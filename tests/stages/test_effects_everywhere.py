"""Every effect that acts on small motions acts alike in complex modes, in draws and in the whole model of a draw."""

import numpy as np
import pytest

from pipeline.case_models.scatter import family, stability_settings
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import whole_roots
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.effects_on_a_brake import SMALL, VALUES, acting
from tests.stages.small_structure import small_friction_map, small_structure

LAW, SPEED = small_friction_map(0.45), 10.0
#: what small motions of this brake do not feel: the stroke closes a clearance, a stop is not reached
UNFELT = {"clearance", "impact"}


@pytest.fixture(scope="module")
def brake():
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


def modes_of(model, effects):
    return complex_modes(model, LAW, effects, settings=Modes(
        friction_steps=2, speeds=(f"{SPEED} rad/s",), frequency_max="8 kHz", friction_damping=False, followed=0))


@pytest.fixture(scope="module")
def without(brake):
    return modes_of(brake, None).unstable_reduced


def test_none_of_the_catalogue_is_left_out():
    assert set(VALUES) == SMALL


@pytest.mark.parametrize("name", sorted(SMALL))
def test_the_middle_of_the_draws_is_what_complex_modes_say(brake, without, name):
    effects = acting(name)
    modes = modes_of(brake, effects)
    points, grows = stability_settings(modes), modes.unstable_reduced
    for state in range(len(brake.pressure)):
        made = family(brake, state, LAW, points, effects)
        drawn = sampled(made, points.speeds, points.frequency_max).modes(NOMINAL, SPEED)
        whole = whole_roots(made, NOMINAL, SPEED, points.frequency_max)
        here = grows[(modes.unstable_operating == state) & (abs(grows) < 2 * np.pi * points.frequency_max)]
        for root in here:
            assert abs(drawn.value - root).min() < 1e-4 * abs(root) and abs(whole - root).min() < 1e-9 * abs(root)
        assert np.sum(drawn.value.real > 5) == np.sum(here.real > 5) and drawn.residual.max() < 1.0
    changed = len(grows) != len(without) or bool(abs(grows - without).max() > 1e-7 * abs(without).max())
    assert changed is (name not in UNFELT), "an effect that changes nothing shows nothing"
