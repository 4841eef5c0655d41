"""Stage complex_modes on a brake of a few elements."""

from dataclasses import fields

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.contract.settings import restored
from pipeline.physics.friction.dry_friction import Friction
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.equilibrium import closure_response, model_about, steady_sliding
from pipeline.physics.sliding.model import FrictionState, sliding_model
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.simulate import Table
from pipeline.products.motion import COUPLING, FALLING, OF_BODY, OF_JOINTS, SINGLE
from stages.complex_modes import Settings, complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.finite_elements import FiniteElements
from tests.stages.small_oscillator import DAMPING, MASS, NORMAL_FORCE, STIFFNESS, small_oscillator
from tests.stages.small_structure import small_friction_map, small_structure
from tests.stages.two_processes import TwoProcesses

#: no path over friction, but where it is what a test is about
SETTINGS = {"friction_steps": 7, "speeds": ("8 rad/s", "12 rad/s"), "frequency_max": "8 kHz", "followed": 0}
#: m/s; a damping speed at which contacts are as good as undamped
NO_DAMPING = 1e12


@pytest.fixture(scope="module")
def model():
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


@pytest.fixture(scope="module")
def modes(model):
    return complex_modes(model, small_friction_map(), settings=Settings(**SETTINGS))


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


def sliding(model, state, speed, friction, damping_speed=1.0):
    """(SlidingModel about steady sliding at a constant friction coefficient, forces (c,) of its contacts)."""
    about = sliding_model(model, state, speed)
    found = steady_sliding(about, closure_response(about), model.pressure[state] * model.input_area,
                           model.law_closure, model.law_pressure, friction)
    return model_about(about, found.contact, damping_speed), found.contact.force


@pytest.mark.exact
def test_without_friction_every_root_decays_or_is_neutral(model):
    modes = complex_modes(model, small_friction_map(0.0), settings=Settings(**SETTINGS))
    assert len(modes.unstable_root) == 0 and not modes.operating_friction.any()
    assert (modes.operating_root.real < 1e-6 * abs(modes.operating_root)).all()


@pytest.mark.exact
def test_a_transient_starts_from_the_sliding_state_of_the_complex_modes(model, modes):
    """Solved for displacements and forces together by ``steady_start``, for closures alone by the stage."""
    mapped = small_friction_map()
    law = FrictionLaw(mapped.pressure, mapped.speed, mapped.distance, mapped.friction)
    friction = Friction(law, distance=Settings().sliding_distance)
    points = zip(modes.operating_pressure, modes.operating_speed, modes.operating_force, strict=True)
    for pressure, speed, force in points:
        state = int(np.flatnonzero(model.pressure == pressure)[0])
        start = steady_start(sliding_model(model, state, speed), Table(model.law_closure, model.law_pressure),
                             friction, pressure * model.input_area)
        np.testing.assert_allclose(start.normal, force, rtol=1e-8)


@pytest.mark.exact
@pytest.mark.parametrize("centrifugal", [True, False])
def test_roots_without_friction_and_damping_are_the_real_modes(model, centrifugal):
    """At speeds that let a centrifugal term show wherever one is left in."""
    bare = changed(model, damping=0 * model.damping, joint_damping=0 * model.joint_damping)
    settings = Settings(**SETTINGS | {"speeds": ("80 rad/s", "120 rad/s")}, gyroscopic=False, centrifugal=centrifugal,
                        damping_speed=f"{NO_DAMPING} m/s")
    modes = complex_modes(bare, small_friction_map(), settings=settings)
    start = modes.root[:, 0]
    np.testing.assert_allclose(start.imag, 2 * np.pi * modes.real_frequency, rtol=1e-8)
    assert abs(start.real).max() < 1e-6 * abs(start).max()


