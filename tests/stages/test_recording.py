"""Stage recording: runs from every kind of file, and what it refuses."""

import numpy as np
import pytest
from scipy.io import savemat

import stages
from pipeline.contract import ConfigError, case
from pipeline.contract.settings import fill
from stages.recording import Settings, recording
from tests.recordings import test_neutral, test_uff

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
