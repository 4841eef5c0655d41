"""Universal files: time signals and frequency responses (data set 58), modes (data set 55). The door of pyuff."""

import warnings
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from pipeline.contract.errors import ConfigError, first_of
from pipeline.contract.units import QUANTITIES, in_si, measured_in, quotient_in_si, read_as
from pipeline.products import FrequencyResponse, MeasuredModes
from pipeline.recordings import waveform
from pipeline.recordings.samples import channel, even_rate
from pipeline.recordings.universal_sets import universal_sets

#: function types of data set 58
TIME, RESPONSE = 1, 4
#: ordinate codes of data set 58
QUANTITY = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force", 15: "pressure",
            21: "pressure", 5: "temperature"}
#: the same of rotations, whose directions are 4 to 6
TURNING = {8: "angle", 9: "torque", 11: "angular_velocity", 12: "angular_acceleration", 13: "torque"}
#: what is read: modes, functions, and the system of units of the file
READ = (55, 58, 164)
#: SI units of quantities, and the powers of length and force in them, for files whose units are a system (data set 164)
IN_SYSTEM = {2: ("Pa", -2, 1), 3: ("1", 0, 0), 8: ("m", 1, 0), 11: ("m/s", 1, 0), 12: ("m/s^2", 1, 0), 9: ("N", 0, 1),
             13: ("N", 0, 1), 15: ("Pa", -2, 1)}
TURNED_IN_SYSTEM = {3: ("1", 0, 0), 8: ("rad", 0, 0), 11: ("rad/s", 0, 0), 12: ("rad/s^2", 0, 0), 9: ("N m", 1, 1),
                    13: ("N m", 1, 1)}
#: the same of a quantity that is general (code 1), by the powers of length, force and temperature that its axis states
GENERAL = {(0, 1, 0): ("N", 0, 1), (1, 1, 0): ("N m", 1, 1), (-2, 1, 0): ("Pa", -2, 1)}
#: what an abscissa has, by its code
ABSCISSA = {17: "times", 18: "frequencies", 19: "rotational speeds", 20: "orders"}
#: functions of data set 58 that are not read, in words
FUNCTIONS = {0: "general function", 2: "auto spectrum", 3: "cross spectrum", 5: "transmissibility", 6: "coherence",
             9: "power spectral density", 10: "energy spectral density", 12: "spectrum", 13: "cumulative distribution"}

#: characters of the name of a response; a longer one stands in the first title as well
_NAME = 10
#: how far beyond the median of a signal no sample of it lies
_FAR = 1e12
#: functions left out that are told one by one
_TOLD = 5


