"""Units of channels as people and measurement systems write them, as units that pint reads.

pint knows units that no channel has, and reads labels as those: PA as petaampere, G as gauss, mils as an angle, cfm as
centifermi. So what a channel may be stated in is a list, with the prefixes that occur; case counts where it tells two
units of it apart. What may mean several of them is refused, with these.
"""

import re
import unicodedata
from dataclasses import dataclass
from functools import cache

from pipeline.contract.received.unit_grammar import LONGEST, POWER, NoUnitError

#: prefix -> the word for it
_PREFIXES = {"n": "nano", "u": "micro", "m": "milli", "c": "centi", "d": "deci", "da": "deca",
             "h": "hecto", "k": "kilo", "M": "mega", "G": "giga"}
#: (unit of pint, symbols, prefixes of these, words and other spellings whose case counts for nothing)
_UNITS = (
    ("m", "m", "n u m c d k", "meter meters metre metres"),
    ("um", "", "", "micron microns"), ("thou", "mil", "", "mils thou"),
    ("inch", "in", "u", "inch inches"), ("ft", "ft", "", "foot feet"), ("yard", "yd", "", "yard yards"),
    ("mile", "mi", "", "mile miles"), ("angstrom", "Å", "", "angstrom"),
    ("s", "s sec", "n u m", "secs second seconds sek sekunde sekunden"),
    ("minute", "min", "", "mins minute minutes"), ("hour", "h", "", "hr hrs hour hours"), ("day", "d", "", "day days"),
    ("Hz", "Hz", "m k M G", "hertz cps"),
    ("g", "g", "u m k", "gram grams gramme gramm"), ("t", "t", "", "tonne tonnes"),
    ("lb", "lb", "", "lbs lbm pound pounds"),
    ("oz", "oz", "", "ounce ounces"), ("slug", "slug", "", "slugs"),
    ("g_0", "gn g_0 g_n g0", "m u", "g's gs gee gees"), ("galileo", "Gal", "m", ""),
    ("N", "N", "n u m c d da k M", "newton newtons"), ("kgf", "kgf kp", "", "kilopond kiloponds"), ("gf", "gf", "", ""),
    ("lbf", "lbf", "k", "lbsf"), ("kip", "kip", "", "kips"), ("ozf", "ozf", "", ""), ("dyn", "dyn", "", "dyne dynes"),
    ("N*m", "Nm", "n u m c d da k M", "newtonmeter newtonmeters newtonmetre newtonmetres"), ("N*mm", "Nmm", "k M", ""),
    ("N*cm", "Ncm", "", ""),
    ("kgf*m", "kgfm kpm", "", ""), ("lbf*ft", "", "", "lbft ftlb ftlbs lbfft ftlbf"),
    ("lbf*inch", "", "", "lbin inlb inlbs lbfin inlbf"), ("ozf*inch", "", "", "ozin inoz"),
    ("Pa", "Pa", "n u m h k M G", "pascal pascals"), ("bar", "bar", "u m k", "bars"),
    ("psi", "psi", "k", ""), ("kpsi", "ksi", "", ""),
    ("atm", "atm", "", ""), ("torr", "Torr", "m", ""), ("mmHg", "mmHg", "", ""), ("inHg", "inHg", "", ""),
    ("rad", "rad", "n u m", "radian radians"), ("deg", "deg ° arcdeg", "m", "degree degrees degs"),
    ("arcmin", "arcmin", "", ""), ("arcsec", "arcsec", "", ""),
    ("turn", "rev", "", "revs revolution revolutions turn turns cycle cycles umdr umdrehung umdrehungen"),
    ("rpm", "rpm", "k", "upm"), ("rps", "rps", "", "ups"),
    ("kph", "", "", "kph kmh kmph"), ("mph", "mph", "", ""), ("knot", "", "", "knot knots kts"),
    ("inch/s", "ips", "", ""), ("ft/minute", "fpm", "", ""),
    ("K", "K", "m", "kelvin kelvins degk"), ("degC", "degC °C oC", "", "celsius centigrade"),
    ("degF", "degF °F", "", "fahrenheit"), ("degR", "degR °R", "", "rankine"),
    ("V", "V", "n u m k", "volt volts"), ("A", "A", "n u m k", "amp amps ampere amperes"),
    ("ohm", "Ω ohm", "m k M", "ohms"), ("coulomb", "pC nC uC mC", "", "coulomb coulombs"),
    ("farad", "", "", "farad"), ("henry", "", "", "henry"), ("T", "T", "u m", "tesla"),
    ("W", "W", "u m k M", "watt watts"), ("V*A", "VA", "k", ""), ("hp", "hp", "", "horsepower"),
    ("metric_horsepower", "PS", "", "cv"), ("J", "J", "u m k M", "joule joules"), ("W*hour", "Wh", "k", ""),
    ("A*hour", "Ah", "m", ""), ("cal", "cal", "k", ""),
    ("l", "l L", "u m c d h", "liter liters litre litres lit"), ("cm^3", "", "", "cc ccm"),
    ("l/minute", "lpm", "", ""), ("ft^3/minute", "cfm", "", ""), ("gallon/minute", "gpm", "", ""),
    ("poise", "cP", "", "poise"), ("stokes", "cSt", "", "stokes"), ("lx", "lx", "", "lux"),
    ("percent", "%", "", "percent pct prozent"), ("permille", "‰", "", "permille"), ("ppm", "ppm", "", ""),
    ("1", "ε", "u m", "strain strains epsilon"), ("ppm", "ue", "", "ustrain"),
    ("1", "", "", "count counts cts pulse pulses tick ticks step steps digit digits lsb bit bits unitless"),
    ("1", "", "", "dimensionless"),
)
#: symbols that stand for a prefix and a unit together
_WITH_PREFIX = {"pC": "pC", "nC": "nC", "uC": "uC", "mC": "mC", "cP": "cP", "cSt": "cSt"}
#: units of a thousandth, which capitals do not tell from a million
_MILLI = frozenset("m" + unit for unit, _, prefixes, _ in _UNITS if "m" in prefixes.split())
#: what two units are in other case, and what is meant where people do not mind theirs
_MEANT = {"G": "g_0", "mG": "mg_0", "NM": "N*m", "MPA": "MPa", "Mpa": "MPa", "mpa": "MPa", "MHZ": "MHz", "Mhz": "MHz",
          "mhz": "MHz", "kn": "kN"}