def basis_errors(model, smallest, friction_damping, damping_speed):
    """Largest relative error of the roots up to half of the frequency limit, against the whole reduced model."""
    whole, _ = sliding(model, 0, 8.0, 0.5, damping_speed)
    direct, errors = quadratic_roots(*whole.linearised(0.5, friction_damping=friction_damping)), []
    for share in smallest:
        settings = Settings(**SETTINGS, friction_damping=friction_damping, smallest_correction=share,
                            damping_speed=f"{damping_speed} m/s")
        roots = complex_modes(model, small_friction_map(), settings=settings).operating_root[0]
        slow = roots[(abs(roots) < np.pi * 8e3) & (roots.imag > 10 * abs(roots.real))]
        error, near = abs(direct[:, None] - slow).min(axis=0) / abs(slow), slow.real > -5e-4 * abs(slow)
        assert len(slow) > 15 and error[near].max(initial=0.0) < 1e-9    # solved for in the whole model
        errors.append(error[~near].max())
    return errors


@pytest.mark.exact
@pytest.mark.parametrize("friction_damping", [True, False])
def test_roots_converge_to_those_of_the_whole_reduced_model(model, friction_damping):
    """The more corrections the better; contacts without damping."""
    errors = basis_errors(model, (1e-3, 1e-5), friction_damping, NO_DAMPING)
    assert errors[0] < 5e-4 and errors[1] < errors[0] / 4


@pytest.mark.exact
@pytest.mark.parametrize("friction_damping", [True, False])
def test_roots_converge_with_damped_contacts(model, friction_damping):
    """Damping of the contacts loads them locally as well and needs more corrections."""
    errors = basis_errors(model, (1e-2, 1e-3, 1e-4), friction_damping, 1.0)
    assert errors[2] < min(errors[:2]) / 2 and errors[2] < 5e-4


def test_unstable_modes_come_strongest_first_with_their_shapes(model):
    modes = complex_modes(model, small_friction_map(), settings=Settings(**SETTINGS, friction_damping=False))
    assert len(modes.unstable_root) > 0
    for number, root in zip(modes.unstable_operating, modes.unstable_root, strict=True):
        assert root in modes.operating_root[number] and root.real > 0
    assert (np.diff(modes.unstable_root.real) <= 0).all()
    np.testing.assert_allclose(abs(modes.unstable_shape).max(axis=(1, 2)), 1.0, rtol=1e-5)
    np.testing.assert_allclose(modes.operating_friction, 0.5)


def test_sweep_meets_the_operating_points(model):
    """Both stand on a basis of their own: that of the sweep on the state without friction. They converge together."""
    apart = []
    for smallest in (3e-4, 1e-5):
        one_speed = Settings(**SETTINGS | {"speeds": ("10 rad/s",), "friction_max": 0.5, "friction_damping": False},
                             smallest_correction=smallest)
        modes = complex_modes(model, small_friction_map(), settings=one_speed)
        slow = [root[(abs(root) < np.pi * 8e3) & (root.imag > 10 * abs(root.real))] for root in modes.operating_root]
        apart.append(max((abs(modes.root[k, -1][:, None] - slow[k]).min(axis=0) / abs(slow[k])).max() for k in (0, 1)))
    assert len(slow[0]) > 15 and modes.root.shape == (2, 7, modes.real_frequency.shape[1])
    assert apart[0] < 5e-4 and apart[1] < apart[0] / 4


@pytest.mark.exact
def test_the_sweep_ends_in_all_roots_of_the_reduced_model_where_friction_has_moved_the_contacts(model):
    """Contacts that stiffen with their closure, of a few coarse corrections."""
    curved = changed(model, law_closure=np.linspace(0, model.law_closure[-1], 40),
                     law_pressure=model.law_pressure[-1] * np.linspace(0, 1, 40)**2)
    modes = complex_modes(curved, small_friction_map(), settings=Settings(
        **SETTINGS | {"friction_steps": 2, "friction_damping": False, "speeds": ("10 rad/s",)}, friction_max=1.1,
        smallest_correction=3e-3))
    for state, found in enumerate(modes.root[:, -1]):
        about, _ = sliding(curved, state, 10.0, 1.1)
        root = quadratic_roots(*about.linearised(1.1, friction_damping=False))
        growing = root[(root.real > 1.0) & (root.imag > 0) & (abs(root) < 2 * np.pi * 8e3)]
        assert len(growing) >= 4 and abs(growing[:, None] - found).min(axis=1).max() < 0.5
        assert np.sum((found.real > 1.0) & (abs(found) < 2 * np.pi * 8e3)) == len(growing)


