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


def test_a_second_file_of_a_run_needs_an_offset_and_names_of_its_own(files):
    with pytest.raises(ConfigError, match="a.mat: runs.early: expected its offset from a.mat.*state offset: SECONDS"):
        read(files, MATLAB, MATLAB)
    with pytest.raises(ConfigError, match="runs.early: expected channels whose names the run does not have yet, found"):
        read(files, MATLAB, {**MATLAB, "offset": "0 s"})


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
    return recording(settings=settings, context=SimpleNamespace(log=lambda _: None, remark=told.append)), told


def test_channels_that_the_file_says_too_little_of_are_left_out_aloud(tmp_path):
    mdf(tmp_path / "drag.mf4")
    found, told = told_by(tmp_path, files=[{"kind": "mdf", "file": "drag.mf4"}])
    assert list(found.runs["drag"].channels) == ["pad", "line", "disc", "disc_speed"] and len(told) == 1
    assert "disc_speed: time stamps are 0.09 s apart" in told[0] and found.remarks.tolist() == told
    tdms(tmp_path / "b.tdms", unit_string="")
    sound(tmp_path / "a.wav")
    with pytest.raises(ConfigError, match="expected a unit in the file or in the case"):
        told_by(tmp_path, files=[{"kind": "tdms", "file": "b.tdms"}])


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


def test_columns_of_matrices_are_named_and_structures_state_their_rate(tmp_path):
    data = np.column_stack([np.arange(50) / 1e4, SINE[:50], 2 * SINE[:50]])
    savemat(tmp_path / "a.mat", {"data": data, "fs": 1e4})
    savemat(tmp_path / "b.mat", {"S": {"x_values": {"start_value": 0.5, "increment": 1e-4},
                                       "y_values": {"values": data[:, 1:]}}})
    pad = {"unit": "m/s^2", "measures": "acceleration"}
    matrix = {"kind": "matlab", "file": "a.mat", "time": "data(:,1)", "runs": {"a": {}},
              "columns": {"pad": {"column": "data(:,3)", **pad}}}
    testlab = {"kind": "matlab", "file": "b.mat", "runs": {"b": {}},
               "columns": {"pad": {"column": "S.y_values.values(:,2)", **pad}}}
    found, told = told_by(tmp_path, files=[matrix, testlab])
    for name, begin in (("a", 0.0), ("b", 0.5)):
        one = found.runs[name].channels["pad"]
        assert float(one.rate) == pytest.approx(1e4) and float(one.begin) == begin
        np.testing.assert_allclose(one.samples, 2 * SINE[:50])
    assert any("a sampling rate of 10000 Hz, as the file says" in line for line in told)
    with pytest.raises(ConfigError, match="data is a matrix: name one of its 3 columns, such as data"):
        read(tmp_path, {**matrix, "columns": {"pad": {"column": "data", **pad}}})
    with pytest.raises(ConfigError, match="found neither; add .* fs = 10000, which may mean sample_rate: 10000 Hz"):
        read(tmp_path, {**matrix, "time": None})


def test_what_was_taken_for_granted_of_a_table_is_told(tmp_path):
    time = np.round(np.arange(4000) / 51200, 6)
    rows = "".join(f"{t:.6f};{k};1\n".replace(".", ",") for k, t in enumerate(time))
    (tmp_path / "b.csv").write_text("t;pos;u\n" + rows)
    found, told = told_by(tmp_path, files=[{**TABLE, "sample_rate": None}])
    assert float(found.runs["t"].channels["x"].rate) == 51200 and len(found.runs["t"].channels["x"].samples) == 4000
    assert any("t states no unit: read in s" in line for line in told)
    assert any("times are rounded to 1e-06 s" in line for line in told)
    with pytest.raises(ConfigError, match="found 'posn'; read as utf-8, columns by ';', decimal ',', names in line 1"):
        read(tmp_path, {**TABLE, "columns": {"x": {**COLUMNS["x"], "column": "posn"}}})


@pytest.mark.parametrize("head", ["t,pos,u\n(ms),(mm),(N)\n", "t [ms],pos,u\n"])
def test_times_are_in_the_unit_that_the_file_says(tmp_path, head):
    (tmp_path / "b.csv").write_text(head + "".join(f"{k},{k},1\n" for k in range(5)))
    table = {**TABLE, "sample_rate": None, "time": head.split(",")[0]}
    assert float(read(tmp_path, table).runs["t"].channels["x"].rate) == pytest.approx(1000)


