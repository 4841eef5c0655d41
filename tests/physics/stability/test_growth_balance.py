"""The growth rate as a sum: terms add up, each is that of its own matrix, and a change of one shows in the root."""

from dataclasses import fields, replace

import numpy as np
import pytest
import scipy

from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.sliding.model import FrictionState, sliding_model
from pipeline.physics.stability.growth_balance import (
    BODY,
    CONTACT,
    EFFECTS,
    JOINTS,
    SLIP,
    TURNING,
    Losses,
    body_shares,
    growth_terms,
    joint_group,
)
from pipeline.physics.system.forms import spread
from tests.stages.small_brake import small_brake

STATE = FrictionState(0.5, 2e-8, -0.02)


def lossy_brake():
    """The small brake with viscous and hysteretic losses of bodies and joints, and gyroscopic coupling."""
    made = small_brake()
    random = np.random.default_rng(2)
    half = random.standard_normal((4, 4))
    loss, damping, whirl = 0.02 * made.stiffness, np.zeros((10, 10)), np.zeros((10, 10))
    loss[1:5, 1:5], damping[5:9, 5:9] = 1e4 * half @ half.T, 5.0 * half @ half.T
    whirl[1, 2], whirl[2, 1] = 300.0, -300.0
    factors = np.where([name.startswith("abutment") for name in made.joint_name], 0.05, 0.0)
    return type(made)(**{f.name: getattr(made, f.name) for f in fields(made)} | {
        "loss": loss, "damping": damping, "gyroscopic": whirl, "joint_loss_factor": factors})


def about(product):
    model = sliding_model(product, 1, 10.0)
    return replace(model, contacts=replace(model.contacts, damping=model.contacts.preload / 2.0))


def vibrating(modes):
    value, shape = modes
    kept = np.flatnonzero((value.imag > 100) & (abs(value.real) < 0.2 * value.imag))
    return value[kept], shape[:, kept]


def model_and_mode(state=STATE):
    product = small_brake()
    model = about(product)
    modes = quadratic_modes(*model.linearised(state))
    return model, Losses.of(product), *vibrating((modes.value, modes.right))


def quadratic_form(root, x, inertia, damping, stiffness):
    return -(root * np.vdot(x, damping @ x) + np.vdot(x, stiffness @ x)).imag / inertia


@pytest.mark.exact
def test_terms_are_those_of_their_matrices_and_add_up():
    model, losses, roots, shapes = model_and_mode()
    contacts, (_, damping, stiffness) = model.contacts, model.supported()
    friction = model.friction_matrices(STATE)
    for root, x in zip(roots, shapes.T, strict=True):
        terms, parts = growth_terms(model, STATE, root, x, losses)
        inertia, small = 2 * root.imag * np.vdot(x, model.mass @ x).real, 1e-9 * abs(root)
        inside = sum(value for name, value in terms.items() if name.startswith((BODY, JOINTS)))
        assert inside == pytest.approx(quadratic_form(root, x, inertia, damping, stiffness), abs=1e-7 * abs(root))
        assert terms[CONTACT] == pytest.approx(quadratic_form(
            root, x, inertia, spread(contacts.normal, contacts.damping, contacts.normal), 0 * stiffness), abs=small)
        fed = sum(value for name, value in terms.items() if name.startswith("friction at"))
        assert fed + terms[TURNING] + terms[SLIP] == pytest.approx(
            quadratic_form(root, x, inertia, *friction), abs=small)
        assert sum(terms.values()) == pytest.approx(root.real, abs=small)
        assert parts.shape == (6,)
        assert parts.sum() == pytest.approx(fed + terms[CONTACT] + terms[TURNING] + terms[SLIP], abs=small)


