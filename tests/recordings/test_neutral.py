"""Plain HDF5 recordings, written without any of our code."""

import h5py
import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.neutral import read_neutral, write_neutral


def write(path, change=lambda run: None):
    with h5py.File(path, "w") as h5:
        run = h5.create_group("runs/first")
        run.attrs["description"] = "hammer at 2 bar"
        force = run.create_dataset("channels/force", data=[0.0, 2.0, np.nan])
        force.attrs.update(units="kN", quantity="force", sample_rate=100.0, role="excitation", point_name="pad")
        run.create_dataset("conditions/pressure", data=2.0).attrs["units"] = "bar"
        run.create_dataset("conditions/speed", data=[1.0, 2.0]).attrs.update(units="rpm", sample_rate=10.0)
        frf = run.create_group("frf/drive_point")
        frf.attrs.update(units="m/s^2/N", response="pad z", reference="pad z")
        frf["frequency"], frf["response"] = [10.0, 20.0], [1.0 + 1j, 2.0]
        run["modes/hammer/frequency"] = [100.0, 200.0]
        run["lines/squeal/frequency"], run["lines/squeal/level"] = [2215.0, 4430.0], [0.0, np.nan]
        heights = run.create_dataset("topography/pad", data=[[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]])
        heights.attrs.update(units="um", pixel_size=1e-6, state="worn")
        for name, value in {"friction": [0.4], "pressure": 1e6, "speed": 1.0}.items():
            run[f"friction/bench/{name}"] = value
        change(run)
    return path


def test_everything_comes_back_in_si(tmp_path):
    run = read_neutral(write(tmp_path / "a.h5"))["first"]
    force = run.channels["force"]
    assert force.samples.tolist() == [0, 2000, 0] and str(force.unit) == "N" and force.missing.tolist() == [[2, 3]]
    assert str(force.place) == "pad" and str(force.role) == "excitation" and float(force.rate) == 100
    assert run.conditions["pressure"].value.tolist() == [2e5] and str(run.conditions["speed"].unit) == "rad/s"
    assert run.conditions["speed"].time.tolist() == [0, 0.1]
    assert run.frf["drive_point"].response.tolist() == [1 + 1j, 2] and str(run.frf["drive_point"].unit) == "m/s^2/N"
    assert run.modes["hammer"].frequency.tolist() == [100, 200] and run.modes["hammer"].shape.shape == (2, 0)
    assert run.lines["squeal"].level_known.tolist() == [1, 0]
    assert run.topography["pad"].height[2, 1] == pytest.approx(5e-6) and run.topography["pad"].y[2] == 2e-6
    assert run.friction["bench"].friction.tolist() == [0.4] and run.friction["bench"].temperature.tolist() == [293.15]


@pytest.mark.parametrize("change, message", [
    (lambda run: run["channels/force"].attrs.pop("units"), "channels/force: expected the attribute units"),
    (lambda run: run["channels/force"].attrs.pop("sample_rate"), "expected the attribute sample_rate"),
    (lambda run: run["channels/force"].attrs.update(units="kNN"), "channels/force: unit: expected a unit such as"),
    (lambda run: run.create_group("chanels"), "runs/first: expected groups among conditions, channels.*found chanels"),
    (lambda run: run["frf/drive_point"].pop("frequency"), "frf/drive_point: expected the dataset frequency"),
    (lambda run: run["topography/pad"].attrs.update(units="N"), "expected heights .* in a unit of length"),
    (lambda run: run["channels/force"].attrs.update(sample_rate="10 Hz"), "channels/force: expected data and .*Value"),
    (lambda run: run["channels/force"].attrs.update(sample_rate=0.0), "force: sample_rate: expected a rate above"),
    (lambda run: run["channels/force"].attrs.update(role="foo"), "role: expected one of response, excitation"),
    (lambda run: run["topography/pad"].attrs.update(pixel_size=[1.0, 2.0, 3.0]), "topography/pad: expected data and"),
    (lambda run: run.create_dataset("frf/other", data=1.0), "frf/other: expected data and attributes"),
    (lambda run: run.pop("frf") and run.create_dataset("frf", data=1.0), "expected groups among .*found frf"),
    (lambda run: run.create_dataset("channels/odd", data=[1j]).attrs.update(units="m", quantity="x", sample_rate=1.0),
     "channels/odd: expected real samples"),
])
def test_mistakes_are_told_with_their_place(tmp_path, change, message):
    with pytest.raises(ConfigError, match=message):
        read_neutral(write(tmp_path / "a.h5", change))


def test_files_without_runs_are_refused(tmp_path):
    with h5py.File(tmp_path / "b.h5", "w") as h5:
        h5["x"] = 1.0
    with pytest.raises(ConfigError, match="expected a group /runs"):
        read_neutral(tmp_path / "b.h5")
    (tmp_path / "c.h5").write_text("no")
    with pytest.raises(ConfigError, match="expected a whole HDF5 file"):
        read_neutral(tmp_path / "c.h5")


def test_what_is_written_is_read_in_si(tmp_path):
    tap = {"description": "a tap", "repeat_of": "", "conditions": {"load": (1.5, "kN")},
           "channels": {"laser": ([1.0, 2.0, 4.0], "mm/s", "velocity", 100.0)}}
    write_neutral(tmp_path / "taps.h5", {"one": tap, "again": {**tap, "repeat_of": "one"}})
    runs = read_neutral(tmp_path / "taps.h5")
    laser = runs["one"].channels["laser"]
    np.testing.assert_allclose(laser.samples, [1e-3, 2e-3, 4e-3])
    assert (str(laser.unit), str(laser.measures), float(laser.rate)) == ("m/s", "velocity", 100.0)
    assert runs["one"].conditions["load"].value[0] == 1500.0 and str(runs["again"].repeat_of) == "one"


def test_friction_and_faces_survive_writing(tmp_path):
    heights = np.arange(6.0).reshape(2, 3) * 1e-6
    write_neutral(tmp_path / "c.h5", {"drag": {
        "description": "", "repeat_of": "", "conditions": {}, "channels": {},
        "topography": {"worn": (heights, 2e-6, "pad", "worn")},
        "friction": {"cell": {"friction": [0.4, 0.5], "friction_std": [0.01, 0.01], "pressure": 1e6,
                              "speed": [1.0, 2.0], "distance": [0.0, 1e-3]}}}})
    run = read_neutral(tmp_path / "c.h5")["drag"]
    np.testing.assert_array_equal(run.topography["worn"].height, heights)
    assert str(run.topography["worn"].body) == "pad" and run.topography["worn"].x.tolist() == [0, 2e-6, 4e-6]
    assert run.friction["cell"].pressure.tolist() == [1e6, 1e6] and run.friction["cell"].distance[1] == 1e-3


def test_what_a_unit_is_taken_for_is_told(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as h5:
        for name, unit, quantity in (("pad", "G", "acceleration"), ("load", "kg", "force"),
                                     ("line", "bar", "pressure")):
            node = h5.create_dataset(f"runs/stop/channels/{name}", data=[1.0, 2.0])
            node.attrs.update(units=unit, quantity=quantity, sample_rate=10.0)
    told = []
    read_neutral(tmp_path / "a.h5", told.append)
    assert told == ["stop, load: unit 'kg' is read as 9.80665 N", "stop, pad: unit 'G' is read as 9.80665 m/s^2"]