@pytest.mark.exact
def test_friction_moves_the_load_and_with_it_the_roots(model):
    """Linear contacts that stay closed keep their stiffness: only damping N / damping_speed shows the moved load."""
    state, force = sliding(model, 0, 8.0, 0.5)
    still, resting = sliding(model, 0, 8.0, 0.0)
    assert abs(force - resting).max() > 0.2 * resting.max()
    np.testing.assert_allclose(state.contacts.stiffness, still.contacts.stiffness)
    np.testing.assert_allclose(state.contacts.damping, force)
    roots = [quadratic_roots(*m.linearised(0.5, friction_damping=False)) for m in (state, still)]
    assert abs(roots[0] - roots[1]).max() > 1.0


@pytest.mark.exact
def test_the_forces_of_steady_sliding_are_kept(model, modes):
    """Pressures outermost, speeds within; with the friction of the map and without."""
    still = complex_modes(model, small_friction_map(0.0), settings=Settings(**SETTINGS))
    for number, (state, speed) in enumerate([(0, 8.0), (0, 12.0), (1, 8.0), (1, 12.0)]):
        for found, friction in ((still, 0.0), (modes, 0.5)):
            _, force = sliding(model, state, speed, friction)
            np.testing.assert_allclose(found.operating_force[number], force, rtol=1e-6)


def test_contacts_that_open_are_counted(model):
    """Friction of 1.2 tips a pad off one contact; more than that tips it over, and there is no steady sliding."""
    still, tipped = (complex_modes(model, small_friction_map(mu), settings=Settings(**SETTINGS)) for mu in (0.0, 1.2))
    assert not still.operating_open.any() and (tipped.operating_open == 1).all()
    np.testing.assert_array_equal(np.sum(tipped.operating_force == 0, axis=1), tipped.operating_open)
    with pytest.raises(ConvergenceError, match="steady sliding"):
        complex_modes(model, small_friction_map(2.0), settings=Settings(**SETTINGS))


def test_vibrating_roots_are_followed_without_jumps(model):
    """Modes that friction does not overdamp move by less than their distance to the next one."""
    fine = Settings(**{**SETTINGS, "friction_steps": 41, "friction_damping": False})
    roots = complex_modes(model, small_friction_map(), settings=fine).root
    assert abs(np.diff(roots, axis=1)).max() < 0.02 * abs(roots).max()


def test_terms_can_be_left_out(model):
    still = {"friction_damping": False, "gyroscopic": False, "centrifugal": False}
    without = complex_modes(model, small_friction_map(), settings=Settings(**SETTINGS, **still))
    with_all = complex_modes(model, small_friction_map(), settings=Settings(**SETTINGS))
    assert abs(without.operating_root - with_all.operating_root).max() > 1.0
    speeds = without.operating_root.reshape(2, 2, -1)
    np.testing.assert_array_equal(speeds[:, 0], speeds[:, 1])


@pytest.mark.parametrize("change", [{"pad_modulus": 1.5e9}, {"caliper_stiffness": 6e7}])
def test_pads_and_caliper_move_the_roots(modes, change):
    other = reduced_model(small_structure(**change), settings=Reduction(fixed_below="20 kHz"))
    moved = complex_modes(other, small_friction_map(), settings=Settings(**SETTINGS))
    count = min(moved.operating_root.shape[1], modes.operating_root.shape[1])
    assert abs(moved.operating_root[:, :count] - modes.operating_root[:, :count]).max() > 10.0


