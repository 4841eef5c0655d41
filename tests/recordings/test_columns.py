"""Columns of MATLAB files and plain HDF5; tables that are written."""

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from pipeline.contract import ConfigError
from pipeline.recordings.columns import read_columns, read_matlab, write_table
from pipeline.recordings.samples import channel
from pipeline.recordings.tables.text import read_table


def test_matlab_vectors_come_back_flat_and_text_is_left_out(tmp_path):
    savemat(tmp_path / "a.mat", {"x": np.arange(3.0)[:, None], "k": 2, "name": "bench", "m": np.zeros((3, 3, 3))})
    found = read_matlab(tmp_path / "a.mat")
    assert set(found) == {"x", "k"} and found["x"].tolist() == [0, 1, 2] and found["k"].tolist() == [2]


def test_matlab_7_3_is_hdf5(tmp_path):
    with h5py.File(tmp_path / "b.mat", "w", userblock_size=512) as h5:
        h5["x"] = np.arange(4.0)[None, :]
    with open(tmp_path / "b.mat", "r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: any")
    assert read_matlab(tmp_path / "b.mat")["x"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize("version", ["5", "7.3"])
def test_cells_and_structures_are_opened(tmp_path, version):
    """x = {[0 1], 'text'; [2 3 4], {5}}; s.rate = 100, column by column as MATLAB counts cells."""
    parts = [np.arange(2.0), np.array([2.0, 3.0, 4.0]), "text", np.array([[np.array([5.0])]], object)]
    cells, path = np.empty((2, 2), object), tmp_path / "f.mat"
    for k, part in enumerate(parts):
        cells[k % 2, k // 2] = part
    if version == "5":
        savemat(path, {"x": cells, "s": {"rate": 100.0}})
    else:
        with h5py.File(path, "w", userblock_size=512) as h5:
            kept = h5.create_group("#refs#")
            for name, part in (("a", parts[0]), ("b", parts[1]), ("c", np.array([116], np.uint16)[:, None, None]),
                               ("e", np.array([5.0]))):
                kept[name] = part
            kept.create_dataset("d", (1, 1), h5py.ref_dtype)[0, 0] = kept["e"].ref
            table = h5.create_dataset("x", (2, 2), h5py.ref_dtype)       # MATLAB's axes, turned round
            table[0, 0], table[0, 1], table[1, 0], table[1, 1] = (kept[n].ref for n in "abcd")
            h5["s/rate"] = [[100.0]]
        with open(path, "r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file, Platform: any")
    found = {name: values.tolist() for name, values in read_matlab(path).items()}
    assert found == {"x{1}": [0, 1], "x{2}": [2, 3, 4], "x{4}{1}": [5], "s.rate": [100]}


def test_matlab_refuses_what_is_none(tmp_path):
    (tmp_path / "c.mat").write_bytes(b"no matlab file at all" * 20)
    with pytest.raises(ConfigError, match=r"c\.mat: expected a MATLAB file"):
        read_matlab(tmp_path / "c.mat")
    savemat(tmp_path / "d.mat", {"name": "bench"})
    with pytest.raises(ConfigError, match="expected a vector of numbers, found name"):
        read_matlab(tmp_path / "d.mat")


@pytest.mark.parametrize("form", [{"format": "5"}, {"format": "5", "do_compression": True}, {"format": "4"}])
def test_matlab_refuses_a_file_that_is_cut_off_anywhere(tmp_path, form):
    """One sentence for every length; what reads all the same is whole as far as it goes."""
    savemat(tmp_path / "whole.mat", {"x": np.arange(5.0), "y": np.ones(3)}, **form)
    content, cut, read = (tmp_path / "whole.mat").read_bytes(), tmp_path / "cut.mat", set()
    for length in range(len(content)):
        cut.write_bytes(content[:length])
        try:
            read.add(frozenset(read_matlab(cut)))
        except ConfigError as error:
            assert error.where == cut
    assert frozenset(read_matlab(tmp_path / "whole.mat")) == {"x", "y"}
    assert read <= {frozenset("x")}, "a cut between two variables leaves a whole file of the first"


@pytest.mark.parametrize("content, message", [
    (b"", "another kind of file"), (b"time,force\n0,1\n", "another kind of file"),
    (b"MATLAB 7.3 MAT-file, Platform: any", "a MATLAB file of version 7.3"), (b"\0\0\0\0", "an undamaged MATLAB file")])
def test_matlab_tells_what_it_found_instead(tmp_path, content, message):
    (tmp_path / "e.mat").write_bytes(content)
    with pytest.raises(ConfigError, match=message):
        read_matlab(tmp_path / "e.mat")
    with pytest.raises(ConfigError, match="a readable MATLAB file"):
        read_matlab(tmp_path)


def test_the_suffix_tells_the_kind_of_file(tmp_path):
    """The same column three times; what a suffix promises and the file is not is refused."""
    savemat(tmp_path / "a.mat", {"volt": np.arange(3.0)})
    (tmp_path / "a.csv").write_text("volt\n0\n1\n2\n")
    with h5py.File(tmp_path / "a.h5", "w") as h5:
        h5["volt"], h5["note"] = np.arange(3.0), "bench"
    for name in ("a.mat", "a.csv", "a.h5"):
        found = read_columns(tmp_path / name)
        assert list(found) == ["volt"] and found["volt"].tolist() == [0, 1, 2]
    (tmp_path / "b.h5").write_bytes(b"no HDF5 file")
    with pytest.raises(ConfigError, match=r"b\.h5: expected an HDF5 file"):
        read_columns(tmp_path / "b.h5")


def test_a_table_that_is_written_is_read(tmp_path):
    values = np.array([1.0, np.nan, 1 / 3])
    made = {"a b": channel(values, "m", "displacement", 10.0, 0.5, "a"), "c": channel([1, 2, 3.5], "N", "force", 10.0,
                                                                                        0.5, "c")}
    write_table(tmp_path / "a.csv", made)
    found = read_table(tmp_path / "a.csv")
    np.testing.assert_array_equal(found["a b"], values)
    np.testing.assert_allclose(found["time"], [0.5, 0.6, 0.7])
    with pytest.raises(ConfigError, match="one rate, begin and length"):
        write_table(tmp_path / "b.csv", made | {"d": channel([1.0], "N", "force", 1.0, 0.0, "d")})