def bump(time):
    """A knock at 2.5 s of the clock of the sound."""
    return np.exp(-((time - 2.5) / 0.03) ** 2)


def stop(folder):
    """One stop by three recorders: sound that hears a knock, a text table and a TDMS file that began later."""
    from nptdms import ChannelObject, TdmsWriter

    sound(folder / "q.wav", 0.5 * bump(np.arange(8 * 4000) / 4000), rate=4000)
    late = np.arange(500) / 100 + 1.0
    np.savetxt(folder / "p.csv", np.column_stack([late - 1.0, late]), delimiter=",", header="t,p", comments="")
    with TdmsWriter(str(folder / "k.tdms")) as writer:
        time = 1.75 + np.arange(5000) / 1000
        writer.write_segment([ChannelObject("g", name, values, properties={"wf_increment": 1e-3, "unit_string": unit})
                              for name, values, unit in (("knock", 3 * bump(time), "V"), ("force", time, "N"))])
    return ({"kind": "audio", "file": "q.wav", "columns": {"mic": {"column": "1", "unit": "Pa", "factor": 2}},
             "runs": {"stop": {"begin": "1.5 s", "end": "4 s"}, "rest": {"begin": "4 s"}}},
            {"kind": "table", "file": "p.csv", "time": "t", "offset": "1 s", "offset_std": "5 ms", "columns": {
                "line": {"column": "p", "unit": "bar", "measures": "pressure"}},
             "runs": {"stop": {"begin": "1.5 s", "end": "4 s", "conditions": {"speed": {"value": 9, "unit": "m/s"}}}}},
            {"kind": "tdms", "file": "k.tdms", "common": {"channel": "g_knock", "other": "mic"}, "runs": {"stop": {}}})


def test_several_files_make_one_run(tmp_path):
    """Every sample lies at its instant on the clock of the first file, where the run is cut."""
    found, told = told_by(tmp_path, files=stop(tmp_path))
    run = found.runs["stop"]
    assert list(run.channels) == ["mic", "line", "g_knock", "g_force"] and list(found.runs) == ["stop", "rest"]
    line, force = run.channels["line"], run.channels["g_force"]
    assert float(line.begin) == pytest.approx(1.5) and line.samples[0] == pytest.approx(1.5e5)
    assert len(line.samples) == 250
    clock = run.clocks["k_tdms"]
    assert float(clock.offset) == pytest.approx(1.75, abs=3 * float(clock.offset_std)) and 0 < clock.offset_std < 1e-3
    assert float(force.begin) - force.samples[0] == pytest.approx(0.0, abs=1e-3)
    assert float(run.clocks["p_csv"].offset_std) == 0.005 and list(run.conditions) == ["speed"]
    assert found.remarks.tolist() == told and len(told) == 3 and "1 s +- 0.005 s are added to its times" in told[1]
    assert "t states no unit: read in s" in told[0]
    assert not found.runs["rest"].clocks


def test_files_without_a_common_clock_are_asked_for_an_offset(tmp_path):
    first, second, third = stop(tmp_path)
    for file in ({**second, "offset": None}, {**third, "common": None}):
        with pytest.raises(ConfigError, match="runs.stop: expected its offset from q.wav.*no time stamp in q.wav nor"):
            read(tmp_path, first, file)


def test_start_times_of_several_files_place_them(tmp_path):
    """An MDF file that began 2.5 s before a TDMS file, both of which tell when."""
    from datetime import UTC, datetime

    import asammdf

    time = np.arange(6000) / 1000
    with asammdf.MDF(version="4.10") as file:
        file.start_time = datetime(2026, 5, 4, 12, 0, 0, 250000, UTC)
        file.append([asammdf.Signal(time, time, unit="bar", name="line")])
        file.save(str(tmp_path / "a.mf4"))
    tdms(tmp_path / "b.tdms", wf_start_time=np.datetime64("2026-05-04T12:00:02.750"))
    found, told = told_by(tmp_path, files=[{"kind": "mdf", "file": "a.mf4", "runs": {"stop": {}}},
                                           {"kind": "tdms", "file": "b.tdms", "runs": {"stop": {}}}])
    run = found.runs["stop"]
    assert float(run.channels["bench_pad"].begin) == pytest.approx(2.5 + 0.5) and float(run.channels["line"].begin) == 0
    assert "by its time stamp and that of a.mf4" in told[-1] and 0 < float(run.clocks["b_tdms"].offset_std) < 1e-3