@pytest.mark.exact
def test_a_contact_feeds_what_it_feeds_alone():
    model, losses, roots, shapes = model_and_mode()
    for root, x in zip(roots, shapes.T, strict=True):
        parts = growth_terms(model, STATE, root, x, losses)[1]
        for k in range(6):
            alone = {name: np.where(np.arange(6) == k, getattr(model.contacts, name), 0.0)
                     for name in ("stiffness", "damping", "preload")}
            only = replace(model, contacts=replace(model.contacts, **alone))
            state = replace(STATE, coefficient=STATE.coefficient + model.contacts.pressure * STATE.pressure_slope,
                            pressure_slope=0.0)
            drag, follower = only.friction_matrices(state, friction_damping=False)
            turning = only.friction_matrices(STATE)[0] - only.friction_matrices(STATE, friction_damping=False)[0]
            normal = spread(model.contacts.normal, only.contacts.damping, model.contacts.normal)
            inertia = 2 * root.imag * np.vdot(x, model.mass @ x).real
            assert parts[k] == pytest.approx(
                quadratic_form(root, x, inertia, drag + turning + normal, follower), abs=1e-9 * abs(root))


@pytest.mark.exact
def test_every_body_and_group_of_joints_has_what_it_dissipates():
    """Imaginary stiffness and dampers side by side; gyroscopic terms do no work. Nothing is left over."""
    product = lossy_brake()
    model, losses = about(product), Losses.of(product)
    mass, damping, stiffness = model.linearised(STATE)
    more = losses.change(model)
    roots, shapes = vibrating(modes_near(mass, damping + more[0], stiffness + more[1], 1e4j, 20))
    assert len(roots) > 5
    for root, x in zip(roots, shapes.T, strict=True):
        terms, _ = growth_terms(model, STATE, root, x, losses)
        assert sum(terms.values()) == pytest.approx(root.real, abs=1e-9 * abs(root))
        inertia = 2 * root.imag + model.speed * np.vdot(x, model.gyroscopic @ x).imag
        assert terms[f"{BODY}disc"] == pytest.approx(-2e6 * abs(x[0]) ** 2 / inertia)
        assert terms[f"{BODY}pad_inner"] == pytest.approx(
            -root.imag * np.vdot(x, product.damping @ x).real / inertia)
        assert f"{BODY}caliper" not in terms
        stretch, held = abs(product.joint_rows @ x) ** 2, np.array(product.joint_loss_factor) > 0
        both = root.imag * np.array(product.joint_damping) + product.joint_loss_factor * product.joint_stiffness
        assert terms[f"{JOINTS}abutment"] == pytest.approx(-(both * stretch)[held].sum() / inertia)
        assert {name for name in terms if name.startswith(JOINTS)} == {
            f"{JOINTS}{group}" for group in ("guide_pin", "abutment", "finger", "piston")}


@pytest.mark.exact
def test_the_same_holds_with_the_viscous_equivalent_of_the_loss_factors():
    product = lossy_brake()
    model, losses = about(product), Losses.of(product)
    modes = quadratic_modes(*model.linearised(STATE))
    roots, shapes = vibrating((modes.value, modes.right))
    viscous = losses.viscous_motion(sliding_model(product, 1, 10.0), shapes)
    for root, x, z in zip(roots, shapes.T, viscous.T, strict=True):
        terms, _ = growth_terms(model, STATE, root, x, losses, viscous=z)
        assert sum(terms.values()) == pytest.approx(root.real, abs=1e-9 * abs(root))
        assert terms[f"{BODY}disc"] < 0


def test_what_effects_do_is_what_is_left():
    model, losses, roots, shapes = model_and_mode()
    terms, _ = growth_terms(model, STATE, roots[0] + 7.0, shapes[:, 0], losses, remainder=EFFECTS)
    assert sum(terms.values()) == pytest.approx(roots[0].real + 7.0) and abs(terms[EFFECTS]) > 1.0


@pytest.mark.parametrize(("name", "group"), [
    ("guide_pin_leading_axial_front", "guide_pin"), ("abutment_outer_trailing_radial", "abutment"),
    ("finger_normal_leading_inner", "finger"), ("finger_0", "finger"), ("tie", "tie"), ("inner_seal", "inner_seal"),
    ("fluid_column_axial", "fluid_column")])
