"""Universal files: time signals and frequency responses (data set 58), modes (data set 55). The door of pyuff."""

import re
import warnings
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import QUANTITIES, measured_in, quotient_in_si
from pipeline.products import FrequencyResponse, MeasuredModes
from pipeline.recordings import waveform
from pipeline.recordings.samples import channel, even_rate
from pipeline.recordings.universal_sets import universal_sets

#: function types of data set 58
TIME, RESPONSE = 1, 4
#: ordinate codes of data set 58
QUANTITY = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force", 15: "pressure",
            21: "pressure", 5: "temperature"}
#: standard gravity as this kind of file writes it: g there is no gram
GRAVITY = re.compile(r"\bg\b")
#: what is read: modes, functions, and the system of units of the file
READ = (55, 58, 164)
#: SI units of quantities, and the powers of length and force in them, for files whose units are a system (data set 164)
IN_SYSTEM = {8: ("m", 1, 0), 11: ("m/s", 1, 0), 12: ("m/s^2", 1, 0), 9: ("N", 0, 1), 13: ("N", 0, 1),
             15: ("Pa", -2, 1)}
#: functions of data set 58 that are not read, in words
FUNCTIONS = {0: "general function", 2: "auto spectrum", 3: "cross spectrum", 5: "transmissibility", 6: "coherence",
             9: "power spectral density", 10: "energy spectral density", 12: "spectrum", 13: "cumulative distribution"}

#: characters of the name of a response; a longer one stands in the first title as well
_NAME = 10
#: how far beyond the median of a signal no sample of it lies
_FAR = 1e12


