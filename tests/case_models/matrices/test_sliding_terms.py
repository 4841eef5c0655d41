"""Terms of a sliding state: their sum is the linearised model, here, and at another speed and friction."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.matrices.dependence import summands
from pipeline.case_models.matrices.sliding_terms import sliding_state, terms_about, terms_of
from pipeline.contract import ConfigError, store
from pipeline.contract.settings import fill
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.products import ComplexModes, ReducedModel
from stages.complex_modes import Settings, complex_modes
from stages.lumped import Settings as Lumped
from stages.lumped import lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.diagnosis.small_rig import effects
from tests.exports.small_runs import flutter_run
from tests.stages.small_oscillator import small_oscillator
from tests.stages.test_complex_modes_with_effects import PRESSED

WHOLE = SimpleNamespace(friction_damping=True, gyroscopic=True, centrifugal=True)


def system(speed=3.0):
    """A SlidingModel of random matrices with two contacts."""
    random = np.random.default_rng(2)
    square = [random.standard_normal((5, 5)) for _ in range(5)]
    row = [random.standard_normal((2, 5)) for _ in range(4)]
    symmetric = [part @ part.T for part in square]
    contacts = Contacts(row[0], row[1], row[2], np.zeros((2, 3)), np.full(2, 0.5), np.array([1.0, 2.0]),
                        np.array([10.0, 20.0]), np.array([1e3, 2e3]), np.array([0.1, 0.3]))
    return SlidingModel(("a",), np.zeros(5, int), symmetric[0], symmetric[1], square[2] - square[2].T,
                        symmetric[3] * (1 + 0.1j), symmetric[4],
                        Joints(("j", "k"), row[3], np.array([5.0, 6.0]), np.array([0.2, 0.0])), contacts, (),
                        np.empty((0, 5)), (), np.empty((0, 5)), speed)


def summed(terms, kind, speed=1.0, friction=1.0):
    return sum(t.matrix * sum(a * speed**m * friction**n for a, m, n in summands(t.times, "here"))
               for t in terms if t.kind == kind)


@pytest.mark.exact
def test_terms_are_those_of_the_linearised_model_at_any_speed_and_friction():
    about, state = system(), FrictionState(np.array([0.4, 0.5]), 1e-3, np.array([-0.02, 0.01]))
    terms = terms_about(about, state, WHOLE)
    for speed, share in ((1.0, 1.0), (2.5, 0.6)):
        scaled = FrictionState(share * state.coefficient, share * state.pressure_slope, share * state.speed_slope)
        mass, damping, stiffness = replace(about, speed=3.0 * speed).linearised(scaled)
        np.testing.assert_allclose(summed(terms, "mass"), mass, rtol=1e-14)
        np.testing.assert_allclose(summed(terms, "damping", speed, share), damping, rtol=1e-12, atol=1e-11)
        np.testing.assert_allclose(summed(terms, "stiffness", speed, share) + 1j * summed(terms, "loss"), stiffness,
                                   rtol=1e-12, atol=1e-9)


def test_terms_that_are_left_out_or_empty_are_no_matrices():
    names = {t.name for t in terms_about(system(), FrictionState(0.0), SimpleNamespace(
        friction_damping=False, gyroscopic=False, centrifugal=False))}
    assert names == {"mass", "structural_damping", "contact_damping", "structural_stiffness", "contact_stiffness",
                     "hysteretic_loss"}


def test_friction_of_the_settings_serves_without_a_map(tmp_path):
    run = flutter_run(tmp_path)
    modes, model = (store.read(cls, run / f"{cls.name}.h5") for cls in (ComplexModes, ReducedModel))
    state = sliding_state(modes, model, None, None, 1)
    assert state.friction.coefficient == pytest.approx(0.4) and state.hysteretic is None
    np.testing.assert_allclose(state.sliding.contact.force, modes.operating_force[1])
    assert {t.name for t in terms_of(state)} >= {"mass", "circulatory"}


def test_hard_contacts_are_refused():
    rig = {**PRESSED, "contacts": {"belt": {"tangent": {"block.x": 1}, "normal": {"block.y": 1}}}}
    model = reduced_model(lumped(settings=fill(Lumped, rig, "lumped")), settings=Reduction())
    settings = {"speeds": ("1 rad/s",), "friction": 0.2, "friction_steps": 2}
    modes = complex_modes(model, settings=Settings(**settings))
    with pytest.raises(ConfigError, match="export: contacts: expected a normal stiffness"):
        sliding_state(modes, model, None, None, 0)


def test_effects_with_states_of_their_own_are_refused():
    model, block = small_oscillator(on_belt=True), effects({"contact_memory": {"contact": {"length": "1 mm"}}})
    modes = complex_modes(model, None, block, settings=Settings(
        speeds=("1 rad/s",), friction=0.3, friction_steps=2, damping_speed="1e12 m/s"))
    with pytest.raises(ConfigError, match="export: effects: expected forces of displacement and velocity alone, found"
                                          " effects with states of their own, among contact_memory"):
        sliding_state(modes, model, None, block, 0)
