"""Stage matrices: terms with what they are multiplied by, degrees of freedom by label, what is no system."""

from pathlib import Path

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError, Context
from pipeline.contract.settings import fill
from pipeline.decks import matrix_files
from stages.matrices import Settings, matrices
from stages.matrix_modes import Settings as Modes
from stages.matrix_modes import matrix_modes

TWO_PI = 2.0 * np.pi
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
    scipy.io.mmwrite(tmp_path / "q.mtx", scipy.sparse.csr_matrix([[1.0, 5.0], [2.0, 1.0]]))
    with pytest.raises(ConfigError, match="a symmetric mass matrix"):
        matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "q.mtx")}}))
    scipy.io.mmwrite(tmp_path / "q.mtx", scipy.sparse.eye_array(3))
    with pytest.raises(ConfigError, match="matrices of one size, found M: 3, K: 2"):
        matrices(settings=section(tmp_path, mass={"M": {"file": str(tmp_path / "q.mtx")}}))


@pytest.fixture
def quickly(monkeypatch):
    """Files are read in this process instead of one process each; that is tested above."""
    monkeypatch.setattr("stages.matrices.read", lambda path, variable: matrix_files._opened(Path(path), variable))


class Told(Context):
    """Keeps its notes, which are told in a pipe too."""

    def __init__(self):
        super().__init__()
        object.__setattr__(self, "notes", [])

    def remark(self, message):
        self.notes.append(message)


def system(folder, stiffness, mass, friction=None, **form):
    """(Matrices, notes) of files in ``folder``; ``form``: symmetry of the stiffness."""
    terms = {"K": {"file": str(folder / stiffness), **form}}
    if friction:
        terms["F"] = {"file": str(folder / friction), "times": "friction"}
    context = Told()
    given = matrices(settings=fill(Settings, {"mass": {"M": {"file": str(folder / mass)}}, "stiffness": terms}, "case"),
                     context=context)
    assert given.remark.tolist() == context.notes
    return given, context.notes


def roots(given, **settings):
    """(Roots, unstable ones) in 1/s up to 5 kHz."""
    settings = {"frequency_max": "5 kHz", "map_friction": [1.0], **settings}
    found = matrix_modes(given, settings=fill(Modes, settings, "case"))
    return found.roots.root, found.roots.unstable_root


def labelled(path, matrix, labels, keep=lambda i, j: True):
    """An .mtx of Abaqus with the entries that ``keep`` chooses."""
    path.write_text("".join(
        f"{labels[i][0]},{labels[i][1]}, {labels[j][0]},{labels[j][1]}, {matrix[i, j]:.15e}\n"
        for i, j in zip(*np.nonzero(matrix), strict=True) if keep(i, j)))


def files(folder, write, labels, keep=lambda i, j: True, **matrices):
    """Names of the files that hold ``matrices``, each as its name, by a writer: its suffix and how it writes."""
    suffix = write.partition(" ")[0]
    for name, matrix in matrices.items():
        path, entries = folder / f"{name}.{suffix}", list(zip(*np.nonzero(matrix), strict=True))
        if write == "mtx of Abaqus":
            labelled(path, matrix, labels, keep)
        elif write == "mtx of coordinates":
            path.write_text("".join(f"{i + 1} {j + 1} {matrix[i, j]:.15e}\n" for i, j in entries))
        elif write == "pch":
            node = [f"{n},{d}" for n, d in labels]
            path.write_text("DMIG,A,0,1,2,0\n" + "".join(f"DMIG,A,{node[j]},,{node[i]},{matrix[i, j]:.15e}\n"
                                                         for i, j in entries))
        elif write == "mat":
            scipy.io.savemat(path, {"A": scipy.sparse.csc_matrix(matrix)})
        elif write == "npz":
            scipy.sparse.save_npz(path, scipy.sparse.csc_matrix(matrix))
        else:
            kind = np.asarray if write == "mtx of an array" else scipy.sparse.coo_matrix
            scipy.io.mmwrite(path, kind(matrix), symmetry="general", precision=15)
    return [f"{name}.{suffix}" for name in matrices]


#: chain of three masses to the ground, N/m and kg; the last node is held
CHAIN = np.array([[2e7, -1e7, 0, 0], [-1e7, 2e7, -1e7, 0], [0, -1e7, 1.5e7, -5e6], [0, 0, -5e6, 5e6]])
MASSES = np.diag([1.0, 2.0, 3.0, 1.0])
NODES = [(1, 1), (2, 1), (3, 1), (4, 1)]
FREQUENCY = np.sqrt(scipy.linalg.eigh(CHAIN[:3, :3], MASSES[:3, :3], eigvals_only=True)) / TWO_PI


@pytest.mark.exact
@pytest.mark.usefixtures("quickly")
@pytest.mark.parametrize("write", ["mtx of Abaqus", "mtx", "mat", "npz", "pch"])
@pytest.mark.parametrize("penalty, mass", [(1e36, True), (1e36, False), (1e30, True), (1e20, True)])
def test_a_constrained_degree_of_freedom_is_taken_out(tmp_path, write, penalty, mass):
    """Of the frequencies of the chain none is missed, none is added; said with its node, or its row."""
    stiff, masses = CHAIN + np.diag([0, 0, 0, penalty]), MASSES.copy()
    masses[3, 3] *= mass
    given, notes = system(tmp_path, *files(tmp_path, write, NODES, lambda i, j: i >= j, k=stiff, m=masses))
    named = write in ("mtx of Abaqus", "pch")
    assert int(given.size) == 3 and given.constrained.tolist() == [3]
    where = "node 4 direction 1" if named else "row 4"
    assert f"matrices: 1 of 4 degrees of freedom ({where}): held by a penalty" in notes[-1]
    assert given.node.tolist() == ([1, 2, 3] if named else [])
    np.testing.assert_allclose(roots(given)[0], 1j * TWO_PI * FREQUENCY, rtol=1e-7, atol=1e-3)


