"""Universal files: time signals and frequency responses (data set 58), modes (data set 55). The door of pyuff."""

import re
import warnings
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.products import FrequencyResponse, MeasuredModes
from pipeline.recordings.samples import channel, even_rate

#: function types of data set 58
TIME, RESPONSE = 1, 4
#: ordinate codes of data set 58
QUANTITY = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force", 15: "pressure",
            21: "pressure", 5: "temperature"}
#: units as measurement systems write them, and as pint reads them
SPELT = {"m/s2": "m/s^2", "g": "g_0", "NONE": "", "-": ""}
#: the line that begins a data set, and the one that ends it
_DELIMITER = re.compile(rb"^ {4}-1\s*$", re.MULTILINE)


def read_uff(path, units=None):
    """(channels, frf, modes), each a dict by name, of the universal file at ``path``.

    ``units``: response name -> unit, for files without units. Data sets of other kinds are ignored. Raises
    ConfigError for a file that is not a universal file, is truncated or holds no data set of these kinds, and for
    ``units`` of responses that it does not contain.
    """
    import pyuff

    if Path(path).is_file() and len(_DELIMITER.findall(Path(path).read_bytes())) % 2:
        raise ConfigError(path, "a whole universal file", "one whose last data set does not end", "copy it again")
    units, channels, frf, modes = units or {}, {}, {}, {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            file = pyuff.UFF(str(path))
            sets = [file.read_sets(k) for k, kind in enumerate(file.get_set_types()) if kind in (55, 58)]
    except Exception as error:  # pyuff passes on whatever its parser stumbles over
        raise ConfigError(path, "a universal file", str(error) or type(error).__name__) from None
    for number, data_set in enumerate(sets, 1):
        where = f"{path}: data set {number}"
        if data_set["type"] == 58 and data_set["func_type"] == TIME:
            _put(channels, _name(data_set), _signal(data_set, units, where))
        elif data_set["type"] == 58 and data_set["func_type"] == RESPONSE:
            _put(frf, _name(data_set), _response(data_set, units, where))
        elif data_set["type"] == 55 and "freq" in data_set:
            _put(modes, f"mode_{len(modes) + 1}", _mode(data_set))
    strange = sorted(set(units) - {_name(data_set) for data_set in sets if data_set["type"] == 58})
    if strange:
        raise ConfigError(f"{path}: units", f"responses among {', '.join((*channels, *frf)) or 'none'}",
                          ", ".join(strange))
    if not channels and not frf and not modes:
        raise ConfigError(path, "time signals, frequency responses or modes", f"{len(sets)} data sets of other kinds")
    return channels, frf, modes


def _put(table, name, item):
    """Under ``name``, or the first free name_2, name_3, ..."""
    free = (name if k == 1 else f"{name}_{k}" for k in range(1, len(table) + 2))
    table[next(n for n in free if n not in table)] = item


def _name(data_set):
    """'mic_01' of a response entity 'Mic 01'; node and direction where the file names none."""
    named = data_set.get("rsp_ent_name", "NONE").strip()
    spelt = "".join(c if c.isalnum() else "_" for c in named.lower().replace("+", "p").replace("-", "m")).strip("_")
    return spelt if spelt and spelt != "none" else f"node_{data_set['rsp_node']}_{data_set['rsp_dir']}"


def _unit(data_set, units, where):
    name = _name(data_set)
    written = data_set.get("ordinate_axis_units_lab", "NONE").strip()
    unit = SPELT.get(written, written) or units.get(name, "")
    if not unit:
        raise ConfigError(f"{where} ({name})", "a unit in the file or in 'units'", "none",
                          f"add units: {{{name}: ...}}")
    return unit


def _direction(code):
    """Unit vector of a direction code: 1, 2, 3 = x, y, z, negative against it; empty for rotations and scalars."""
    if abs(code) not in (1, 2, 3):
        return ()
    return tuple(np.sign(code) * np.eye(3)[abs(code) - 1])


def _signal(data_set, units, where):
    rate, begin = even_rate(np.asarray(data_set["x"], float), where)
    measures = QUANTITY.get(data_set["ordinate_spec_data_type"], data_set["ordinate_axis_lab"].strip().lower())
    role = "excitation" if measures == "force" else "response"
    return channel(data_set["data"], _unit(data_set, units, where), measures, rate, begin, where, role=role,
                   place=f"node {data_set['rsp_node']}" if data_set["rsp_node"] else "",
                   direction=_direction(data_set["rsp_dir"]))


def _response(data_set, units, where):
    upper, lower = _unit(data_set, units, where), data_set.get("orddenom_axis_units_lab", "NONE").strip()
    below = SPELT.get(lower, lower)
    values, unit = in_si(np.asarray(data_set["data"], complex), f"({upper}) / ({below})" if below else upper, where)
    return FrequencyResponse(frequency=data_set["x"], response=values, unit=unit,
                             place=f"node {data_set['rsp_node']} direction {data_set['rsp_dir']}",
                             reference=f"node {data_set['ref_node']} direction {data_set['ref_dir']}")


def _mode(data_set):
    parts = [np.atleast_1d(np.asarray(data_set[f"r{k}"], complex)) for k in range(1, 7) if f"r{k}" in data_set]
    nodes = np.atleast_1d(np.asarray(data_set["node_nums"], int))
    names = [f"node {n} direction {k}" for k in range(1, len(parts) + 1) for n in nodes]
    ratio = float(data_set.get("modal_damp_vis", 0.0) or 0.0)
    return MeasuredModes(frequency=[float(data_set["freq"])], frequency_std=[0.0], damping_ratio=[ratio],
                         damping_ratio_std=[0.0], place=names, shape=np.concatenate(parts)[None, :])
