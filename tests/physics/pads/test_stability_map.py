"""Growth rates of the linearised system against closed forms and against the transient."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.modal.quadratic_eigenproblem import by_frequency
from pipeline.physics.pads.newmark import integrate
from pipeline.physics.pads.patch_contact import contact_state, patch_shares
from pipeline.physics.pads.sliding_pads import sliding_state
from pipeline.physics.pads.stability_map import on_average, sliding_roots, stability_map
from pipeline.physics.signals.oscillation import dominant_frequency, growth_rate
from tests.physics.small_pads import flutter, random_assembly

MODES = {"k11": 9e6, "k22": 1.1e7, "k12": 1.2e6, "k_friction": 4e6}


@pytest.mark.exact
@pytest.mark.parametrize("excess", [0.8, 1.3])
def test_roots_are_those_of_two_mode_flutter(excess):
    friction = excess * onset_friction(**MODES)
    expected = roots_over_friction(**MODES, friction=friction)
    expected = expected[expected.imag > 0]
    found = sliding_roots(flutter(**MODES, friction=friction))
    np.testing.assert_allclose(*(roots[by_frequency(roots)] for roots in (found, expected)), atol=1e-4)


@pytest.mark.exact
def test_the_transient_grows_with_the_linearised_rate():
    friction = 1.3 * onset_friction(**MODES)
    system = flutter(**MODES, friction=friction)
    root = max(sliding_roots(system), key=lambda s: s.real)
    disturbed = sliding_state(system) * (1 + 1e-7)
    _, moved, _ = integrate(system, disturbed, 2e-6, 25000, tolerance=1e-10)     # the disturbance is 1e-7
    signal = moved[:, 0]
    assert dominant_frequency(signal, 2e-6) == pytest.approx(root.imag / (2 * np.pi), rel=5e-3)
    assert growth_rate(signal, 2e-6, root.imag / (2 * np.pi))[0] == pytest.approx(root.real, rel=1e-2)


@pytest.mark.exact
def test_the_map_holds_the_largest_rate_of_each_stiffness():
    def build(caliper, abutment):
        return flutter(MODES["k11"] * abutment, MODES["k22"] * caliper, MODES["k12"], MODES["k_friction"], 0.6)

    found, frequency = stability_map(build, (0.8, 1.0), (0.9, 1.0, 1.3))
    roots = np.array([[roots_over_friction(MODES["k11"] * a, MODES["k22"] * c, MODES["k12"], MODES["k_friction"], 0.6)
                       for a in (0.9, 1.0, 1.3)] for c in (0.8, 1.0)])
    np.testing.assert_allclose(found, roots.real.max(axis=2), atol=1e-4)
    assert found.max() > 10 and found.min() < 1e-3
    growing, nearest = found > 10, np.abs(roots.imag / (2 * np.pi) - frequency[..., None]).min(axis=2)
    np.testing.assert_allclose(nearest, 0, atol=1e-4)
    winner = np.take_along_axis(roots, roots.real.argmax(axis=2)[..., None], axis=2)[..., 0]
    np.testing.assert_allclose(frequency[growing], np.abs(winner.imag[growing]) / (2 * np.pi), atol=1e-4)


@pytest.mark.exact
def test_roots_beyond_the_highest_frequency_do_not_count():
    def build(caliper, abutment):
        return random_assembly(size=40, count=6)

    everything = sliding_roots(build(1, 1), 4e3, 1e-6)
    rate, frequency = (value.item() for value in stability_map(build, (1.0,), (1.0,), 4e3, 1e-6))
    assert rate == everything[np.abs(everything) < 2 * np.pi * 4e3].real.max()
    assert frequency < 4e3 and np.abs(everything).max() > 2 * np.pi * 4e3
    with pytest.raises(ConfigError, match="the lowest root"):
        stability_map(build, (1.0,), (1.0,), 1.0)


@pytest.mark.exact
def test_rising_friction_over_pressure_counts_in_the_rate():
    system = flutter(**MODES, friction=0.6)
    state = sliding_state(system)
    pressure = contact_state(system.contact, 0.0, state, 0 * state).normal[0] / system.contact.law.area[0]
    dry = system.contact.dry
    table = dry.table * np.array([0.5, 1.5])[:, None, None]
    axis = np.array([0.0, 2 * pressure])
    rising = system._replace(contact=system.contact._replace(dry=dry._replace(table=table, pressure=axis)))
    expected = roots_over_friction(**MODES, friction=0.6 + 0.5 * 0.6).real.max()
    assert sliding_roots(rising).real.max() == pytest.approx(expected, rel=1e-6)


@pytest.mark.exact
def test_averaged_patches_lie_on_all_sub_discs_alike():
    contact = on_average(random_assembly()).contact
    np.testing.assert_allclose(patch_shares(contact.angle, contact.half_angle, 0.77, contact.sectors), 0.25, atol=1e-12)
