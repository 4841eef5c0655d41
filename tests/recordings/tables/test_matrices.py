"""Columns of matrices, and what MATLAB files of others say of the sampling."""

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from pipeline.contract import ConfigError
from pipeline.recordings.columns import matlab_waveforms, read_columns, read_matlab
from pipeline.recordings.tables.matrices import stated_rates, time_axes, vectors

DATA = np.column_stack([np.arange(6) / 10, np.arange(6.0), -np.arange(6.0)])


@pytest.mark.parametrize("form", ["4", "5"])
@pytest.mark.parametrize("turned", [False, True])
def test_columns_of_a_matrix_have_the_names_of_matlab(tmp_path, form, turned):
    savemat(tmp_path / "a.mat", {"data": DATA.T if turned else DATA, "fs": 10.0}, format=form)
    columns = read_matlab(tmp_path / "a.mat")
    names = [f"data({k},:)" if turned else f"data(:,{k})" for k in (1, 2, 3)]
    assert list(columns) == [*names, "fs"] and columns[names[2]].tolist() == DATA[:, 2].tolist()
    assert "fs = 10, which may mean sample_rate: 10 Hz" in stated_rates(columns)


def in_7_3(path, fill):
    with h5py.File(path, "w", userblock_size=512) as h5:
        fill(h5)
    with open(path, "r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: any")


def test_matrices_of_version_7_3_lie_turned_round_in_the_file(tmp_path):
    def fill(h5):
        h5["data"] = DATA.T
        h5["note"] = np.array([[116], [120]], np.uint16)
        h5["note"].attrs["MATLAB_class"] = np.bytes_("char")

    in_7_3(tmp_path / "a.mat", fill)
    columns = read_matlab(tmp_path / "a.mat")
    assert list(columns) == ["data(:,1)", "data(:,2)", "data(:,3)"]
    assert columns["data(:,2)"].tolist() == DATA[:, 1].tolist()
    with h5py.File(tmp_path / "a.h5", "w") as h5:
        h5["data"] = DATA
    assert list(read_columns(tmp_path / "a.h5")) == ["data[:,0]", "data[:,1]", "data[:,2]"]


@pytest.mark.parametrize("version", ["5", "7.3"])
def test_structures_of_testlab_state_their_rate(tmp_path, version):
    signal = {"x_values": {"start_value": 0.5, "increment": 1e-3, "number_of_values": 6.0},
              "y_values": {"values": DATA[:, 1:]}, "function_record": {"name": "pad"}}
    if version == "5":
        savemat(tmp_path / "a.mat", {"Signal_0": signal, "other": np.arange(6.0)})
    else:
        def fill(h5):
            for name, value in signal["x_values"].items():
                h5[f"Signal_0/x_values/{name}"] = [[value]]
            h5["Signal_0/y_values/values"], h5["other"] = DATA[:, 1:].T, np.arange(6.0)[None]

        in_7_3(tmp_path / "a.mat", fill)
    waves = matlab_waveforms(tmp_path / "a.mat")
    second = waves["Signal_0.y_values.values(:,2)"]
    assert second.rate == pytest.approx(1000) and second.begin == 0.5 and second.values.tolist() == DATA[:, 2].tolist()
    assert waves["other"].rate is None
    assert not time_axes({"x_values.increment": np.array([0.0])})


def test_images_and_texts_are_no_columns():
    variables = {"image": np.zeros((300, 400)), "cube": np.zeros((2, 3, 4)), "x": np.arange(3.0), "n": np.array("a")}
    assert list(vectors(variables, "a.mat")) == ["x"]
    with pytest.raises(ConfigError, match="a vector of numbers, found image, cube, n; save samples and times"):
        vectors({k: v for k, v in variables.items() if k != "x"}, "a.mat")
