"""What a unit may look like, checked before pint computes with it:

    unit    = ["1"] part { ("*" | "/" | " ") part }
    part    = name [power] | "(" unit ")" [power]
    power   = ("^" | "**") [sign] exponent, the exponent also in parentheses, or superscript digits
    exponent = whole number from 1 to 9, or 0.5, 1.5, ..., or a fraction such as 1/2

No number but 1 stands for itself, and powers of powers multiply to 9 at most: to evaluate such a text takes no time.
"""

import re

#: characters of a unit, its parts, and how deep parentheses go
LONGEST, _PARTS, _DEPTH = 120, 24, 6
#: largest power
POWER = 9
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_RAISED = re.compile(r"[⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+")
_NUMBER = r"[-+]?\s*(?:[0-9](?:\.[05])?|\.5)(?:\s*/\s*[0-9])?"
_TOKEN = re.compile(rf"\s*(?:(?P<power>(?:\^|\*\*)\s*(?:\(\s*(?P<inner>{_NUMBER})\s*\)|"
                    r"(?P<bare>[-+]?(?:[0-9](?:\.[05])?|\.5))))(?![\w.])|(?P<name>[^\W\d]\w{0,39}|[%°]\w{0,39})|(?P<one>1)(?![\w.])|(?P<mark>[*/()·⋅]))")


class NoUnitError(ValueError):
    """A text that is no unit; says why."""


def checked_unit(text):
    """``text`` as pint reads it; NoUnitError where it is not of the grammar above."""
    if len(text) > LONGEST:
        raise NoUnitError(f"a unit of {len(text)} characters")
    spelt = _RAISED.sub(lambda match: f"^({match[0].translate(_SUPERSCRIPTS)})", text).replace("·", "*").replace(
        "⋅", "*")
    tokens = _tokens(spelt)
    end, _ = _unit(tokens, 0, 0)
    if end < len(tokens):
        raise NoUnitError(f"{tokens[end][1]!r} where a unit ends")
    return spelt


def _tokens(text):
    """[(kind, what is spelt)] of a text; a power as its size."""
    found, position = [], 0
    text = text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if not match:
            raise NoUnitError(f"{text[position:position + 20]!r}")
        kind = match.lastgroup if match.lastgroup not in ("inner", "bare") else "power"
        found.append((kind, _size(match["inner"] or match["bare"]) if match["power"] else match[kind]))
        position = match.end()
    if len(found) > 4 * _PARTS:
        raise NoUnitError(f"{len(found)} parts")
    return found


def _size(power):
    """Absolute value of a power."""
    above, _, below = power.replace(" ", "").partition("/")
    if below == "0" or float(above) == 0.0:
        raise NoUnitError("a power of 0, or by 0")
    return abs(float(above)) / float(below or 1)


def _unit(tokens, position, depth):
    """(index behind the unit that begins at ``position``, its largest power)."""
    if depth > _DEPTH:
        raise NoUnitError("parentheses within parentheses")
    largest, needed, parts = 0.0, True, 0
    while position < len(tokens):
        kind, spelt = tokens[position]
        if kind == "mark" and spelt in "*/":
            if needed:
                raise NoUnitError(f"{spelt!r} without a unit before it")
            position, needed = position + 1, True
            continue
        if kind == "power" or (kind == "mark" and spelt == ")"):
            break
        position, power = _part(tokens, position, depth)
        largest, needed, parts = max(largest, power), False, parts + 1
        if parts > _PARTS:
            raise NoUnitError(f"more than {_PARTS} units")
    if needed:
        raise NoUnitError("no unit")
    return position, largest


def _part(tokens, position, depth):
    """The same of a name or of a unit in parentheses, with the power behind it."""
    kind, spelt = tokens[position]
    largest = 0.0 if kind == "one" else 1.0
    if spelt == "(":
        position, largest = _unit(tokens, position + 1, depth + 1)
        if position == len(tokens) or tokens[position][1] != ")":
            raise NoUnitError("an open parenthesis")
    position += 1
    if position < len(tokens) and tokens[position][0] == "power":
        largest, position = largest * tokens[position][1], position + 1
    if largest > POWER:
        raise NoUnitError(f"a power of {largest:g}, above {POWER}")
    return position, largest
