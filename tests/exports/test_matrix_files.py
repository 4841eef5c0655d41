"""A system of matrices as files: the case beside them gives the roots of the run that it is from."""

from pathlib import Path

import numpy as np
import pytest
import scipy

import stages
from pipeline.contract import ConfigError, Context, case, store
from pipeline.decks import matrix_files
from pipeline.exports.matrix_files import FORMATS, write_system
from pipeline.exports.matrix_system import full_system, given_system, is_given_as_matrices, reduced_system
from pipeline.physics.numerics.sparse_solver import available
from pipeline.products import ComplexModes, Matrices, MatrixTerm
from pipeline.recordings import registry
from tests.exports.small_runs import written


@pytest.fixture
def quickly(monkeypatch):
    """Files are read in this process instead of one process each; that is tested with the stage and below."""
    monkeypatch.setattr("stages.matrices.read", lambda path, variable: matrix_files._opened(Path(path), variable))


def ran(file, solved=True):
    """(Matrices, MatrixModes) of the case at ``file``."""
    sections = case.load(file, stages.CHAINS, stages.load, ("matrix_modes.map_friction=[1]",), registry.path).sections
    given = stages.load("matrices")(settings=sections["matrices"])
    solved = solved and stages.load("matrix_modes")(given, settings=sections["matrix_modes"],
                                                    context=Context(solver=available()[0]))
    return given, solved


def unstable(run, operating, name="unstable_reduced"):
    modes = store.read(ComplexModes, run / "complex_modes.h5")
    return np.sort_complex(getattr(modes, name)[modes.unstable_operating == operating])


@pytest.mark.exact
@pytest.mark.usefixtures("quickly")
def test_unstable_roots_of_a_brake_come_back(brake, tmp_path):
    """With gyroscopic, centrifugal and circulatory terms and loss factors as imaginary stiffness: to 1e-8."""
    given, solved = ran(write_system(reduced_system(brake, 3), tmp_path / "out", "a test"))
    expected = unstable(brake, 3)
    assert len(expected) >= 1 and {"gyroscopic", "circulatory", "hysteretic_loss"} <= set(given.terms)
    np.testing.assert_allclose(np.sort_complex(solved.roots.unstable_root), expected, rtol=1e-8)


@pytest.mark.filterwarnings("ignore:The default value for `spmatrix`:DeprecationWarning")      # SciPy 1.18
def test_both_formats_hold_the_same_numbers(brake, tmp_path):
    system = reduced_system(brake, 3)
    market = write_system(system, tmp_path / "market", "a test", FORMATS["mtx"])
    assert "{file: mass.mtx}" in market.read_text() and not list((tmp_path / "market").glob("mass.npz"))
    write_system(system, tmp_path / "numpy", "a test", FORMATS["npz"])
    for term in system.terms:
        text = scipy.io.mmread(tmp_path / "market" / f"{term.name}.mtx").toarray()
        np.testing.assert_array_equal(text, term.matrix)
        np.testing.assert_array_equal(scipy.sparse.load_npz(tmp_path / "numpy" / f"{term.name}.npz").toarray(), text)


@pytest.mark.exact
@pytest.mark.usefixtures("quickly")
def test_unstable_roots_of_the_full_matrices_come_back(brake, tmp_path):
    """Those of complex_modes, to what these leave of their equation."""
    _, solved = ran(write_system(full_system(brake, 1), tmp_path / "full", "a test", FORMATS["npz"]))
    expected = unstable(brake, 1, "unstable_root")
    assert len(expected) >= 1 and abs(expected - unstable(brake, 1)).max() > 0.1
    np.testing.assert_allclose(np.sort_complex(solved.roots.unstable_root), expected, rtol=1e-8)


def test_what_was_given_as_matrices_is_given_again(tmp_path):
    """Terms with their dependence, by number or by node and direction."""
    terms = {"m": ("mass", "1", [[2.0, 0.0], [0.0, 1.0]]), "q": ("stiffness", "friction/speed - 1", [[0, 3.0], [1, 0]]),
             "h": ("loss", "1", [[0.1, 0.0], [0.0, 0.0]]), "c": ("stiffness", "1", [[1.0, 0.5], [0.0, 1.0]])}
    entries = {name: scipy.sparse.coo_matrix(matrix) for name, (_, _, matrix) in terms.items()}
    run = written(tmp_path, Matrices(size=2, node=[5, 5], direction=[1, 3], reference_speed=8.0, constrained=[],
                                     remark=[], terms={
        name: MatrixTerm(kind=kind, times=times, source="a file", row=entries[name].row, column=entries[name].col,
                         value=entries[name].data, coefficient=[1.0], speed_power=[0], friction_power=[0])
        for name, (kind, times, _) in terms.items()}))
    assert is_given_as_matrices(run)
    case_file = write_system(given_system(run), tmp_path / "again", "a test", FORMATS["mtx"])
    assert "units are as they were given" in case_file.read_text()
    assert not (tmp_path / "again" / "rows.npz").exists()
    assert (tmp_path / "again" / "freedoms.csv").read_text() == "row,node,direction\n1,5,1\n2,5,3\n"
    text = case_file.read_text()
    assert "c: {file: c.mtx, symmetry: general}" in text and text.count("symmetry") == 1
    given, _ = ran(case_file, solved=False)
    assert float(given.reference_speed) == 8.0
    for name, (kind, times, matrix) in terms.items():
        term = given.terms[name]
        assert (str(term.kind), str(term.times)) == (kind, times)
        np.testing.assert_array_equal(scipy.sparse.csr_matrix((term.value, (term.row, term.column)), (2, 2)).toarray(),
                                      matrix)


def test_files_say_what_each_row_is(brake, rig, tmp_path):
    write_system(full_system(brake, 0), tmp_path / "full", "a test")
    lines = (tmp_path / "full" / "freedoms.csv").read_text().splitlines()
    size = scipy.sparse.load_npz(tmp_path / "full" / "mass.npz").shape[0]
    assert lines[0] == "row,body,node,direction" and len(lines) == size + 1 and lines[-1] == f"{size},brake_fluid,,"
    write_system(reduced_system(rig, 1), tmp_path / "rig", "a test")
    assert (tmp_path / "rig" / "freedoms.csv").read_text() == "row,body\n1,block\n2,block\n"
    with np.load(tmp_path / "rig" / "rows.npz") as rows:
        assert rows["sensor_name"].tolist() == ["along"] and rows["inputs"].shape == (1, 2)


def test_a_folder_that_exists_is_left_alone(rig, tmp_path):
    (tmp_path / "mine").mkdir()
    for path, told in ((tmp_path / "mine", "a name that is free, found a folder"),
                       (tmp_path / "no" / "where", "expected a folder, found none; make it first")):
        with pytest.raises(ConfigError, match=told):
            write_system(reduced_system(rig), path, "a test")
