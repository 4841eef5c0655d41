"""How a term changes with speed and friction: '1', 'speed^2 - 1', 'friction/speed', '-0.5 friction'.

A sum of products of numbers and whole powers of ``speed``, the speed over that for which the matrices were made, and
``friction``, the coefficient over theirs.
"""

import re

from pipeline.contract import ConfigError

#: largest power
_POWER = 9
_SIGN = re.compile(r"\s*([+-]?)\s*")
_FACTOR = re.compile(r"(?P<number>\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(?P<name>speed|friction)"
                     r"(?:\s*(?:\^|\*\*)\s*(?P<power>-?\d))?")
_BETWEEN = re.compile(r"\s*([*/]?)\s*")
#: longest text that is read
_LONGEST = 200


def summands(text, where):
    """((coefficient, power of speed, power of friction), ...) of a dependence; ConfigError if it is none."""
    found, at = [], 0
    while at < len(text.rstrip()) or not found:
        sign = _SIGN.match(text, at)
        if len(text) > _LONGEST or (found and not sign[1]):
            raise _strange(text, where)
        one, at = _product(text, sign.end(), where)
        found.append((-one[0] if sign[1] == "-" else one[0], *one[1:]))
    if any(max(map(abs, powers)) > _POWER for _, *powers in found):
        raise ConfigError(where, f"powers up to {_POWER}", repr(text))
    return tuple(found)


def _product(text, at, where):
    """((coefficient, powers), end) of the product that begins ``at``."""
    coefficient, powers, operation = 1.0, {"speed": 0, "friction": 0}, "*"
    while True:
        factor = _FACTOR.match(text, at)
        if not factor:
            raise _strange(text, where)
        turn = -1 if operation == "/" else 1
        if factor["number"]:
            if turn < 0 and not float(factor["number"]):
                raise _strange(text, where)
            coefficient *= float(factor["number"])**turn
        else:
            powers[factor["name"]] += turn * int(factor["power"] or 1)
        between = _BETWEEN.match(text, factor.end())
        if not between[1] and (between.end() == factor.end() or not _FACTOR.match(text, between.end())):
            return (coefficient, powers["speed"], powers["friction"]), factor.end()
        at, operation = between.end(), between[1] or "*"


def _strange(text, where):
    return ConfigError(where, "a sum of products of numbers, speed and friction, such as 'friction/speed - 1'",
                       repr(text[:_LONGEST]))
