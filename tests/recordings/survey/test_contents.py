"""What a file holds: times that are even, uneven, lost, rounded or begin anew; files that no reader reads."""

import numpy as np
import pytest
from scipy.io import savemat

from pipeline.contract import ConfigError
from pipeline.recordings.survey.contents import contents


def table(folder, head, *columns, name="record.csv"):
    file = folder / name
    np.savetxt(file, np.array(columns).T, delimiter=",", header=head, comments="", fmt="%.9g")
    return file


def test_even_times_need_no_more(tmp_path):
    found = contents(table(tmp_path, "t,x [mm]", np.arange(100) / 50, np.sin(np.arange(100))))
    assert found.settings == {"time": "t"} and found.runs == {"record": {}}
    assert found.signals["x"].rate == pytest.approx(50) and found.signals["x"].meaning.unit == "mm"


def test_times_with_jitter_are_put_on_a_grid(tmp_path):
    time = np.cumsum(np.random.default_rng(0).uniform(0.8e-3, 1.2e-3, 2000))
    found = contents(table(tmp_path, "time,x", time, np.sin(time)))
    assert found.settings == {"time": "time", "resample": "1000 Hz"} and "uneven" in found.remarks[0]


def test_times_that_begin_anew_make_runs_of_rows(tmp_path):
    time = np.concatenate([np.arange(40) / 15, np.arange(30) / 15])
    drop = np.repeat([1, 2], [40, 30])
    found = contents(table(tmp_path, "Drop #,Time (ms),Height (m)", drop, 1e3 * time, time**2))
    assert found.runs == {"record_1": {"rows": [0, 40]}, "record_2": {"rows": [40, 70]}}
    assert found.settings == {"time": "Time (ms)", "time_unit": "ms"} and list(found.signals) == ["Height"]


def test_lost_samples_are_gaps_of_a_grid(tmp_path):
    kept = np.delete(np.arange(500), [40, 41, *range(100, 130)])
    found = contents(table(tmp_path, "t,x", kept / 200, np.sin(kept)))
    assert found.settings == {"time": "t", "resample": "200 Hz"} and found.remarks[0].startswith("samples are missing")
    assert found.runs == {"record_1": {"rows": [0, 98]}, "record_2": {"rows": [98, 468]}}
    few = contents(table(tmp_path, "t,x", np.delete(kept, slice(0, 60)) / 200, np.zeros(408)))
    assert few.runs == {"record": {"rows": [38, 408]}} and few.cut, "one piece stands for all"


def test_rounded_times_tell_a_rate(tmp_path):
    time = np.round(np.arange(5000) / 25600, 4)
    found = contents(table(tmp_path, "t,x", time, np.sin(time)))
    assert float(
        found.settings["sample_rate"].split()[0]) == pytest.approx(25600, rel=1e-3)


def test_matrices_and_tables_without_names_begin_with_their_times(tmp_path):
    values = np.column_stack([np.arange(100) / 50, np.sin(np.arange(100.0))])
    savemat(tmp_path / "a.mat", {"data": values})
    np.savetxt(tmp_path / "b.txt", values)
    for name, column in (("a.mat", "data(:,{})"), ("b.txt", "column {}")):
        found = contents(tmp_path / name)
        assert found.settings == {"time": column.format(1)} and [s.column for s in found.signals.values()] == [
            column.format(2)]
        assert any("states no unit: read in s" in remark for remark in found.remarks)


def test_a_scope_states_its_units_and_a_head_its_rate(tmp_path):
    rows = "".join(f"{k / 10:.1f},{np.sin(k):.5f}\n" for k in range(60))
    (tmp_path / "a.csv").write_text("Time,Channel A\n(ms),(V)\n\n" + rows)
    found = contents(tmp_path / "a.csv")
    assert found.settings == {"time": "Time", "time_unit": "ms"} and found.signals["Channel_A"].meaning.unit == "V"
    (tmp_path / "b.csv").write_text("Sample rate: 10 kHz\n\nx,y,state\n" + rows.replace("\n", ",OK\n"))
    found = contents(tmp_path / "b.csv")
    assert found.settings == {"sample_rate": "10000 Hz"} and "state is left out: it holds texts" in found.remarks


def test_workbooks_are_refused_with_a_remedy(tmp_path):
    (tmp_path / "balls.xls").write_bytes(b"PK")
    with pytest.raises(ConfigError, match="save each sheet as CSV"):
        contents(tmp_path / "balls.xls")