def read_uff(path, units=None):
    """(channels, frf, modes), each a dict by name, of the universal file at ``path``.

    ``units``: response name -> unit, for files that state none, neither of the data set nor of the file (data set
    164). Data sets of other kinds are ignored. Raises ConfigError for a file that is not a universal file, is
    truncated, holds other bytes than it declares or no data set of these kinds, and for ``units`` of responses that
    it does not contain.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise ConfigError(path, "a readable universal file", str(error)) from None
    units, channels, frf, modes = units or {}, {}, {}, {}
    found = universal_sets(content, path)
    sets = [(number, _read(one, f"{path}: data set {number}")) for number, one in enumerate(found, 1)
            if one.kind in READ]
    system = next((data_set for _, data_set in sets if data_set["type"] == 164), None)
    for number, data_set in sets:
        where = f"{path}: data set {number}"
        if data_set["type"] == 58 and data_set["func_type"] == TIME:
            _put(channels, _name(data_set), _signal(data_set, units, system, where))
        elif data_set["type"] == 58 and data_set["func_type"] == RESPONSE:
            _put(frf, _name(data_set), _response(data_set, units, system, where))
        elif data_set["type"] == 55 and ("freq" in data_set or "eig" in data_set):
            _put(modes, f"mode_{len(modes) + 1}", _mode(data_set))
    strange = sorted(set(units) - {_name(data_set) for _, data_set in sets if data_set["type"] == 58})
    if strange:
        raise ConfigError(f"{path}: units", f"responses among {', '.join((*channels, *frf)) or 'none'}",
                          ", ".join(strange))
    if not channels and not frf and not modes:
        raise ConfigError(path, "time signals, frequency responses or modes", _others(found, sets))
    return channels, frf, modes


def _read(one, where):
    """A UniversalSet as pyuff reads it from a file of its own; points are those that it declares."""
    import pyuff

    with TemporaryDirectory() as folder:
        alone = Path(folder) / "one.uff"
        alone.write_bytes(one.file)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                data_set = pyuff.UFF(str(alone)).read_sets(0)
        except Exception as error:  # pyuff passes on whatever its parser stumbles over
            raise ConfigError(where, f"a data set {one.kind}", str(error) or type(error).__name__) from None
    if one.kind == 58:
        count, found = int(data_set["num_pts"]), len(data_set["data"])
        if found != count or len(data_set["x"]) != count:
            raise ConfigError(where, f"{count} points, as its head says", f"{found}", "copy it again")
        if not np.isfinite(data_set["x"]).all() or _damaged(data_set["data"]):
            raise ConfigError(where, "finite numbers", "others", "the data set is damaged: copy it again")
        if one.doubtful and _torn(np.abs(data_set["data"])):
            raise ConfigError(where, "numbers of one size", "others towards its end", "a byte is lost: copy it again")
    return data_set


def _damaged(values):
    """Whether values are not finite other than by the one NaN that stands for a missing sample."""
    parts = np.ascontiguousarray(values).view(float)
    strange = parts[~np.isfinite(parts)]
    return bool(np.any(strange.view(np.int64) & np.iinfo(np.int64).max != np.float64(np.nan).view(np.int64)))


def _torn(size):
    """Whether absolute values (n,) differ as those do whose bytes are out of step."""
    some = size[np.nan_to_num(size) > 0.0]
    typical = np.median(some) if some.size else 1.0
    return bool(np.any(some > _FAR * typical) or np.any(some < typical / _FAR**2))


def _others(found, sets):
    """What a file holds beside what is read, in words."""
    kinds = Counter(f"data set {one.kind}" for one in found if one.kind not in READ)
    kinds.update(FUNCTIONS.get(data_set["func_type"], f"function of type {data_set['func_type']}")
                 for _, data_set in sets if data_set["type"] == 58)
    return ", ".join(f"{count} x {kind}" for kind, count in kinds.items()) or "none"


def _put(table, name, item):
    """Under ``name``, or the first free name_2, name_3, ..."""
    table[waveform.free_name(name, table)] = item


def _name(data_set):
    """'mic_01' of a response entity 'Mic 01'; node and direction where the file names none."""
    named, title = data_set.get("rsp_ent_name", "NONE").strip(), data_set.get("id1", "").strip()
    named = title if len(named) == _NAME and title.startswith(named) else named
    spelt = waveform.plain_name(named.lower().replace("+", "p").replace("-", "m"), "")
    return spelt if spelt and spelt != "none" else f"node_{data_set['rsp_node']}_{data_set['rsp_dir']}"


def _unit(data_set, units, where, system=None):
    """(unit, factor on the numbers) of the ordinate: of the set, of the case, or of the file (``system``)."""
    name = _name(data_set)
    unit, factor = _spelt(data_set.get("ordinate_axis_units_lab", "")) or _spelt(units.get(name, "")), 1.0
    if not unit and system and data_set["ordinate_spec_data_type"] in IN_SYSTEM:
        unit, length, force = IN_SYSTEM[data_set["ordinate_spec_data_type"]]
        factor = system["length"] ** -length * system["force"] ** -force
    if not unit:
        raise ConfigError(f"{where} ({name})", "a unit in the file or in 'units'", "none",
                          f"add units: {{{name}: ...}}")
    return unit, factor


def _spelt(label):
    """A unit as it is read of a ``label`` as systems write it; '' of one that states none."""
    return GRAVITY.sub("g_0", waveform.SPELT.get(label.strip(), label.strip()))


def _direction(code):
    """Unit vector of a direction code: 1, 2, 3 = x, y, z, negative against it; empty for rotations and scalars."""
    if abs(code) not in (1, 2, 3):
        return ()
    return tuple(np.sign(code) * np.eye(3)[abs(code) - 1])


def _signal(data_set, units, system, where):
    rate, begin = even_rate(np.asarray(data_set["x"], float), where)
    rate = _meant(rate)
    unit, factor = _unit(data_set, units, where, system)
    label = data_set["ordinate_axis_lab"].strip().lower().replace(" ", "_")
    measures = QUANTITY.get(data_set["ordinate_spec_data_type"]) or (label if label in QUANTITIES else measured_in(
        unit, where))
    role = "excitation" if measures == "force" else "response"
    return channel(factor * np.asarray(data_set["data"]), unit, measures, rate, begin, where, role=role,
                   place=f"node {data_set['rsp_node']}" if data_set["rsp_node"] else "",
                   direction=_direction(data_set["rsp_dir"]))


def _meant(rate):
    """The sampling rate in Hz of a file that states its inverse to six digits: a whole one, where that is as good."""
    step = 1.0 / rate
    rounding = 0.501 * 10.0 ** (np.floor(np.log10(step)) - 5)
    return float(round(rate)) if abs(1.0 / max(round(rate), 1) - step) <= rounding else rate


def _response(data_set, units, system, where):
    upper, factor = _unit(data_set, units, where, system)
    below = _spelt(data_set.get("orddenom_axis_units_lab", ""))
    if not below and system and data_set["orddenom_spec_data_type"] in IN_SYSTEM:
        below, length, force = IN_SYSTEM[data_set["orddenom_spec_data_type"]]
        factor *= system["length"] ** length * system["force"] ** force
    spelt = upper if not below else f"({upper})/({below})" if "/" in below else f"{upper}/{below}"
    values, unit = quotient_in_si(factor * np.asarray(data_set["data"], complex), spelt, where)
    return FrequencyResponse(frequency=data_set["x"], response=values, unit=unit,
                             place=f"node {data_set['rsp_node']} direction {data_set['rsp_dir']}",
                             reference=f"node {data_set['ref_node']} direction {data_set['ref_dir']}")


def _mode(data_set):
    parts = [np.atleast_1d(np.asarray(data_set[f"r{k}"], complex)) for k in range(1, 7) if f"r{k}" in data_set]
    nodes = np.atleast_1d(np.asarray(data_set["node_nums"], int))
    names = [f"node {n} direction {k}" for k in range(1, len(parts) + 1) for n in nodes]
    frequency, ratio = data_set.get("freq"), float(data_set.get("modal_damp_vis", 0.0) or 0.0)
    if frequency is None:       # a complex mode: s = growth rate + i angular frequency
        root = complex(data_set["eig"])
        frequency, ratio = abs(root) / (2.0 * np.pi), -root.real / max(abs(root), 1e-300)
    return MeasuredModes(frequency=[float(frequency)], frequency_std=[0.0], damping_ratio=[ratio],
                         damping_ratio_std=[0.0], place=names, shape=np.concatenate(parts)[None, :])
