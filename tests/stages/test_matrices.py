"""Stage matrices: terms with what they are multiplied by, degrees of freedom by label, what is no system."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from stages.matrices import Settings, matrices

STIFF = np.array([[3.0, -1.0], [-1.0, 2.0]])


def section(tmp_path, **more):
    scipy.io.mmwrite(tmp_path / "m.mtx", scipy.sparse.eye_array(2))
    scipy.io.mmwrite(tmp_path / "k.mtx", scipy.sparse.csr_matrix(STIFF))
    plain = {"mass": {"M": {"file": str(tmp_path / "m.mtx")}}, "stiffness": {"K": {"file": str(tmp_path / "k.mtx")}}}
    return fill(Settings, {**plain, **more}, "case: matrices")


def test_terms_keep_their_entries_and_dependences(tmp_path):
    drag = {"D": {"file": str(tmp_path / "k.mtx"), "times": "friction/speed - 1", "at_frequency": "100 Hz"}}
    found = matrices(settings=section(tmp_path, damping=drag))
    assert int(found.size) == 2 and not len(found.node) and set(found.terms) == {"M", "K", "D"}
    term = found.terms["D"]
    assert str(term.kind) == "damping" and term.coefficient.tolist() == [1.0, -1.0]
    assert term.speed_power.tolist() == [-1, 0] and term.friction_power.tolist() == [1, 0]
    assert term.value.max() == pytest.approx(3.0 / (200 * np.pi))


def test_freedoms_are_matched_by_node_and_direction(tmp_path):
    (tmp_path / "k_a.mtx").write_text("5,1,5,1,3.\n5,2,5,1,-1.\n5,2,5,2,2.\n")
    (tmp_path / "m_a.mtx").write_text("5,2,5,2,7.\n")
    found = matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "m_a.mtx")}},
                                      stiffness={"K": {"file": str(tmp_path / "k_a.mtx")}}))
    assert found.node.tolist() == [5, 5] and found.direction.tolist() == [1, 2]
    assert found.terms["M"].row.tolist() == [1] and found.terms["M"].value.tolist() == [7.0]
    with pytest.raises(ConfigError, match="nodes and directions in all files or in none, found none in K"):
        matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "m_a.mtx")}}))


def test_what_is_no_system_is_refused(tmp_path):
    given = section(tmp_path)
    with pytest.raises(ConfigError, match=r"matrices.mass: expected at least one term"):
        matrices.check({"matrices": Settings()})
    with pytest.raises(ConfigError, match="a name of its own for every term"):
        matrices.check({"matrices": section(tmp_path, damping={"K": given.stiffness["K"]})})
    with pytest.raises(ConfigError, match=r"matrices.damping.D.times: expected a sum of products"):
        strange = {"D": {"file": str(tmp_path / "k.mtx"), "times": "rpm"}}
        matrices.check({"matrices": section(tmp_path, damping=strange)})
    scipy.io.mmwrite(tmp_path / "q.mtx", scipy.sparse.csr_matrix([[1.0, 5.0], [0.0, 1.0]]))
    with pytest.raises(ConfigError, match="a symmetric mass matrix"):
        matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "q.mtx")}}))
    scipy.io.mmwrite(tmp_path / "q.mtx", scipy.sparse.eye_array(3))
    with pytest.raises(ConfigError, match="matrices of one size, found M: 3, K: 2"):
        matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "q.mtx")}}))