#: letters alone that are read in the other case as well; others may as well be names
_LETTERS = {"M": "m", "S": "s", "v": "V", "H": "hour"}
#: labels that name no unit, or several: what to write
_NONE = {"C": "write degC where it is a temperature", "F": "write degF where it is a temperature",
         "EU": "EU, engineering units, may be any: write the one that was set", "kG": "write kg or g",
         "grad": "write deg or gon", "ton": "write t, or kN of a force", "tons": "write t, or kN of a force",
         "mic": "write um where it is a length, Pa where it is a microphone's"}
#: temperatures where these letters are read as such
_TEMPERATURES = {"C": "degC", "F": "degF"}
#: whole labels, without blanks: as units of pint, and whether that is a guess
_WHOLE = {**dict.fromkeys(("U/min", "u/min", "U/Min", "r/min", "R/MIN", "tr/min", "giri/min", "ot/min", "Umin-1"),
                          ("rpm", False)),
          **dict.fromkeys(("1/min", "/min", "min-1", "min^-1", "min^(-1)", "1/MIN", "MIN-1", "min**-1"), ("rpm", True)),
          **dict.fromkeys(("U/s", "r/s", "tr/s"), ("rps", False)), **dict.fromkeys(("cpm", "CPM"), ("1/minute", True)),
          **dict.fromkeys(("ms-2", "ms^-2", "ms^(-2)", "ms**-2"), ("m/s^2", True)), "mms-2": ("mm/s^2", True),
          **dict.fromkeys(("ms-1", "ms^-1", "ms^(-1)", "ms**-1"), ("m/s", True)), "mms-1": ("mm/s", True),
          **dict.fromkeys(("mmH2O", "mm H2O", "mmWS", "mmWC"), ("mmH2O", False)),
          **dict.fromkeys(("cmH2O", "cm H2O"), ("cmH2O", False)),
          **dict.fromkeys(("inH2O", "in H2O", "inWC", "inchH2O"), ("inch_H2O", False)),
          **dict.fromkeys(("kgm2", "kgm^2"), ("kg*m^2", False)), "kgm": ("kgf*m", True),
          **dict.fromkeys(("", "1", "-", "--", "---", "[-]", "[1]", "(-)", "[]"), ("", False))}

