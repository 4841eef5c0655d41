"""Stage recording: runs from every kind of file, and what it refuses."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.io import savemat

import stages
from pipeline.contract import ConfigError, case, mapped, store
from pipeline.contract.settings import fill
from stages.recording import Settings, recording
from tests.recordings import test_neutral, test_uff
from tests.recordings.files_of_others import RATE, SINE, mdf, sound, tdms

COLUMNS = {"x": {"column": "pos", "unit": "mm", "measures": "displacement", "place": "carriage"},
           "force": {"column": "u", "unit": "N", "measures": "force", "factor": -2, "role": "excitation"}}


@pytest.fixture
def files(tmp_path):
    savemat(tmp_path / "a.mat", {"t": 0.5 + np.arange(6) / 10, "pos": np.arange(6.0), "u": np.ones(6)})
    (tmp_path / "b.csv").write_text("t,pos,u\n" + "".join(f"{0.1 * k},{k},1\n" for k in (0, 1, 3)))
    test_neutral.write(tmp_path / "c.h5")
    test_uff.write(tmp_path / "d.uff")
    return tmp_path


def read(folder, *files):
    return recording(settings=fill(Settings, {"files": list(files)}, "case.yaml: recording", {"folders": (folder,)}))


MATLAB = {"kind": "matlab", "file": "a.mat", "time": "t", "columns": COLUMNS,
          "runs": {"early": {"end": "0.7 s", "conditions": {"pressure": {"value": 2, "unit": "MPa"}}},
                   "late": {"begin": "0.7 s", "repeat_of": "early"}}}
TABLE = {"kind": "table", "file": "b.csv", "time": "t", "sample_rate": "10 Hz", "columns": COLUMNS, "runs": {"t": {}}}
UFF = {"kind": "uff", "file": "d.uff", "run": "hammer"}
NEUTRAL = {"kind": "hdf5", "file": "c.h5"}


def test_runs_of_all_kinds_of_files(files):
    found = read(files, MATLAB, TABLE, UFF, NEUTRAL)
    assert list(found.runs) == ["early", "late", "t", "hammer", "first"] and len(found.source) == 4
    early = found.runs["early"]
    assert early.channels["x"].samples.tolist() == [0, 1e-3] and early.channels["force"].samples.tolist() == [-2, -2]
    assert early.conditions["pressure"].value.tolist() == [2e6] and str(early.channels["force"].role) == "excitation"
    assert len(found.runs["late"].channels["x"].samples) == 4 and str(found.runs["late"].repeat_of) == "early"
    assert found.runs["t"].channels["x"].missing.tolist() == [[2, 3]]
    assert found.source[0].startswith("a.mat ") and str(files) not in " ".join(found.source)


@pytest.mark.parametrize("file, message", [
    ({**MATLAB, "columns": {"x": {**COLUMNS["x"], "column": "posn"}}},
     "x.column: expected one of t, pos, u, found 'posn'"),
    ({**MATLAB, "time": "time"}, "time: expected one of t, pos, u, found 'time'"),
    ({**MATLAB, "time": None}, "expected a sampling rate or a column of times, found neither"),
    ({**TABLE, "sample_rate": None}, "expected times at one even interval"),
    ({**MATLAB, "runs": {"a": {"repeat_of": "b"}}}, "recording: a.repeat_of: expected another of a, found 'b'"),
    ({**MATLAB, "runs": {"a": {"begin": "9 s"}}}, "runs.a: expected a stretch within 0.5 s to 1 s"),
    ({**MATLAB, "file": "none.mat"}, "expected a file, found none"),
    ({**TABLE, "sample_rate": 10}, r"files.0.sample_rate: .*without a unit"),
    ({k: v for k, v in TABLE.items() if k != "kind"}, r"files.0: unable to extract tag using discriminator 'kind'"),
    ({**TABLE, "delimiter": "::"}, "a text table whose columns '::' separates"),
    ({**TABLE, "columns": {"x": {**COLUMNS["x"], "role": "foo"}}}, "role: input should be 'response' or 'excitation'"),
])
def test_refuses(files, file, message):
    with pytest.raises(ConfigError, match=message):
        read(files, file)


def test_a_mistake_is_told_in_one_line(files):
    with pytest.raises(ConfigError) as error:
        read(files, {**TABLE, "sample_rate": 10, "run": "a"})
    told = str(error.value)
    assert len(told.splitlines()) == 2 and "files.0.run: unknown key; did you mean 'runs'?" in told


def test_conditions_reach_the_runs_from_yaml(files):
    """A condition has a value and a unit, and is no value with its origin."""
    (files / "case.yaml").write_text("""
