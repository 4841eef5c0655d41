"""Every effect that acts on small motions acts alike in complex modes, in draws, in the whole model of a draw, in the
matrices that are exported, and in the growth from which a limit cycle comes."""

import numpy as np
import pytest

from pipeline.case_models.matrices.sliding_terms import sliding_state, terms_of
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import family
from pipeline.contract import ConfigError
from pipeline.physics.modal.quadratic_eigenproblem import polished
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import whole_roots
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.limit_cycle import Settings as Cycle
from stages.limit_cycle import limit_cycle
from tests.stages.effect_table import FILE, cycles, page, reduced, remembers
from tests.stages.effects_on_a_brake import SMALL, VALUES, acting
from tests.stages.small_structure import small_friction_map

LAW, SPEED = small_friction_map(0.45), 10.0
#: what small motions of this brake do not feel: the stroke closes a clearance, a stop is not reached
UNFELT = {"clearance", "impact"}


@pytest.fixture(scope="module")
def brake():
    return reduced()


def modes_of(model, effects):
    return complex_modes(model, LAW, effects, settings=Modes(
        friction_steps=2, speeds=(f"{SPEED} rad/s",), frequency_max="8 kHz", friction_damping=False, followed=0))


@pytest.fixture(scope="module")
def without(brake):
    return modes_of(brake, None).unstable_reduced


def exported_at(modes, model, effects, operating):
    """(M, C, K) as they are exported at an operating point; None where that is refused."""
    try:
        terms = terms_of(sliding_state(modes, model, LAW, effects, operating))
    except ConfigError as error:
        assert "effects with states of their own" in str(error)
        return None
    summed = {kind: sum(t.matrix for t in terms if t.kind == kind) for kind in ("mass", "damping", "stiffness", "loss")}
    return summed["mass"], summed["damping"], summed["stiffness"] + 1j * summed["loss"]


def root_near(matrices, root):
    start = np.linalg.solve(root**2 * matrices[0] + root * matrices[1] + matrices[2], np.ones(len(matrices[0])))
    return polished(*matrices, root * (1 + 1e-6), start)[0]


def test_none_of_the_catalogue_is_left_out():
    assert set(VALUES) == SMALL


def test_the_table_of_the_documents_is_that_of_the_catalogue():
    assert FILE.read_text(encoding="utf-8") == page(), "python -m tests.stages.effect_table"


@pytest.mark.parametrize("name", sorted(SMALL))
def test_the_middle_of_the_draws_is_what_complex_modes_say(brake, without, name):
    effects = acting(name)
    modes = modes_of(brake, effects)        # one speed: operating points are pressures
    points, grows = StabilitySettings.of(modes), modes.unstable_reduced
    state = len(brake.pressure) - 1
    made = family(brake, state, LAW, points, effects)
    drawn = sampled(made, points.speeds, points.frequency_max).modes(NOMINAL, SPEED)
    whole = whole_roots(made, NOMINAL, SPEED, points.frequency_max)
    here = grows[(modes.unstable_operating == state) & (abs(grows) < 2 * np.pi * points.frequency_max)]
    exported = exported_at(modes, brake, effects, state)
    for root in here:
        assert abs(drawn.value - root).min() < 1e-4 * abs(root) and abs(whole - root).min() < 1e-9 * abs(root)
        assert exported is None or abs(root_near(exported, root) - root) < 1e-8 * abs(root)
    assert (exported is None) is remembers(name)
    assert np.sum(drawn.value.real > 5) == np.sum(here.real > 5) and drawn.residual.max() < 1.0
    changed = len(grows) != len(without) or bool(abs(grows - without).max() > 1e-7 * abs(without).max())
    assert changed is (name not in UNFELT), "an effect that changes nothing shows nothing"


#: short steps, and no more of a motion than its growth asks for
ONSET = {"duration": "0.3 ms", "window": "0.1 ms", "step": "2.5 us", "patch": 1, "checks": (),
         "smallest_correction": 1e-3}
#: values beside which something grows
SHORTER = {"contact_memory": {"length": 3e-5}}


@pytest.mark.exact
@pytest.mark.parametrize("name", sorted(SMALL))
def test_small_motions_grow_as_complex_modes_say(brake, name):
    """Growth rates within 5 %, or 1 1/s, frequencies within 0.1 %."""
    law, effects = small_friction_map(0.6), acting(name, **SHORTER.get(name, {}))
    modes = complex_modes(brake, law, effects, settings=Modes(
        friction_steps=2, speeds=(f"{SPEED} rad/s",), frequency_max="8 kHz", friction_damping=False, followed=0))
    assert len(modes.unstable_root)
    if not cycles(name):
        with pytest.raises(ConfigError, match="dry friction of a joint that rests"):
            limit_cycle(brake, law, modes, effects, settings=Cycle(**ONSET))
        return
    found = limit_cycle(brake, law, modes, effects, settings=Cycle(**ONSET))
    assert len(found.onset_root) == len(modes.unstable_root)
    np.testing.assert_allclose(found.onset_simulated.imag, found.onset_root.imag, rtol=1e-3)
    assert (abs(found.onset_simulated.real - found.onset_root.real)
            < np.maximum(0.05 * found.onset_root.real, 1.0)).all()