_LIKE = str.maketrans({"º": "°", "˚": "°", "−": "-", "–": "-", "‐": "-", "·": "*", "⋅": "*", "•": "*", "∙": "*",
                       "×": "*", "’": "'", "´": "'", "`": "'", "μ": "u", "µ": "u", "Ω": "Ω", "∕": "/", "⁄": "/",
                       "ϵ": "ε"})
#: text in UTF-8 that was read as Windows-1252
_TWICE = {"Â": "", "Î¼": "u", "Î©": "Ω", "Îµ": "ε"}
_DEGREES = re.compile(r"(?<![A-Za-z])(?:deg(?:ree)?s?\.?|grad|grd|°)[\s_-]*(celsius|fahrenheit|kelvin|[cfk])"
                      r"(?![A-Za-z])", re.IGNORECASE)
#: what is said of a value behind its unit: pressures above that of the air, effective values, relative humidity
_GAUGE = re.compile(r"(?P<unit>(?:.*[\W_])?(?:(?i:[mk]?bars?|k?psi)|[hkMm]?Pa|[KM]?PA|kgf?/cm(?:\^|\*\*)?2))"
                    r"\s*_?\(?\s*(?:g|gauge|a|abs|absolute|rel|relative|d|diff|ü|e|G|A|ABS|GAUGE)\s*\)?")
_EFFECTIVE = re.compile(r"(?P<unit>.*?[^\s_(])[\s_]*\(?\s*(?:rms|eff|0-pk|0-p|pk|peak)\s*\)?", re.IGNORECASE)
_HUMID = re.compile(r"%\s*_?\(?r\.?\s*[hf]\.?\)?|%\s*rel\.?\s*\w*", re.IGNORECASE)
_SPANS = re.compile(r".*[^A-Za-z](?:pk-pk|p-p|pkpk|pp)\)?", re.IGNORECASE)
_POWER = (r"(?:(?:\^|\*\*)\s*(?:\(\s*(?P<inner>[-+]?\d)\s*\)|(?P<bare>[-+]?\d))|(?P<plain>(?<=[A-Za-zΩ°)])\d|-\d))"
          r"(?![\d.])")
_TOKEN = re.compile(rf"\s*(?:(?P<power>{_POWER})|(?P<name>g_0|g_n|g0|[A-Za-zΩεÅ%‰°][A-Za-zΩε°']*)"
                    r"|(?P<one>1)(?![\w.])|(?P<mark>\*|/|\(|\)|\.(?=\s*[A-Za-z(])|-(?=\s*[A-Za-z(])|_(?=[A-Za-z])))")
#: a mass that stands for its weight, and g as accelerometers state it
_FORCES = (("kg", "kgf"), ("lb", "lbf"), ("oz", "ozf"))
_GRAVITY = (("g", "g_0"), ("mg", "mg_0"), ("ug", "ug_0"))
_BOTH = (*_FORCES, *_GRAVITY)
#: parts that a label may have
_PARTS = 12


@dataclass(frozen=True)
class Reading:
    """What a label may mean: ``unit`` as pint reads it, and whether that is a ``guess`` that is to be told."""

    unit: str
    guess: bool = False