def test_files_of_whole_runs_join_by_an_offset(files):
    """A universal file and plain HDF5: series of conditions move with the channels."""
    from h5py import File

    sound(files / "q.wav", rate=1000)
    audio = {"kind": "audio", "file": "q.wav", "columns": {"mic": {"column": "1", "unit": "Pa"}},
             "runs": {"hammer": {}, "first": {}}}
    with File(files / "c.h5", "a") as h5:
        node = h5.create_dataset("runs/first/conditions/course", data=[1.0, 2.0])
        node.attrs.update(units="N", sample_rate=10.0)
    alone, moved = (read(files, *more, {**UFF, **shift}, {**NEUTRAL, **shift}).runs
                    for more, shift in (((), {}), ((audio,), {"offset": "2 s"})))
    for name in ("hammer", "first"):
        assert "mic" in moved[name].channels and len(moved[name].clocks) == 1
        for key, one in alone[name].channels.items():
            assert float(moved[name].channels[key].begin) == float(one.begin) + 2
    assert moved["first"].conditions["course"].time.tolist() == pytest.approx([2.0, 2.1])
    with pytest.raises(ConfigError, match="d.uff: runs.hammer: expected its offset from q.wav"):
        read(files, audio, UFF)


def tdms_of(path, labels):
    """A TDMS file by npTDMS whose channels have these {name: unit_string}."""
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(str(path)) as writer:
        writer.write_segment([ChannelObject("g", name, SINE, properties={"wf_increment": 1e-4, "unit_string": label})
                              for name, label in labels.items()])


def mdf_of(path, labels):
    """An MDF 4 file by asammdf whose channels have these {name: unit}."""
    from asammdf import MDF, Signal

    with MDF() as file:
        file.append([Signal(SINE, np.arange(len(SINE)) * 1e-4, name=name, unit=label)
                     for name, label in labels.items()])
        file.save(path, overwrite=True)


LABELS = {"acc": "G", "mic": "PA", "disc": "deg C", "line": "bar(g)", "gap": "mils", "speed": "RPM", "odd": "EU"}


@pytest.mark.parametrize("kind, name, write, group", [("tdms", "a.tdms", tdms_of, "g_"), ("mdf", "a.mf4", mdf_of, "")])
def test_labels_as_people_write_them_and_one_that_is_none(tmp_path, kind, name, write, group):
    """One bad label leaves the other channels; 'units' corrects it, by the name in the file or the plain one."""
    write(tmp_path / name, LABELS)
    file = {"kind": kind, "file": name}
    found, told = told_by(tmp_path, files=[file])
    channels = {key.removeprefix(group): one for key, one in found.runs["a"].channels.items()}
    assert {key: str(one.unit) for key, one in channels.items()} == {
        "acc": "m/s^2", "mic": "Pa", "disc": "K", "line": "Pa", "gap": "m", "speed": "rad/s"}
    assert np.ptp(channels["gap"].samples) == pytest.approx(25.4e-6 * np.ptp(SINE), rel=1e-6)
    assert any("odd left out: unit: expected a unit such as mm/s or kN, found 'EU'" in line
               and line.endswith(f"add units: {{{group}odd: ...}}") for line in told)
    assert any("unit 'G' is read as 9.80665 m/s^2" in line for line in told)
    for key in {f"{group}odd", "g/odd" if group else "odd"}:
        found, told = told_by(tmp_path, files=[{**file, "units": {key: "kN"}}])
        assert str(found.runs["a"].channels[f"{group}odd"].unit) == "N" and not any("left out" in t for t in told)
    with pytest.raises(ConfigError, match="units: expected channels among .*, found nought"):
        told_by(tmp_path, files=[{**file, "units": {"nought": "kN"}}])


def test_a_file_of_bad_labels_alone_is_refused_with_the_line(tmp_path):
    tdms_of(tmp_path / "a.tdms", {"odd": "EU"})
    with pytest.raises(ConfigError, match=r"found 'EU'; EU, engineering units, .*; add units: \{g_odd: \.\.\.\}"):
        told_by(tmp_path, files=[{"kind": "tdms", "file": "a.tdms"}])