def read_uff(path, units=None, time_unit=None, frequency_unit=None, keep_going=False, tell=None):
    """(channels, frf, modes), each a dict by name, of the universal file at ``path``.

    ``units``: response name -> unit, which goes before that of the data set, and that before the system of units of the
    file (data set 164); ``time_unit``, ``frequency_unit``: the same of abscissae. A function whose unit or abscissa
    cannot be read is left out where others remain, and ``tell`` is called with what was left out or guessed; one that
    ``units`` names ends in its error unless ``keep_going``. Data sets of other kinds are ignored. Raises ConfigError
    for a file that is not a universal file, is truncated, holds other bytes than it declares or no data set of these
    kinds, and for ``units`` of responses that it does not contain.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise ConfigError(path, "a readable universal file", str(error)) from None
    units, channels, frf, modes, tell = units or {}, {}, {}, {}, tell or (lambda remark: None)
    found = universal_sets(content, path)
    sets = [(number, _read(one, f"{path}: data set {number}")) for number, one in enumerate(found, 1)
            if one.kind in READ]
    names = _names(sets)
    strange = sorted(set(units) - {*names.values(), *(_name(one) for _, one in sets if one["type"] == 58)})
    if strange:
        raise ConfigError(f"{path}: units", f"responses among {', '.join(names.values()) or 'none'}",
                          ", ".join(strange))
    system = next((data_set for _, data_set in sets if data_set["type"] == 164), None)
    told, refused = [(one.remark, f"data set {number}") for number, one in enumerate(found, 1) if one.remark], []
    for number, data_set in sets:
        if data_set["type"] == 55 and ("freq" in data_set or "eig" in data_set):
            modes[f"mode_{len(modes) + 1}"] = _mode(data_set)
        if number not in names:
            continue
        name = names[number]
        stated = units.get(name, units.get(_name(data_set), ""))
        case = _Case(f"{path}: data set {number} ({name})", name, stated, time_unit, frequency_unit)
        try:
            if data_set["func_type"] == TIME:
                channels[name], guesses = _signal(data_set, case, system)
            else:
                frf[name], guesses = _response(data_set, case, system)
            told += [(guess, name) for guess in guesses]
        except ConfigError as error:
            if stated and not keep_going:
                raise
            refused.append(error)
    if refused and not channels and not frf:
        raise refused[0]
    if not channels and not frf and not modes:
        raise ConfigError(path, "time signals, frequency responses or modes", _others(found, sets))
    for remark in dict.fromkeys(remark for remark, _ in told):
        tell(f"{path}: {first_of([of for other, of in told if other == remark], 3)}: {remark}")
    for error in refused[:_TOLD]:
        tell(f"left out: {error}")
    if len(refused) > _TOLD:
        tell(f"left out: {len(refused) - _TOLD} more functions of {path} for such reasons")
    return channels, frf, modes


@dataclass(frozen=True)
class _Case:
    """What a case says of a function called ``name``: its ``unit`` and those of abscissae, '' or None where nothing."""

    where: str
    name: str
    unit: str
    time_unit: str | None
    frequency_unit: str | None

    @property
    def line(self):
        """What to write in the case."""
        return f"add units: {{{self.name}: ...}}"


def _names(sets):
    """{number: name} of the functions that are read."""
    names = {}
    for number, data_set in sets:
        if data_set["type"] == 58 and data_set["func_type"] in (TIME, RESPONSE):
            kind = {n: names[n] for n, other in sets if n in names and other["func_type"] == data_set["func_type"]}
            names[number] = waveform.free_name(_name(data_set), set(kind.values()))
    return names


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


def _name(data_set):
    """'mic_01' of a response entity 'Mic 01'; node and direction where the file names none."""
    named, title = data_set.get("rsp_ent_name", "NONE").strip(), data_set.get("id1", "").strip()
    named = title if len(named) == _NAME and title.startswith(named) else named
    spelt = waveform.plain_name(named.lower().replace("+", "p").replace("-", "m"), "")
    return spelt if spelt and spelt != "none" else f"node_{data_set['rsp_node']}_{data_set['rsp_dir']}"


def _unit(data_set, case, system, axis="ordinate", direction="rsp_dir"):
    """(unit, factor on the numbers) of an ``axis``: of the case, of the set, or of the file (``system``); ('', 1) of
    none."""
    unit = (case.unit if axis == "ordinate" else "") or _label(data_set, axis)
    if unit or system is None:
        return unit, 1.0
    powers = tuple(int(data_set.get(f"{axis}_{power}_unit_exp", 0)) for power in ("len", "force", "temp"))
    table = TURNED_IN_SYSTEM if _turns(data_set[direction]) else IN_SYSTEM
    code = data_set[f"{axis}_spec_data_type"]
    unit, length, force = GENERAL.get(powers, ("", 0, 0)) if code == 1 else table.get(code, ("", 0, 0))
    return unit, system["length"] ** -length * system["force"] ** -force


def _turns(direction):
    return 4 <= abs(direction) <= 6


def _label(data_set, axis):
    """The unit that the label of an ``axis`` states; '' of none."""
    return waveform.unit_of(data_set.get(f"{axis}_axis_units_lab", "").strip())


def _axis(data_set, stated, code, unit, case):
    """The abscissa in ``unit``, s or Hz, of a data set; ``stated``: its unit by the case, ``code``: its usual one."""
    label, found = _label(data_set, "abscissa"), int(data_set["abscissa_spec_data_type"])
    setting, expected = f"{'time' if unit == 's' else 'frequency'}_unit", f"{ABSCISSA[code]} as its abscissa"
    line = f"add {setting}: ..., the unit that its abscissa has"
    if not stated and (found in (19, 20) or (not label and found in ABSCISSA and found != code)):
        raise ConfigError(case.where, expected, f"{ABSCISSA[found]}{f' in {label}' * bool(label)}",
                          f"add {setting}: {unit} where its head is wrong")
    at = f"{case.where}: unit of the abscissa"
    values, name = in_si(np.asarray(data_set["x"], float), stated or label or unit, at, line=line)
    if name == "rad/s" and unit == "Hz":
        values, name = values / (2 * np.pi), "Hz"
    if name != unit:
        raise ConfigError(case.where, expected, repr(stated or label), line)
    return values


def _direction(code):
    """Unit vector of a direction code: 1, 2, 3 = x, y, z, negative against it; empty for rotations and scalars."""
    if abs(code) not in (1, 2, 3):
        return ()
    return tuple(np.sign(code) * np.eye(3)[abs(code) - 1])


def _signal(data_set, case, system):
    """(Channel, what was guessed, in sentences)."""
    rate, begin = even_rate(_axis(data_set, case.time_unit, 17, "s", case), case.where)
    unit, factor = _unit(data_set, case, system)
    _needed(unit, case)
    code, label = data_set["ordinate_spec_data_type"], data_set["ordinate_axis_lab"].strip().lower().replace(" ", "_")
    measures = (TURNING if _turns(data_set["rsp_dir"]) else QUANTITY).get(code) or (
        label if label in QUANTITIES else _measured(unit, case))
    coded, guess = measures, read_as(unit, measures)
    if case.unit and not _fits(unit, measures):
        measures = _measured(unit, case)
    told = [f"unit {unit!r} is read as {guess}"] * bool(guess) + [
        f"its head says {coded}; by the unit in the case it is {measures}"] * (measures != coded)
    return channel(factor * np.asarray(data_set["data"]), unit, measures, _meant(rate), begin, case.where,
                   role="excitation" if measures == "force" or code == 13 else "response", line=case.line,
                   place=f"node {data_set['rsp_node']}" if data_set["rsp_node"] else "",
                   direction=_direction(data_set["rsp_dir"])), told


def _needed(unit, case):
    if not unit:
        raise ConfigError(case.where, "a unit in the file or in 'units'", "none", case.line)


def _measured(unit, case):
    return measured_in(unit, f"{case.where}: unit", case.line)


def _fits(unit, measures):
    try:
        return bool(in_si(1.0, unit, "unit", measures))
    except ConfigError:
        return False


def _meant(rate):
    """The sampling rate in Hz of a file that states its inverse to six digits: a whole one, where that is as good."""
    step = 1.0 / rate
    rounding = 0.501 * 10.0 ** (np.floor(np.log10(step)) - 5)
    return float(round(rate)) if abs(1.0 / max(round(rate), 1) - step) <= rounding else rate


def _response(data_set, case, system):
    """(FrequencyResponse, what was guessed, in sentences)."""
    frequency = _axis(data_set, case.frequency_unit, 18, "Hz", case)
    upper, factor = _unit(data_set, case, system)
    _needed(upper, case)
    below, per = _unit(data_set, case, system, "orddenom", "ref_dir")
    if case.unit and _whole(case.unit, below):
        below, per = "", 1.0
    spelt = upper if not below else f"({upper})/({below})" if "/" in below else f"{upper}/{below}"
    values, unit = quotient_in_si(factor / per * np.asarray(data_set["data"], complex), spelt, f"{case.where}: unit",
                                  case.line)
    guess = read_as(spelt, response=True)
    return FrequencyResponse(frequency=frequency, response=values, unit=unit,
                             place=f"node {data_set['rsp_node']} direction {data_set['rsp_dir']}",
                             reference=f"node {data_set['ref_node']} direction {data_set['ref_dir']}"), (
        [f"unit {spelt!r} is read as {guess}"] * bool(guess))


def _whole(stated, below):
    """Whether the unit of a case is that of the response per reference, not of the response alone."""
    last = stated.rpartition("/")[2]
    return not _fits(stated, "") or (last != stated and _same(last, below))


def _same(one, other):
    try:
        return in_si(1.0, one, "unit")[1] == in_si(1.0, other, "unit")[1]
    except ConfigError:
        return False


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