def test_the_number_of_workers_changes_no_bit(model, modes):
    again = complex_modes(model, small_friction_map(), settings=Settings(**SETTINGS), context=TwoProcesses())
    assert all(np.array_equal(getattr(again, f.name), getattr(modes, f.name)) for f in fields(modes))


def oscillator_modes(speeds=("1 rad/s",), **model):
    """ComplexModes of one mass with friction of its settings, 0.2 + 0.3 exp(-v / 0.5)."""
    friction = {"friction": 0.2, "friction_at_rest": 0.5, "decay_speed": "0.5 m/s"}
    return complex_modes(small_oscillator(**model), None, settings=Settings(speeds=speeds, **friction))


@pytest.mark.exact
def test_a_mass_on_a_belt_has_the_damping_of_falling_friction():
    """m s^2 + (d + N0 dmu/dv) s + k = 0, in either direction of the belt."""
    modes = oscillator_modes(speeds=("1 rad/s", "-1 rad/s", "3 rad/s"), on_belt=True)
    for number, speed in enumerate((1.0, 1.0, 3.0)):
        slope = -0.3 / 0.5 * np.exp(-speed / 0.5)
        drag = (DAMPING + NORMAL_FORCE * slope) / MASS
        root = -drag / 2 + 1j * np.sqrt(STIFFNESS / MASS - drag**2 / 4)
        assert modes.operating_root[number, 0] == pytest.approx(root)
        assert modes.operating_friction[number] == pytest.approx(0.2 + 0.3 * np.exp(-speed / 0.5))
    assert not modes.operating_open.any() and not len(modes.unstable_root)


@pytest.mark.exact
def test_a_mass_without_contacts_keeps_its_root():
    modes = oscillator_modes()
    root = -DAMPING / MASS / 2 + 1j * np.sqrt(STIFFNESS / MASS - (DAMPING / MASS) ** 2 / 4)
    np.testing.assert_allclose(modes.operating_root, root)
    np.testing.assert_allclose(modes.root, root)
    assert modes.real_frequency[0, 0] == pytest.approx(np.sqrt(STIFFNESS / MASS) / 2 / np.pi)
    assert modes.operating_force.shape == (1, 0) and modes.operating_friction[0] == 0


@pytest.mark.exact
def test_a_hard_contact_that_holds_the_whole_mass_along_its_only_motion_is_refused():
    """Nothing is left to move: there are no modes."""
    with pytest.raises(ConfigError, match="no motion"):
        oscillator_modes(hard=True)


@pytest.mark.parametrize(("given", "said"), [
    ({"friction_at_rest": 0.9}, "friction_at_rest: expected friction beside it, or neither"),
    ({"speeds": ["-10 rad/s", "10.1 rad/s"]}, "speeds: expected speeds of one sign")])
def test_settings_that_would_do_nothing_or_cross_standstill_are_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        complex_modes.check({"complex_modes": Settings(**given), "friction_map": None})


@pytest.mark.parametrize(("chain", "friction", "found"), [
    ((), None, "neither this nor a friction map"), (("friction_map",), 0.4, "a friction map")])
def test_friction_comes_from_one_source(chain, friction, found):
    sections = {"complex_modes": Settings(friction=friction), **dict.fromkeys(chain)}
    with pytest.raises(ConfigError, match=found):
        complex_modes.check(sections)


@pytest.fixture(scope="module")
def lossy():
    """A Structure with loss factors in place of damping ratios, and brake fluid; its model in a coarse basis."""
    structure = small_structure(modes_below=7e3)
    bodies = {name: changed(getattr(structure, name), damping_ratio=0.0, loss_factor=[loss])
              for name, loss in zip(structure.body_name, (0.001, 0.01, 0.02, 0.002), strict=True)}
    joints = len(structure.joint_name)
    fluid = {"fluid_stiffness": [1e6], "fluid_loss_factor": [0.1], "line_inertia": [10.0], "line_drag": [1e3]}
    structure = changed(structure, **bodies, **fluid, joint_loss_factor=np.linspace(0.0, 0.05, joints))
    return structure, reduced_model(structure, settings=Reduction(fixed_below="7 kHz", residual_below="10 kHz"))