@cache
def readings(label, response=False):
    """[Reading] of a unit as it is written, the likeliest first; NoUnitError, with what to write, of none or several.

    A mass may stand for its weight, and g for standard gravity, which comes first in the unit of a ``response`` per
    reference: which is meant, the quantity tells.
    """
    if len(label) > LONGEST:
        raise NoUnitError(f"a unit of {len(label)} characters")
    text = plain(label)
    whole = _whole(text)
    if whole:
        return [Reading(*whole)]
    if text in _TEMPERATURES:
        return [Reading(_TEMPERATURES[text], True)]
    if _SPANS.fullmatch(text):
        raise NoUnitError("values from peak to peak are no samples")
    text, known = _with_whole(text) if response else (text, False)
    bare, guess = _unqualified(text)
    guess, tokens = guess or known, _tokens(bare)
    found, seen = [], set()
    for below in (False, True):
        parts = _product(tokens, below)
        guessed = guess or any(each.guess for each, _ in parts)
        for change in (_GRAVITY, _BOTH, (), _FORCES) if response else ((), _FORCES, _GRAVITY, _BOTH):
            spelt = _spelt([(dict(change).get(each.unit, each.unit) if abs(power) == 1 else each.unit, power)
                            for each, power in parts])
            if spelt not in seen:
                seen.add(spelt)
                found.append(Reading(spelt, guessed or below or change in (_FORCES, _BOTH)))
    return found


def _whole(text):
    """What _WHOLE says of a label in plain characters, None where it does not hold it."""
    return _WHOLE.get(re.sub(r"\s*([/^-])\s*", r"\1", text))


def _with_whole(text):
    """(label of a response per reference, both in plain characters and with what _WHOLE says of them, whether that is a
    guess): ms-2/N is no 1/ms^2/N."""
    above, _, below = text.rpartition("/")
    parts = [plain(part) for part in (above, below)]
    known = [_whole(part) if part else None for part in parts]
    if not above or not (any(known) or parts != [above, below]):
        return text, False
    spelt = [f"({one[0] or 1})" if one else f"({part})" for part, one in zip(parts, known, strict=True)]
    return "/".join(spelt), any(one[1] for one in known if one)


def only_of(label):
    """The quantity of which alone a label is read: 'temperature' of C and F; '' of any other."""
    return "temperature" if plain(label) in _TEMPERATURES else ""


def hint(label):
    """What to write instead of a label that is no unit; '' where nothing is known of it."""
    text = plain(label)
    return _NONE.get(text) or _NONE.get(text.lower()) or _NONE.get(text.upper(), "")


def plain(label):
    """A label in plain characters, without brackets around it: ``[µm/s²]`` is um/s2."""
    for twice, once in _TWICE.items():
        label = label.replace(twice, once)
    text = unicodedata.normalize("NFKC", label.translate(_LIKE)).translate(_LIKE).strip()
    if text[:1] + text[-1:] in ("[]", "()", "<>") and _balanced(text[1:-1]):
        text = text[1:-1].strip()
    text = re.sub(r"\s+per\s+", "/", text, flags=re.IGNORECASE)
    text = re.sub(r"\.(?=\s*(?:$|[/*)^-]))", "", text)
    return _DEGREES.sub(lambda match: f"deg{match[1][0].upper()}", text)


def _balanced(text):
    """Whether every parenthesis of a text has its other one behind it, and there are no other brackets."""
    bare = re.sub(r"\([^()]*\)", "", text)
    return not set("[]()<>") & set(bare) and not set("[]<>") & set(text)


def _unqualified(text):
    """(text without what is said of its values, whether something was)."""
    if _HUMID.fullmatch(text):
        return "%", False
    gauge = _GAUGE.fullmatch(text)
    if gauge:
        return gauge["unit"], False
    effective = _EFFECTIVE.fullmatch(text)
    return (effective["unit"], True) if effective else (text, False)


def _tokens(text):
    """[(kind, Reading, power or mark)] of a label."""
    found, position = [], 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if not match:
            raise NoUnitError(f"{text[position:position + 20]!r}")
        kind = "power" if match["power"] else match.lastgroup
        if kind == "power":
            size = int(match["inner"] or match["bare"] or match["plain"])
            if not 0 < abs(size) <= POWER:
                raise NoUnitError("a power of 0")
            found.append((kind, size))
        elif kind == "name":
            found.append((kind, _named(match["name"])))
        elif kind == "one":
            found.append(("name", Reading("1")))
        else:
            found.append(("mark", match["mark"] if match["mark"] in "/()" else "*"))
        position = match.end()
    if len(found) > 4 * _PARTS:
        raise NoUnitError(f"{len(found)} parts")
    return found


