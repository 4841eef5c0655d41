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
