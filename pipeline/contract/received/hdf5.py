"""HDF5 files that take nothing from elsewhere: no other file, no library that is loaded for a filter."""

import h5py

from pipeline.contract.errors import ConfigError

#: filters that HDF5 and h5py hold themselves: deflate, shuffle, Fletcher 32, szip, n-bit, scale-offset, LZF
_FILTERS = frozenset({1, 2, 3, 4, 5, 6, 32000})


def flaw(group, name):
    """What the member ``name`` of a group takes from elsewhere, in words; '' where it takes nothing."""
    link = group.get(name, getlink=True)
    if isinstance(link, h5py.ExternalLink):
        return "data of another one"
    return flaw_of(group.get(name))


def flaw_of(node):
    """The same of a node itself."""
    if not isinstance(node, h5py.Dataset):
        return ""
    if node.is_virtual or node.external:
        return "data of another one"
    creation = node.id.get_create_plist()
    others = {creation.get_filter(k)[0] for k in range(creation.get_nfilters())} - _FILTERS
    return f"a filter by plugin (number {min(others)})" if others else ""


def refuse_outside(group, path):
    """Refuse an HDF5 file that takes anything from elsewhere, wherever in it.

    Raises ConfigError for an external link, storage outside of the file, a virtual dataset and a filter by plugin.
    """
    for name in group:
        told = flaw(group, name)
        if told:
            raise ConfigError(f"{path}: {group.name.rstrip('/')}/{name}", "data of this file", told,
                              "copy the data into the file, with gzip if compressed")
        if isinstance(group.get(name, getlink=True), h5py.HardLink):
            node = group.get(name)
            if isinstance(node, h5py.Group):
                refuse_outside(node, path)


def read_whole(path):
    """Read all attributes and data of a file once; raises whatever HDF5 does, and ConfigError as ``refuse_outside``."""
    with h5py.File(path, "r") as h5:
        _read_whole(h5, path, set())


def _read_whole(group, path, addresses):
    _read_attributes(group)
    for name in group:
        told = flaw(group, name)
        if told:
            raise ConfigError(f"{path}: {name}", "data of this file", told)
        node = group[name]
        address = h5py.h5o.get_info(node.id).addr
        if address in addresses:
            continue
        addresses.add(address)
        if isinstance(node, h5py.Group):
            _read_whole(node, path, addresses)
        elif isinstance(node, h5py.Dataset):
            _read_attributes(node)
            for scales in node.dims:
                scales.items()
            _ = node[()]


def _read_attributes(node):
    dict(node.attrs)