IN_FULL = SETTINGS | {"friction_damping": False, "centrifugal": False}


@pytest.mark.exact
def test_unstable_roots_are_those_of_the_full_finite_element_matrices(lossy):
    """Assembled anew, solved by another factorisation; the basis is coarse enough for the reduced roots to be off."""
    structure, model = lossy
    modes = complex_modes(model, small_friction_map(), None, structure, settings=Settings(**IN_FULL | {"followed": 12}))
    elements, checked = FiniteElements(structure), []
    inside = np.isin(modes.growth_owner, (OF_BODY, OF_JOINTS))
    outside = np.invert(inside)
    assert {f"damping of {name}" for name in structure.body_name} <= set(modes.growth_term) and outside.any()
    assert {"damping of brake_fluid", "damping at fluid_column"} <= set(modes.growth_term)
    assert (modes.unstable_growth[:, inside] <= 0).all()
    for number, speed in enumerate((8.0, 12.0, 8.0, 12.0)):
        about, force = sliding(model, number // 2, speed, 0.5)
        np.testing.assert_allclose(modes.operating_force[number], force, rtol=1e-6)
        matrices = elements.about(about, FrictionState(0.5), friction_damping=False)
        for k in np.flatnonzero(modes.unstable_operating == number):
            root, reduced = modes.unstable_root[k], modes.unstable_reduced[k]
            direct, _ = elements.root_near(root, *matrices)
            assert abs(root - direct) < 1e-6 * abs(direct) and modes.unstable_residual[k] <= 1e-6
            assert root in modes.operating_root[number]
            assert modes.unstable_growth[k].sum() == pytest.approx(root.real)
            assert modes.unstable_contact[k].sum() == pytest.approx(modes.unstable_growth[k, outside].sum())
            assert modes.unstable_share[k].sum() == pytest.approx(1.0)
            checked.append(abs(reduced - direct))
    assert len(checked) >= 4 and max(checked) > 1.0
    assert len(modes.followed_mode)
    for index in modes.followed_mode:
        assert modes.path_root[modes.path_mode == index][-1] == pytest.approx(modes.unstable_reduced[index], rel=1e-8)


def test_without_full_matrices_roots_are_those_of_the_reduced_model(lossy):
    structure, model = lossy
    plain = complex_modes(model, small_friction_map(), settings=Settings(**IN_FULL))
    off = complex_modes(model, small_friction_map(), None, structure,
                        settings=Settings(**IN_FULL, residual_tolerance=None))
    for modes in (plain, off):
        np.testing.assert_array_equal(modes.unstable_root, modes.unstable_reduced)
        assert (modes.unstable_residual == -1).all() and len(modes.unstable_root)


@pytest.fixture(scope="module")
def growing(model):
    """Modes that grow, with loss factors, of which every frequency is followed once."""
    lossy = changed(model, loss=1e-3 * model.stiffness)
    settings = Settings(**SETTINGS | {"friction_steps": 2, "friction_damping": False, "followed": 12})
    return lossy, settings, complex_modes(lossy, small_friction_map(), settings=settings)


@pytest.mark.exact
def test_the_growth_rate_is_the_sum_of_what_friction_contacts_bodies_and_joints_do(growing):
    _, _, modes = growing
    assert len(modes.unstable_root) > 1
    np.testing.assert_allclose(modes.unstable_growth.sum(axis=1), modes.unstable_root.real, atol=1e-6)
    inside = np.isin(modes.growth_owner, (OF_BODY, OF_JOINTS))
    assert set(modes.growth_part[modes.growth_owner == OF_BODY]) <= set(modes.body_name)
    assert set(modes.followed_mechanism) <= {COUPLING, FALLING, SINGLE} and len(modes.followed_mechanism)
    assert "damping of pad_inner" in modes.growth_term and "damping at abutment" in modes.growth_term
    assert (modes.unstable_growth[:, inside] <= 0).all()
    outside = modes.unstable_growth[:, np.invert(inside)].sum(axis=1)
    np.testing.assert_allclose(modes.unstable_contact.sum(axis=1), outside)


@pytest.mark.exact
def test_linings_are_as_stiff_as_the_pressure_of_each_state_makes_them(growing):
    """At twice the pressure by the root of two: the modes of that brake, and their terms, which add up."""
    lossy, settings, _ = growing
    settings = settings.model_copy(update={"followed": 0})
    lined = np.flatnonzero(np.isin(lossy.coordinate_body, (1, 2)))
    lining = np.zeros_like(lossy.stiffness)
    lining[np.ix_(lined, lined)] = 0.5 * lossy.stiffness[np.ix_(lined, lined)]
    stiffening = changed(lossy, lining_coordinate=lined, lining_stiffness=lining[np.ix_(lined, lined)],
                         lining_loss_factor=1e-3, lining_exponent=0.5, lining_pressure=1e6)
    stiffer = lossy.stiffness + (np.sqrt(2.0) - 1) * lining
    made, *plain = (complex_modes(each, small_friction_map(), settings=settings)
                    for each in (stiffening, lossy, changed(lossy, stiffness=stiffer, loss=1e-3 * stiffer)))
    for pressure, other in zip((1e6, 2e6), plain, strict=True):
        there, alike = made.operating_pressure == pressure, other.operating_pressure == pressure
        np.testing.assert_allclose(made.operating_root[there], other.operating_root[alike], rtol=1e-9, atol=1e-6)
    assert abs(made.operating_root[there] - plain[0].operating_root[alike]).max() > 100.0
    np.testing.assert_allclose(made.unstable_growth.sum(axis=1), made.unstable_root.real, atol=1e-6)


@pytest.mark.exact
def test_the_viscous_equivalent_is_split_as_well(growing):
    lossy, settings, _ = growing
    viscous = Settings(**SETTINGS | {"friction_steps": 2, "friction_damping": False}, hysteretic=False)
    modes = complex_modes(lossy, small_friction_map(), settings=viscous)
    np.testing.assert_allclose(modes.unstable_growth.sum(axis=1), modes.unstable_root.real, atol=1e-6)


@pytest.mark.exact
def test_paths_end_in_their_modes_and_cross_zero_at_the_critical_friction(growing):
    _, settings, modes = growing
    assert modes.followed_mode.tolist() == np.unique(modes.unstable_first).tolist() and settings.followed > 1
    for number, index in enumerate(modes.followed_mode):
        on_path = modes.path_mode == index
        friction, root = modes.path_friction[on_path], modes.path_root[on_path]
        assert root[-1] == pytest.approx(modes.unstable_root[index], rel=1e-8)
        assert friction[0] == 0 and friction[-1] == modes.operating_friction[modes.unstable_operating[index]]
        critical = modes.followed_critical[number]
        assert (root.real[friction > critical] > 0).all() and root.real[friction < critical][-1] < 1e-6 * abs(root[0])
        assert modes.pair_root[number, 0] == root[0] and modes.pair_body[number, 0] in range(4)


def test_the_product_says_how_its_roots_were_made(growing):
    _, settings, modes = growing
    assert restored(Settings, str(modes.settings)) == settings
    stated = StabilitySettings.of(modes)
    assert stated.damping_speed == 1.0 and stated.frequency_max == 8000.0 and stated.sliding_distance == 0.01
    assert [stated.friction_slopes, stated.friction_damping, stated.gyroscopic] == [True, False, True]


def test_paths_can_be_left_out(growing):
    lossy, settings, modes = growing
    chosen = settings.model_copy(update={"followed": 0})
    without = complex_modes(lossy, small_friction_map(), settings=chosen)
    assert not len(without.followed_mode) and not len(without.path_root)
    np.testing.assert_array_equal(without.unstable_root, modes.unstable_root)
