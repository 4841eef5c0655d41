"""Modes of operating points as fields; stage complex_modes holds those on full matrices beside a direct solution."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.operating_modes import (
    balances,
    diameters,
    growing,
    path_fields_of,
    planes,
    unstable_fields,
)
from pipeline.case_models.steady_sliding import posed
from pipeline.contract import Context
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.sliding.equilibrium import closure_response
from pipeline.physics.stability.growth_balance import Losses
from stages.complex_modes import Settings
from tests.stages.small_brake import small_brake

SETTINGS = Settings(friction_damping=False)


@dataclass(frozen=True)
class Outcome:
    near: np.ndarray
    motion: np.ndarray
    terms: tuple
    contacts: np.ndarray
    shares: np.ndarray
    reduced: np.ndarray
    residual: np.ndarray


def outcome(*roots):
    """Modes by their roots, each with its number in all that it holds."""
    order = np.arange(len(roots))
    return Outcome(np.array(roots), np.eye(10)[:, 1:len(roots) + 1], tuple({"fed": float(k)} for k in order),
                   np.outer(order, np.ones(6)), np.outer(order, np.ones(5)), np.array(roots) + 1.0, order * 1e-7)


def test_modes_that_decay_are_dropped_with_all_that_is_theirs():
    kept = growing(outcome(5 + 100j, -1 + 200j, 7 + 300j), SETTINGS)
    assert kept.near.tolist() == [5 + 100j, 7 + 300j] and kept.terms == ({"fed": 0.0}, {"fed": 2.0})
    assert kept.motion.shape == (10, 2) and kept.contacts[:, 0].tolist() == [0, 2] == kept.shares[:, 0].tolist()
    assert kept.reduced.tolist() == [6 + 100j, 8 + 300j] and kept.residual.tolist() == [0.0, 2e-7]


def test_fields_stand_strongest_first_whatever_the_operating_point():
    model = small_brake()
    bodies = (*model.body_name, "body that an effect adds")
    made = unstable_fields([outcome(5 + 1000j), outcome(6 + 2000j, 9 + 1001j)], model, bodies)
    assert made["unstable_root"] == [9 + 1001j, 6 + 2000j, 5 + 1000j] and made["unstable_operating"] == [1, 1, 0]
    assert made["unstable_first"].tolist() == [0, 1, 0] and made["growth_term"] == ["fed"]
    assert made["unstable_growth"].tolist() == [[1.0], [0.0], [0.0]]
    assert made["unstable_share"].shape == (3, 5) and made["body_name"] == list(bodies)
    assert made["unstable_contact"].shape == (3, 6)
    assert made["unstable_reduced"][0] == 10 + 1001j and made["unstable_residual"] == [1e-7, 0.0, 0.0]
    none = unstable_fields([outcome()], model, model.body_name)
    assert none["growth_term"] == [] and none["unstable_growth"].shape == (0, 0) and len(none["unstable_shape"]) == 0
    assert all(len(v) == 0 for v in path_fields_of(None, [None], [outcome()], model, SETTINGS, Context()).values())


@pytest.mark.exact
def test_balances_of_a_mode_add_up_to_its_growth_rate():
    product = small_brake()
    case = posed(product, 1, 10.0, 1.0)
    load = product.pressure[1] * product.input_area
    sliding = case.slide(closure_response(case.bench.model), load, constant(0.5), 0.5, SETTINGS)
    model = sliding.about(case.bench.model)
    roots, shapes = modes_near(*model.linearised(sliding.acting(), friction_damping=False), 1e4j, 3)
    losses = Losses.of(product)
    terms, contacts, shares = balances(model, sliding, roots, shapes, losses, shapes, SETTINGS)
    assert [sum(t.values()) for t in terms] == pytest.approx(roots.real.tolist(), abs=1e-8 * abs(roots[0]))
    assert contacts.shape == (3, len(model.contacts.area)) and shares.sum(axis=1) == pytest.approx([1.0] * 3)


def test_a_system_without_a_disc_has_no_diameters():
    plain = SimpleNamespace(body_name=("pin",), visible_body=np.zeros(2, int), visible_position=np.zeros((2, 3)))
    assert diameters(plain, np.ones((2, 2, 3))).tolist() == [-1, -1]
    assert planes(plain, np.ones((2, 2, 3)))["unstable_in_plane"].tolist() == [-1, -1]


@pytest.mark.exact
def test_diameters_of_the_disc_alone_are_counted_in_each_plane():
    """A pad, which moves otherwise, is left out: 3 diameters tangentially, 5 axially with twice the amplitude."""
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    ring = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    model = SimpleNamespace(body_name=("pad", "disc"), visible_body=np.repeat([1, 0], 24),
                            visible_position=np.vstack((ring, ring)))
    turned = np.stack((-np.sin(angle), np.cos(angle), 0 * angle), axis=1) * np.exp(3j * angle)[:, None]
    disc = turned + 2 * np.exp(5j * angle)[:, None] * [0, 0, 1]
    made = planes(model, np.concatenate((disc, 9 * ring))[None])
    assert made["unstable_in_plane"].tolist() == [3] and made["unstable_out_of_plane"].tolist() == [5]
    assert made["unstable_axial"] == pytest.approx([0.8])