@pytest.mark.usefixtures("quickly")
def test_what_only_held_degrees_of_freedom_know_goes_with_them(tmp_path):
    """A multiplier between two held nodes; a single mass that is left."""
    labels = [(-1, 1), (1, 1), (2, 1), (3, 1)]
    stiff = np.diag([0, 1e36, 1e36, 4e6])
    stiff[0, 1:3] = stiff[1:3, 0] = 1.0, -1.0
    labelled(tmp_path / "k.mtx", stiff, labels, lambda i, j: i >= j)
    labelled(tmp_path / "m.mtx", np.eye(4), labels, lambda i, j: i == j > 0)
    given, notes = system(tmp_path, "k.mtx", "m.mtx")
    assert given.node.tolist() == [3] and given.constrained.tolist() == [0, 1, 2]
    assert "2 of 4 degrees of freedom (node 1 direction 1, node 2 direction 1)" in notes[-2]
    assert "(node -1 direction 1): without entries beside these" in notes[-1]
    assert roots(given)[0] == pytest.approx([2000j])


@pytest.mark.exact
@pytest.mark.usefixtures("quickly")
def test_a_multiplier_of_abaqus_ties_two_nodes(tmp_path):
    """Node -1, of one entry for each of the nodes 2 and 3: these move as one."""
    labels = [(-1, 1), *NODES]
    stiff, masses = np.zeros((5, 5)), np.zeros((5, 5))
    stiff[1:, 1:], masses[1:, 1:] = CHAIN + np.diag([0, 0, 0, 1e36]), MASSES
    stiff[0, 2:4] = stiff[2:4, 0] = 1e7, -1e7
    labelled(tmp_path / "k.mtx", stiff, labels, lambda i, j: j > 0 and (i >= j or i == 0))
    labelled(tmp_path / "m.mtx", masses, labels)
    given, _ = system(tmp_path, "k.mtx", "m.mtx")
    tied = np.array([[1, 0], [0, 1], [0, 1.0]])
    expected = scipy.linalg.eigh(tied.T @ CHAIN[:3, :3] @ tied, tied.T @ MASSES[:3, :3] @ tied, eigvals_only=True)
    np.testing.assert_allclose(roots(given)[0], 1j * np.sqrt(expected), rtol=1e-6, atol=1e-2)


#: two directions of one node, and friction 1 that makes force along 1 from motion along 3
BRAKE = np.array([[3.947841760435743e7, 1.973920880217872e6], [1.973920880217872e6, 4.026798595644458e7]])
PUSH = np.array([[0, -7.895683520871487e6], [0, 0]])
#: the root that grows with half of it, in 1/s, s^2 = -eigenvalue
GROWS = next(s for s in np.sqrt(-np.linalg.eigvals(BRAKE + 0.5 * PUSH).astype(complex)) if s.imag > 0)


@pytest.mark.exact
@pytest.mark.usefixtures("quickly")
@pytest.mark.parametrize("turned", [False, True], ids=["upper", "lower"])
@pytest.mark.parametrize("write", ["mtx of Abaqus", "mtx of coordinates", "mtx", "mtx of an array", "mat", "pch"])
def test_friction_in_one_triangle_is_not_mirrored(tmp_path, turned, write):
    """The brake flutters at 1005.28 Hz and grows by 153.10 1/s, whatever wrote it and whichever triangle it is in."""
    order = np.ix_([1, 0], [1, 0]) if turned else np.ix_([0, 1], [0, 1])
    given, notes = system(tmp_path, *files(tmp_path, write, [(7, 1), (7, 3)], k=BRAKE[order], m=np.eye(2),
                                           f=PUSH[order]))
    assert len(notes) == 1 and "one side of its diagonal and is taken as it stands" in notes[0]
    assert roots(given, friction=0.5)[1] == pytest.approx([GROWS], rel=1e-9)
    assert (GROWS.imag / TWO_PI, GROWS.real) == pytest.approx((1005.28, 153.10), abs=5e-3)


@pytest.mark.usefixtures("quickly")
def test_half_a_stiffness_of_matrix_market_is_asked_back(tmp_path):
    scipy.io.mmwrite(tmp_path / "k.mtx", scipy.sparse.coo_matrix(np.tril(CHAIN)), symmetry="general")
    scipy.io.mmwrite(tmp_path / "m.mtx", scipy.sparse.coo_matrix(MASSES))
    with pytest.raises(ConfigError, match="matrices.stiffness.K.symmetry: .* as k.mtx has, found none; write"):
        system(tmp_path, "k.mtx", "m.mtx")
    given, notes = system(tmp_path, "k.mtx", "m.mtx", symmetry="symmetric")
    term = given.terms["K"]
    np.testing.assert_array_equal(
        scipy.sparse.coo_matrix((term.value, (term.row, term.column))).toarray(), CHAIN)
    assert not notes


@pytest.mark.usefixtures("quickly")
def test_a_system_in_which_nothing_moves_is_refused(tmp_path):
    labelled(tmp_path / "k.mtx", np.diag([1e36, 1.0]), NODES)
    labelled(tmp_path / "m.mtx", np.diag([1.0, 0]), NODES)
    (tmp_path / "zero.mtx").write_text("1,1,1,1,0.\n")
    assert int(system(tmp_path, "k.mtx", "m.mtx")[0].size) == 1
    with pytest.raises(ConfigError, match="matrices: expected degrees of freedom that can move, found none"):
        system(tmp_path, "zero.mtx", "zero.mtx")
