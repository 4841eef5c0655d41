"""Which cases have full matrices, and modes on them; tests of complex_modes compare these with a direct solution."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.case_models.matrices.full_matrices import Mode, full_modes, has_full_matrices
from pipeline.contract import Context, ConvergenceError
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.stability.full_roots import sliding_as

SETTINGS = SimpleNamespace(residual_tolerance=1e-8, hysteretic=True, friction_slopes=True, friction_damping=False,
                           gyroscopic=True, centrifugal=True)
STIFFNESS, CONTACT, MASS = 1e6, 4e5, np.array([1.0, 1.5, 2.0])


class Log(Context):
    """Keeps what it is told, under the name of the case."""

    def remark(self, message):
        self.case.append(message)


def structure(ratio=0.0, loss=0.01):
    body = SimpleNamespace(damping_ratio=ratio, loss_factor=np.array([loss]))
    return SimpleNamespace(body_name=["disc"], body={"disc": body}.get, joint_loss_factor=np.zeros(2),
                           fluid_loss_factor=np.zeros(1))


def posed(stiffness=1.0, terms=()):
    contacts = SimpleNamespace(preload=np.ones(1), stiffness=np.array([stiffness]), fixed=np.array([False]))
    return SimpleNamespace(base=SimpleNamespace(model=SimpleNamespace(contacts=contacts)), terms=terms)


def test_a_brake_with_loss_factors_has_full_matrices():
    assert has_full_matrices(structure(), posed(), SETTINGS, Context())
    assert not has_full_matrices(None, posed(), SETTINGS, Context())
    off = SimpleNamespace(**{**vars(SETTINGS), "residual_tolerance": None})
    assert not has_full_matrices(structure(), posed(), off, Context())
    assert not has_full_matrices(structure(), posed(stiffness=0.0), SETTINGS, Context())


@pytest.mark.parametrize(("given", "case", "settings", "said"), [
    (structure(ratio=0.01), posed(), {}, "damping ratios of bodies"),
    (structure(), posed(terms=("effect",)), {}, "effects of the case"),
    (structure(), posed(), {"hysteretic": False}, "viscous equivalents of loss factors")])
def test_what_they_lack_is_told(given, case, settings, said):
    context = Log(case=[])
    assert not has_full_matrices(given, case, SimpleNamespace(**{**vars(SETTINGS), **settings}), context)
    assert len(context.case) == 1 and said in context.case[0]
    plain = SimpleNamespace(**{**vars(SETTINGS), "hysteretic": False})
    assert has_full_matrices(structure(loss=0.0), posed(), plain, Context())


def masses():
    """Three masses on springs, each on a contact of its own: sparse."""
    diagonal, none = scipy.sparse.identity(3, format="csr"), scipy.sparse.csr_matrix((3, 3))
    contacts = Contacts(diagonal, none, none, np.zeros((3, 3)), np.ones(3), np.ones(3), np.ones(3), np.zeros(3),
                        np.zeros(3))
    return SlidingModel(("body",), np.zeros(3, int), scipy.sparse.diags(MASS, format="csr"), none, none,
                        STIFFNESS * diagonal, none, Joints((), none[:0], np.empty(0), np.empty(0)), contacts, (),
                        none[:0], (), none[:0], 1.0)


def sliding_as_in(full, reduced):
    """The elements slide in the state of the reduced model."""
    return sliding_as(full, reduced), SimpleNamespace(acting=lambda slopes: FrictionState(0.3))


@pytest.mark.exact
def test_modes_are_those_of_the_full_model_in_the_state_of_the_reduced_one():
    """The reduced model holds the first two masses; its contacts and their drag stand for those of the full one."""
    full = masses()
    none = np.zeros((3, 2))
    seen = replace(full.contacts, normal=np.eye(3)[:, :2], tangent=none, lateral=none, stiffness=np.full(3, CONTACT),
                   damping=np.full(3, 2.0))
    reduced = replace(full, contacts=seen)
    about = [sliding_as_in(full, reduced)]
    exact = [np.roots([m, 2.0, STIFFNESS + CONTACT])[0] for m in MASS]
    modes = [Mode(0, 0, complex(exact[0] * 1.001), np.array([1.0, 0.01])), Mode(0, 0, 5.0, np.array([1.0, 0.0])),
             Mode(0, 0, complex(exact[1] * 0.999), np.array([0.01, 1.0]))]
    found = full_modes(about, [reduced], modes, _described, SETTINGS, Context())
    assert found[1] is None
    for mode, root in ((found[0], exact[0]), (found[2], exact[1])):
        assert mode.root == pytest.approx(root, rel=1e-9) and mode.residual <= 1e-8
    assert found[0].terms == {"drag": pytest.approx(2.0)} and found[2].shares.argmax() == 1
    assert found[0].contacts.tolist() == [1.0, 1.0, 1.0]
    assert full_modes(None, [reduced], modes[1:2], _described, SETTINGS, Context()) == [None]


@pytest.mark.exact
def test_two_modes_that_lead_to_one_root_are_refused():
    full = masses()
    reduced = replace(full, contacts=replace(full.contacts, stiffness=np.full(3, CONTACT)))
    mode = Mode(0, 0, complex(np.roots([MASS[0], 0.0, STIFFNESS + CONTACT])[0] * 1.001), np.array([1.0, 0.0, 0.0]))
    about = [sliding_as_in(full, reduced)]
    with pytest.raises(ConvergenceError, match="one near .* for two of them"):
        full_modes(about, [reduced], [mode, mode], _described, SETTINGS, Context())


def _described(model, sliding, roots, vectors):
    return [{"drag": model.contacts.damping[0]}], [model.contacts.preload], [abs(vectors[:, 0])]