def test_joints_are_grouped_by_what_they_are(name, group):
    assert joint_group(name) == group


def test_a_little_less_of_a_term_changes_the_growth_by_about_it():
    """Contact damping less by a thousandth moves the root by its share, where friction is next to none."""
    model, losses, roots, shapes = model_and_mode(FrictionState(1e-6))
    less = replace(model, contacts=replace(model.contacts, damping=0.999 * model.contacts.damping))
    moved = quadratic_modes(*less.linearised(1e-6)).value
    for root, x in zip(roots, shapes.T, strict=True):
        change = moved[np.argmin(abs(moved - root))].real - root.real
        share = growth_terms(model, 1e-6, root, x, losses)[0][CONTACT]
        assert change == pytest.approx(-1e-3 * share, rel=0.05, abs=1e-7 * abs(root))


def test_shares_of_the_bodies():
    model, _, _, shapes = model_and_mode()
    for x in shapes.T:
        share = body_shares(model, x)
        assert share.shape == (4,) and share.sum() == pytest.approx(1.0) and (share >= 0).all()
    alone = np.zeros(model.size, complex)
    alone[0] = 1j
    np.testing.assert_array_equal(body_shares(model, alone), [1, 0, 0, 0])


@pytest.mark.exact
def test_coordinates_that_effects_add_lose_nothing():
    product = lossy_brake()
    model, losses = about(product), Losses.of(product)
    larger = losses.enlarged(model.size + 1)
    for more, given in zip(larger.change(model), losses.change(model), strict=True):
        np.testing.assert_array_equal(more, np.pad(given, ((0, 1), (0, 1))))
    shape = np.random.default_rng(1).standard_normal(model.size + 1) + 0j
    moved = larger.viscous_motion(model, shape)
    np.testing.assert_allclose(moved[:-1], losses.viscous_motion(model, shape[:-1]))
    assert moved[-1] == 0


@pytest.mark.exact
def test_losses_are_read_off_sparse_matrices_with_imaginary_stiffnesses():
    """The same brake written with complex stiffnesses and sparse: every part as of the dense model and its losses."""
    product = lossy_brake()
    losses, dense = Losses.of(product), about(product)
    sparse = {name: scipy.sparse.csr_matrix(getattr(dense, name)) for name in ("mass", "gyroscopic", "centrifugal")}
    rows = {name: scipy.sparse.csr_matrix(getattr(dense.contacts, name)) for name in ("normal", "tangent", "lateral")}
    joints = replace(dense.joints, rows=scipy.sparse.csr_matrix(dense.joints.rows),
                     stiffness=dense.joints.stiffness * (1 + 1j * product.joint_loss_factor))
    full = replace(dense, **sparse, damping=scipy.sparse.csr_matrix(product.damping), joints=joints,
                   stiffness=scipy.sparse.csr_matrix(product.stiffness + 1j * product.loss),
                   contacts=replace(dense.contacts, **rows))
    root, shape = -3.0 + 9e3j, np.random.default_rng(3).standard_normal((10, 2)) @ [1.0, 1j]
    expected, contacts = growth_terms(dense, STATE, root, shape, losses)
    terms, parts = growth_terms(full, STATE, root, shape, Losses.within(full, product.contact_body))
    assert terms == pytest.approx(expected) and list(terms) == list(expected)
    np.testing.assert_allclose(parts, contacts)
    assert terms["damping at abutment"] < 0 and terms[f"{BODY}{dense.body_name[1]}"] != 0


def test_a_root_that_does_not_oscillate_has_no_balance():
    """A brake that gives way without vibrating: nothing is divided by an inertia of 0."""
    model, losses, _, shapes = model_and_mode()
    terms, parts = growth_terms(model, STATE, 3.0 + 0j, shapes[:, 0].real.astype(complex), losses, remainder=EFFECTS)
    assert terms.pop(EFFECTS) == 3.0 and not any(terms.values()) and not parts.any()
