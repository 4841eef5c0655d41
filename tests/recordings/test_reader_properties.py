"""Properties of readers: whatever samples, names, rates and units others write, the same numbers are read."""

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat

from pipeline.contract.errors import ConfigError
from pipeline.products import Run
from pipeline.recordings.audio import read_audio, write_audio
from pipeline.recordings.columns import read_matlab, write_table
from pipeline.recordings.mdf import read_mdf
from pipeline.recordings.neutral import read_neutral, write_neutral
from pipeline.recordings.samples import channel, with_gaps
from pipeline.recordings.sep005 import run_of, signals_of
from pipeline.recordings.tables.text import read_table
from pipeline.recordings.tdms import read_tdms
from pipeline.recordings.uff import read_uff
from pipeline.recordings.uff_writer import write_uff
from tests.drawn import FEW

FINITE = st.floats(-1e9, 1e9).map(lambda v: v if abs(v) > 1e-9 else 0.0)
SAMPLES = st.lists(FINITE, min_size=2, max_size=40).map(np.array)
GAPPED = (
    st.lists(FINITE | st.just(np.nan), min_size=3, max_size=40).map(np.array).filter(lambda v: np.isfinite(v).any())
)
NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
RATES = st.integers(1, 200_000).map(float)
UNITS = st.sampled_from(
    [
        ("m", "displacement", 1.0),
        ("mm", "displacement", 1e-3),
        ("g", "acceleration", 9.80665),
        ("kN", "force", 1e3),
        ("Pa", "pressure", 1.0),
        ("bar", "pressure", 1e5),
    ]
)


@FEW
@given(
    st.dictionaries(
        NAMES.filter(lambda n: n not in ("time", "na", "nan", "none", "null")), GAPPED, min_size=1, max_size=3
    ),
    RATES,
)
def test_tables(tmp_path, columns, rate):
    size = min(map(len, columns.values()))
    made = {name: channel(np.r_[1.0, values[:size]], "1", "value", rate, 0.5, name) for name, values in columns.items()}
    write_table(tmp_path / "a.csv", made)
    found = read_table(tmp_path / "a.csv")
    assert list(found) == ["time", *made]
    for name, one in made.items():
        np.testing.assert_array_equal(found[name], with_gaps(one))
    np.testing.assert_array_equal(found["time"], 0.5 + np.arange(size + 1) / rate)


@FEW
@given(
    st.dictionaries(NAMES, SAMPLES, min_size=1, max_size=4),
    st.sampled_from(["4", "5"]),
    st.booleans(),
    st.sampled_from(["row", "column"]),
)
def test_matlab(tmp_path, variables, version, packed, shape):
    savemat(tmp_path / "a.mat", variables, format=version, do_compression=packed and version == "5", oned_as=shape)
    found = read_matlab(tmp_path / "a.mat")
    assert set(found) == set(variables)
    for name, values in variables.items():
        np.testing.assert_array_equal(found[name], values)


@FEW
@given(NAMES, GAPPED, UNITS, RATES, st.floats(-100, 100))
def test_plain_hdf5(tmp_path, name, samples, unit, rate, begin):
    spelt, measures, size = unit
    write_neutral(
        tmp_path / "a.h5",
        {
            "r": {
                "description": "",
                "repeat_of": "",
                "conditions": {},
                "channels": {name: (samples, spelt, measures, rate, begin)},
            }
        },
    )
    one = read_neutral(tmp_path / "a.h5")["r"].channels[name]
    np.testing.assert_allclose(with_gaps(one), size * samples, rtol=1e-6)  # single precision
    assert (float(one.rate), float(one.begin)) == (rate, begin)


@FEW
@given(
    NAMES.filter(lambda name: name.strip("_") == name and "__" not in name and name != "none"), SAMPLES, UNITS, RATES
)
def test_universal_files(tmp_path, name, samples, unit, rate):
    made = channel(samples, *unit[:2], rate, 0.0, name)
    write_uff(tmp_path / "a.uff", Run(description="", repeat_of="", channels={name: made}))
    (found,) = read_uff(tmp_path / "a.uff")[0].values()
    np.testing.assert_allclose(found.samples, unit[2] * samples, rtol=1e-14)
    assert float(found.rate) == rate and str(found.unit) == str(made.unit)


@FEW
@given(st.lists(st.lists(st.integers(-(2**23), 2**23 - 1), min_size=2, max_size=30), min_size=1, max_size=4), RATES)
def test_sound(tmp_path, columns, rate):
    size = min(map(len, columns))
    shares = [np.array(column[:size]) / 2**23 for column in columns]
    write_audio(tmp_path / "a.wav", {str(k): (values, rate) for k, values in enumerate(shares)}, 1.0)
    found = read_audio(tmp_path / "a.wav")
    assert [w.rate for w in found.values()] == [rate] * len(shares)
    for wave, values in zip(found.values(), shares, strict=True):
        np.testing.assert_allclose(wave.values, values, atol=2.0**-23)


@FEW
@given(NAMES, SAMPLES, RATES)
def test_tdms(tmp_path, name, samples, rate):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        for part in np.array_split(samples, 2):
            writer.write_segment(
                [ChannelObject("g", name, part, properties={"wf_increment": 1 / rate, "unit_string": "N"})]
            )
    wave = read_tdms(tmp_path / "a.tdms")[f"g/{name}"]
    np.testing.assert_array_equal(wave.values, samples)
    assert wave.rate == pytest.approx(rate) and wave.unit == "N"


@FEW
@given(NAMES.filter(lambda name: name != "time"), SAMPLES, st.integers(10, 100_000))
def test_mdf(tmp_path, name, samples, rate):
    import asammdf

    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(samples, np.arange(len(samples)) / rate, unit="N", name=name)])
        file.save(str(tmp_path / "a.mf4"), overwrite=True)
    wave = read_mdf(tmp_path / "a.mf4")[name]
    np.testing.assert_array_equal(wave.values, samples)
    assert wave.rate == pytest.approx(rate)


@FEW
@given(st.dictionaries(NAMES, SAMPLES, min_size=1, max_size=3), RATES)
def test_signals_of_sep005(columns, rate):
    given = [{"name": name, "data": values, "unit_str": "N", "fs": rate} for name, values in columns.items()]
    for signal in signals_of(run_of(given)):
        np.testing.assert_array_equal(signal["data"], columns[signal["name"]])


@FEW
@given(st.dictionaries(NAMES, SAMPLES, min_size=1, max_size=3), st.data())
def test_any_cut_of_a_file_is_refused_or_a_beginning(tmp_path, variables, data):
    """Of an HDF5 file all of it is there, or it is refused."""
    with h5py.File(tmp_path / "whole.mat", "w", userblock_size=512) as h5:
        for name, values in variables.items():
            h5[name] = values
    content = bytearray((tmp_path / "whole.mat").read_bytes())
    head = b"MATLAB 7.3 MAT-file, Platform: any"
    content[: len(head)] = head
    (tmp_path / "cut.mat").write_bytes(content[: data.draw(st.integers(0, len(content)))])
    try:
        found = read_matlab(tmp_path / "cut.mat")
    except ConfigError as error:
        assert error.where == tmp_path / "cut.mat"
        return
    for name, values in variables.items():
        np.testing.assert_array_equal(found[name], values)