def _product(tokens, below):
    """[(Reading, power)] of tokens. ``below``: what follows a stroke is below it, up to the next one."""
    parts, end = _parts(list(tokens), 0, below, 0)
    if end < len(tokens):
        raise NoUnitError("a parenthesis too many")
    return parts


def _parts(tokens, position, below, depth):
    if depth > 3:
        raise NoUnitError("parentheses within parentheses")
    parts, sign, needed = [], 1, True
    while position < len(tokens) and tokens[position] != ("mark", ")"):
        kind, what = tokens[position]
        position += 1
        if kind == "mark" and what in "*/":
            if needed and (what == "*" or parts):
                raise NoUnitError(f"{what!r} without a unit before it")
            sign, needed = -1 if what == "/" or (below and sign < 0) else 1, True
            continue
        if kind == "power":
            raise NoUnitError("a power without a unit before it")
        if not needed:
            sign = sign if below else 1
        if kind == "mark":
            inner, position = _parts(tokens, position, below, depth + 1)
            if position == len(tokens):
                raise NoUnitError("an open parenthesis")
            position += 1
        else:
            inner = [(what, 1)]
        power = sign
        if position < len(tokens) and tokens[position][0] == "power":
            power, position = sign * tokens[position][1], position + 1
        parts += [(each, power * size) for each, size in inner]
        needed = False
        if any(abs(size) > POWER for _, size in parts) or len(parts) > _PARTS:
            raise NoUnitError(f"powers above {POWER}, or more than {_PARTS} units")
    if needed:
        raise NoUnitError("no unit")
    return parts, position


def _spelt(parts):
    """A product of [(unit, power)] as pint reads it; temperatures within one are differences."""
    parts = [(unit, power) for unit, power in parts if unit != "1"]
    if len(parts) != 1 or parts[0][1] != 1:
        within = {"degC": "K", "degF": "delta_degF"}
        parts = [(within.get(unit, unit), power) for unit, power in parts]
    above = "*".join(_raised(unit, power) for unit, power in parts if power > 0)
    under = "".join(f"/{_raised(unit, -power)}" for unit, power in parts if power < 0)
    return (above or "1" * bool(under)) + under


def _raised(unit, power):
    unit = f"({unit})" if set(unit) & set("*/^") else unit
    return unit if power == 1 else f"{unit}^{power}"


def _named(name):
    """The Reading of one unit with its prefix; NoUnitError, with what to write, of none or several."""
    exact, caseless = _tables()
    if name in exact:
        return Reading(exact[name])
    if name in _MEANT:
        return Reading(_MEANT[name], True)
    if len(name) == 1:
        if name not in _LETTERS:
            raise NoUnitError(repr(name))
        return Reading(_LETTERS[name], True)
    found = sorted(caseless.get(name.lower(), ()) if hint(name) == "" else ())
    if len(found) > 1:
        raise NoUnitError(f"{' or '.join(found)}", f"write {' or '.join(found)}".replace("*", " "))
    if not found:
        raise NoUnitError(repr(name))
    return Reading(found[0], name[0] == "M" and found[0] in _MILLI)


@cache
def _tables():
    """({spelling: unit of pint}, {spelling in small letters: {units of pint}})."""
    exact, caseless = {}, {}
    for unit, symbols, prefixes, words in _UNITS:
        for prefix in ("", *prefixes.split()):
            whole = _prefixed(prefix, unit)
            for symbol in symbols.split():
                exact[prefix + symbol] = _WITH_PREFIX.get(symbol, whole)
            for word in words.split():
                exact.setdefault(prefix and _PREFIXES[prefix] + word or word, whole)
    for spelling, unit in exact.items():
        caseless.setdefault(spelling.lower(), set()).add(unit)
    return exact, caseless


def _prefixed(prefix, unit):
    if not prefix or unit != "1":
        return prefix + unit
    return {"u": "ppm", "m": "permille"}[prefix]