def test_units_and_abscissae_of_a_universal_file_are_set_in_the_case(tmp_path):
    test_uff.write(tmp_path / "d.uff", x=np.arange(5.0), abscissa_axis_units_lab="bogus", ordinate_axis_units_lab="G")
    file = {**UFF, "time_unit": "ms"}
    found, told = told_by(tmp_path, files=[file])
    assert float(found.runs["hammer"].channels["acc_1"].rate) == pytest.approx(1000)
    assert any("acc_1: unit 'G' is read as 9.80665 m/s^2" in line for line in told)
    found, told = told_by(tmp_path, files=[{**file, "units": {"acc_1": "mm/s^2"}}])
    assert found.runs["hammer"].channels["acc_1"].samples[1] == pytest.approx(1e-3) and not told


def test_channels_that_are_held_at_the_end_of_their_range_are_told(tmp_path):
    """The same squeal twice in a file of 24 bits: overloaded, and at half the gain."""
    soundfile = pytest.importorskip("soundfile")
    tone = np.sin(2 * np.pi * 3100 * np.arange(48000) / 48e3) + 1e-3 * np.random.default_rng(0).standard_normal(48000)
    soundfile.write(tmp_path / "stop.flac", np.column_stack([np.clip(1.3 * tone, -1, 1), 0.65 * tone]), 48000, "PCM_24")
    columns = {name: {"column": str(k), "unit": "Pa", "factor": 20.0} for k, name in ((1, "near"), (2, "far"))}
    _, told = told_by(tmp_path, files=[{"kind": "audio", "file": "stop.flac", "columns": columns}])
    assert [line.split(":")[0] for line in told if "overloaded" in line] == ["stop, near"]
    assert any("44 % of the samples stand at the end of the range, 20 Pa" in line for line in told)


def table_of(folder, text, **more):
    """(the recording of a text table of a force, what was told) at 1 kHz."""
    (folder / "a.csv").write_text(text + "".join(f"{k},{k % 7 + 0.5}\n" for k in range(100)))
    return told_by(folder, files=[{"kind": "table", "file": "a.csv", "runs": {"a": {}}, "columns": {
        "load": {"column": text.splitlines()[-1].split(",")[1], "unit": "N", "measures": "force"}}, **more}])


@pytest.mark.parametrize("head, more, said", [
    ("t [ms],x [kN]\n", {"time": "t [ms]"}, "load: the file says 'kN', the case 'N', which is taken"),
    ("t [ms],x [mm]\n", {"time": "t [ms]"}, "load: the file says 'mm', the case 'N', which is taken"),
    ("t [ms],x [N]\n", {"time": "t [ms]"}, ""),
    ("Sample rate: 500 Hz\nt [ms],x\n", {"time": "t [ms]"}, "states 500 Hz, the times t [ms] 1000 Hz, which is taken"),
    ("Sample rate: 500 Hz\nt [ms],x\n", {"sample_rate": "1 kHz"}, "states 500 Hz, the case 1000 Hz, which is taken"),
    ("t,x\n", {"time": "t", "sample_rate": "1 kHz"}, ""),                        # the rate tells the unit of the times
    ("t,x\n", {"time": "t", "resample": "2 Hz"}, "t states no unit: read in s; else time_unit: ms")])
def test_what_a_table_and_its_case_contradict_is_told(tmp_path, head, more, said):
    found, told = table_of(tmp_path, head, **more)
    load = found.runs["a"].channels["load"]
    assert (len(told) == 1 and said in told[0]) if said else not told
    assert load.samples.max() == pytest.approx(6.5) and ("resample" in more or float(load.rate) == 1000)


@pytest.mark.parametrize("more, told", [
    ({"sample_rate": "2 kHz"}, "sample_rate: expected times at 2000 Hz, found times that are 2 intervals or more"),
    ({"resample": "10 kHz"}, "resample: expected times at 10000 Hz, found times that are 10 intervals or more")])
def test_a_rate_that_is_not_that_of_the_times_makes_no_gaps(tmp_path, more, told):
    with pytest.raises(ConfigError, match=f"{told}.*: 1000 Hz, or the unit of the times"):
        table_of(tmp_path, "t [ms],x\n", time="t [ms]", **more)
