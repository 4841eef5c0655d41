"""HDF5 files that take their data from elsewhere are refused: by name of what they do."""

import h5py
import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.received import hdf5
from pipeline.recordings.columns import read_matlab
from pipeline.recordings.neutral import read_neutral, write_neutral


def as_measured(node):
    """Attributes that make a dataset a channel: nothing but where its data lie is wrong with it."""
    node.attrs.update(units="m", quantity="displacement", sample_rate=100.0)


def external_link(h5, secret):
    with h5py.File(secret, "a") as other:
        as_measured(other["x"])
    h5["runs/a/channels/y"] = h5py.ExternalLink(str(secret), "/x")


def external_storage(h5, secret):
    as_measured(h5["runs/a/channels"].create_dataset("y", (2,), "f8", external=[(str(secret), 0, 16)]))


def virtual(h5, secret):
    layout = h5py.VirtualLayout((3,), "f8")
    layout[:] = h5py.VirtualSource(str(secret), "x", (3,))
    as_measured(h5["runs/a/channels"].create_virtual_dataset("y", layout))


def plugin(h5, _):
    creation = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    creation.set_chunk((3,))
    creation.set_filter(32015, h5py.h5z.FLAG_OPTIONAL, ())        # zstd
    h5py.h5d.create(h5["runs/a/channels"].id, b"y", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple((3,)), creation)
    as_measured(h5["runs/a/channels/y"])


@pytest.mark.parametrize("spoil, told", [
    (external_link, "data of another one"), (external_storage, "data of another one"),
    (virtual, "data of another one"), (plugin, "a filter by plugin .number 32015")])
def test_data_from_elsewhere(tmp_path, spoil, told):
    secret, path = tmp_path / "secret.h5", tmp_path / "r.h5"
    with h5py.File(secret, "w") as h5:
        h5["x"] = [1.0, 2.0, 3.0]
    write_neutral(path, {"a": {"description": "", "repeat_of": "", "conditions": {}, "channels": {
        "x": (np.arange(4.0), "m", "displacement", 100.0)}}})
    assert list(read_neutral(path)) == ["a"]
    with h5py.File(path, "a") as h5:
        spoil(h5, secret)
    with pytest.raises(ConfigError, match=f"runs/a/channels/y: expected data of this file, found {told}"):
        read_neutral(path)
    with h5py.File(path) as h5, pytest.raises(ConfigError, match=told):
        hdf5.refuse_outside(h5, path)


def test_a_cell_of_matlab_that_no_name_leads_to(tmp_path):
    """A group that holds itself stays in the file without a name: a reference alone leads to what is in it."""
    path = tmp_path / "v73.mat"
    (tmp_path / "secret").write_bytes(np.arange(4.0).tobytes())
    with h5py.File(path, "w", userblock_size=512) as h5:
        group = h5.create_group("group")
        group["itself"] = group
        hidden = group.create_dataset("hidden", (4,), "f8", external=[(str(tmp_path / "secret"), 0, 32)])
        h5.create_dataset("cells", (1, 1), h5py.ref_dtype)[0, 0] = hidden.ref
        del h5["group"]
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512) + path.read_bytes()[512:])
    with pytest.raises(ConfigError, match="expected data of this file, found data of another one"):
        read_matlab(path)