chain: recording
recording:
  files:
  - {kind: matlab, file: a.mat, time: t, columns: {x: {column: pos, unit: mm, measures: displacement}},
     runs: {all: {conditions: {load: {value: 5, unit: kN}}}}}
""")
    found = case.load(files / "case.yaml", {"recording": ("recording",)}, stages.load)
    run = recording(settings=found.sections["recording"]).runs["all"]
    assert run.conditions["load"].value.tolist() == [5000.0] and str(run.conditions["load"].unit) == "N"


def test_a_run_name_is_taken_once(files):
    with pytest.raises(ConfigError, match="expected run names that are not taken, found early, late"):
        read(files, MATLAB, MATLAB)


def test_sound_and_measurement_files_need_no_columns(tmp_path):
    """Channels, units, rates and begins as the files have them; a run named as the file."""
    tdms(tmp_path / "stop 3.tdms")
    mdf(tmp_path / "drag.mf4")
    found = read(tmp_path, {"kind": "tdms", "file": "stop 3.tdms"},
                 {"kind": "mdf", "file": "drag.mf4", "sample_rate": "10 Hz"})
    assert list(found.runs) == ["stop_3", "drag"]
    pad = found.runs["stop_3"].channels["bench_pad"]
    assert str(pad.unit) == "m/s^2" and str(pad.measures) == "acceleration" and float(pad.begin) == 0.5
    np.testing.assert_allclose(pad.samples, 9.80665 * SINE)
    drag = found.runs["drag"].channels
    assert {name: (str(c.measures), str(c.unit), float(c.rate)) for name, c in drag.items()} == {
        "pad": ("acceleration", "m/s^2", pytest.approx(RATE)), "line": ("pressure", "Pa", pytest.approx(RATE)),
        "disc": ("temperature", "K", pytest.approx(10)), "disc_speed": ("angular_velocity", "rad/s", 10)}
    assert drag["line"].samples[-1] == 999e5


@pytest.mark.exact
def test_a_microphone_has_a_calibrator_or_a_factor(tmp_path):
    """A tone of 94 dB is 1 Pa effective (ISO 1683), whatever the gain."""
    tone = 0.2 * np.sin(2 * np.pi * np.arange(48000) / 48)
    sound(tmp_path / "cal.wav", np.concatenate([np.zeros(24000), tone, np.zeros(24000)]))      # silence does not count
    sound(tmp_path / "stop.wav", 0.05 * SINE, 0.1 * SINE)
    found = read(tmp_path, {"kind": "audio", "file": "stop.wav", "columns": {
        "left": {"column": "1", "calibrator": {"file": "cal.wav"}},
        "right": {"column": "2", "unit": "Pa", "factor": 10, "measures": "sound_pressure"}},
        "runs": {"early": {"end": "10 ms"}, "late": {"begin": "10 ms"}}})
    left, right = found.runs["early"].channels.values()
    assert str(left.measures) == str(right.measures) == "sound_pressure" and len(left.samples) == 480
    effective = 20e-6 * 10 ** (94 / 20)
    np.testing.assert_allclose(left.samples, 0.05 * SINE[:480] * effective / (0.2 / np.sqrt(2)), atol=1e-5)
    np.testing.assert_allclose(right.samples, SINE[:480], atol=1e-5)
    assert len(found.runs["late"].channels["left"].samples) == 520


def test_long_channels_are_those_of_memory(tmp_path, monkeypatch):
    """Samples, gaps, runs and hash do not depend on files and blocks: both ways give the same product."""
    pressure = 0.1 * np.random.default_rng(3).standard_normal(300_000).astype(np.float32)
    pressure[[0, 1023, 1024, 1025, 70_000]] = np.nan
    sound(tmp_path / "long.wav", pressure, 0.5 * pressure, subtype="FLOAT")
    file = {"kind": "audio", "file": "long.wav", "columns": {
        "mic": {"column": "1", "unit": "Pa", "factor": 20, "measures": "sound_pressure"},
        "pad": {"column": "2", "unit": "g", "factor": 50}},
        "runs": {"all": {}, "late": {"begin": "0.021 s", "end": "5 s"}}}
    monkeypatch.setattr(mapped, "LARGE", 1 << 40)
    inside = read(tmp_path, file)
    monkeypatch.setattr(mapped, "LARGE", 1 << 10)
    monkeypatch.setattr(mapped, "_BLOCK", 1 << 12)      # 1024 samples of the file
    outside = read(tmp_path, file)
    mic, late = outside.runs["all"].channels["mic"], outside.runs["late"].channels["pad"]
    assert mapped.map_of(mic.samples) is not None and mapped.map_of(inside.runs["all"].channels["mic"].samples) is None
    assert store.content_hash(inside) == store.content_hash(outside)
    assert mic.samples.dtype == np.float32 and mic.missing.tolist() == [[0, 1], [1023, 1026], [70_000, 70_001]]
    np.testing.assert_array_equal(mic.samples, (20.0 * np.nan_to_num(pressure).astype(float)).astype(np.float32))
    assert late.missing.tolist() == [[15, 18], [68_992, 68_993]] and len(late.samples) == 240_000 - 1008


@pytest.mark.parametrize("file, told", [
    ({"kind": "audio", "file": "a.wav"}, "a channel that can be used, found none of 1, 2"),
    ({"kind": "audio", "file": "a.wav", "columns": {"m": {"column": "3", "unit": "Pa"}}}, "one of 1, 2, found '3'"),
    ({"kind": "tdms", "file": "b.tdms", "columns": {"p": {"column": "bench/pad", "measures": "force"}}},
     "a unit of force, such as N, found 'g'"),
    ({"kind": "tdms", "file": "c.tdms"}, "sample_rate: expected a rate above 0 Hz, found nan"),
    ({"kind": "mdf", "file": "b.tdms"}, "an undamaged MDF file")])
def test_what_files_of_channels_lack_is_asked_for(tmp_path, file, told):
    sound(tmp_path / "a.wav")
    tdms(tmp_path / "b.tdms")
    tdms(tmp_path / "c.tdms", wf_increment=0.0)
    with pytest.raises(ConfigError, match=told):
        read(tmp_path, file)


def told_by(tmp_path, **case):
    """(Recording, what was logged) of a case."""
    told = []
    settings = fill(Settings, case, "case", {"folders": (tmp_path,)})
    return recording(settings=settings, context=SimpleNamespace(log=told.append)), told


def test_channels_that_the_file_says_too_little_of_are_left_out_aloud(tmp_path):
    mdf(tmp_path / "drag.mf4")
    found, told = told_by(tmp_path, files=[{"kind": "mdf", "file": "drag.mf4"}])
    assert list(found.runs["drag"].channels) == ["pad", "line", "disc"]
    assert any("disc speed left out: the file states no even sampling" in line for line in told)


def test_good_channels_stay_usable(tmp_path):
    sound(tmp_path / "a.wav")
    columns = {"good": {"column": "1", "unit": "Pa"}, "bad": {"column": "2", "unit": "Pa", "measures": "force"}}
    file = {"kind": "audio", "file": "a.wav", "columns": columns}
    found, told = told_by(tmp_path, files=[file], keep_going=True)
    assert list(found.runs["a"].channels) == ["good"] and any("left out" in line and "bad" in line for line in told)
    with pytest.raises(ConfigError, match="a unit of force"):
        told_by(tmp_path, files=[file])


def test_names_of_a_file_are_made_plain_and_none_is_lost(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(tmp_path / "Geräusch.tdms")) as writer:
        writer.write_segment([ChannelObject("Gerät", name, SINE, properties={"wf_increment": 1e-4, "unit_string": "Pa"})
                              for name in ("Mic-1", "Mic 1")])
    found = read(tmp_path, {"kind": "tdms", "file": "Geräusch.tdms"})
    assert list(found.runs) == ["Geraeusch"]
    assert list(found.runs["Geraeusch"].channels) == ["Geraet_Mic_1", "Geraet_Mic_1_2"]


@pytest.mark.parametrize("more, told", [({"factor": -10}, "no unit and no factor beside it"),
                                        ({"unit": "Pa"}, "no unit and no factor beside it"), ({}, "the steady tone")])
def test_a_calibrator_rules_alone_and_must_hold_a_tone(tmp_path, more, told):
    sound(tmp_path / "cal.wav", 0.1 * np.random.default_rng(1).standard_normal(48000))
    sound(tmp_path / "a.wav")
    with pytest.raises(ConfigError, match=told):
        read(tmp_path, {"kind": "audio", "file": "a.wav", "columns": {
            "m": {"column": "1", "calibrator": {"file": "cal.wav"}, **more}}})


def test_uneven_times_in_ms_are_put_on_a_grid_and_gaps_stay_gaps(tmp_path):
    time = np.array([0, 9, 21, 30, 41, 50, 120, 130])
    (tmp_path / "b.csv").write_text("t,pos,u\n" + "".join(f"{t},{2 * t},1\n" for t in time))
    table = {**TABLE, "sample_rate": None, "time_unit": "ms", "resample": "100 Hz"}
    found = read(tmp_path, table).runs["t"].channels["x"]
    assert float(found.rate) == 100 and len(found.samples) == 14 and found.missing.tolist() == [[6, 12]]
    assert found.samples[:6] == pytest.approx(2e-3 * np.arange(0, 60, 10)) and found.samples[13] == pytest.approx(0.26)


def test_times_that_begin_anew_make_runs_of_rows(tmp_path):
    (tmp_path / "b.csv").write_text("t,pos,u\n" + "".join(f"{k % 4 / 10},{k},1\n" for k in range(8)))
    runs = {"one": {"rows": [0, 4]}, "two": {"rows": [4, 8], "begin": "0.1 s"}}
    found = read(tmp_path, {**TABLE, "sample_rate": None, "runs": runs}).runs
    assert [found[name].channels["x"].samples.tolist() for name in found] == [
        pytest.approx([0, 1e-3, 2e-3, 3e-3]), pytest.approx([5e-3, 6e-3, 7e-3])]
    with pytest.raises(ConfigError, match=r"state the rows of each run"):
        read(tmp_path, {**TABLE, "sample_rate": None, "resample": "10 Hz"})


def test_a_file_of_sound_has_no_rows(tmp_path):
    sound(tmp_path / "a.wav")
    with pytest.raises(ConfigError, match="runs.a.rows: expected begin and end"):
        read(tmp_path, {"kind": "audio", "file": "a.wav", "runs": {"a": {"rows": [0, 9]}},
                        "columns": {"mic": {"column": "1", "unit": "Pa", "factor": 1}}})


@pytest.mark.parametrize("head", ["t,pos,u\n(ms),(mm),(N)\n", "t [ms],pos,u\n"])
def test_times_are_in_the_unit_that_the_file_says(tmp_path, head):
    (tmp_path / "b.csv").write_text(head + "".join(f"{k},{k},1\n" for k in range(5)))
    table = {**TABLE, "sample_rate": None, "time": head.split(",")[0]}
    assert float(read(tmp_path, table).runs["t"].channels["x"].rate) == pytest.approx(1000)


def test_channels_that_are_held_at_the_end_of_their_range_are_told(tmp_path):
    """The same squeal twice in a file of 24 bits: overloaded, and at half the gain."""
    soundfile = pytest.importorskip("soundfile")
    tone = np.sin(2 * np.pi * 3100 * np.arange(48000) / 48e3) + 1e-3 * np.random.default_rng(0).standard_normal(48000)
    soundfile.write(tmp_path / "stop.flac", np.column_stack([np.clip(1.3 * tone, -1, 1), 0.65 * tone]), 48000, "PCM_24")
    columns = {name: {"column": str(k), "unit": "Pa", "factor": 20.0} for k, name in ((1, "near"), (2, "far"))}
    _, told = told_by(tmp_path, files=[{"kind": "audio", "file": "stop.flac", "columns": columns}])
    assert [line.split(":")[0] for line in told if "overloaded" in line] == ["stop, near"]
    assert any("44 % of the samples stand at the end of the range, 20 Pa" in line for line in told)
