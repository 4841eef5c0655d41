"""Mutations of documents of plain values, as in YAML and JSON: keys and values lost, renamed, retyped, nested."""

from copy import deepcopy

from tests.fuzz.mutation import EXTREMES, draw

_TEXTS = (
    "",
    "x",
    "nowhere",
    "-1 mm",
    "0 m",
    "1e308 m",
    "nan",
    "3",
    "12 mm",
    "1:30",
    "measured:none",
    "../../x",
    "*",
    "12 mm/s",
    "0.3 m/s",
    "5 %",
    "\u2028",
    "9**9**9 m",
    "é" * 50,
    "a.b.c",
    "block.x",
    "disc",
    "[1, 2]",
    "{}",
    "#",
    "ground",
    "2026-11-27",
    "~",
    "yes",
    "0x1f",
    "1e3",
    "_",
    "/",
    "/dev/null",
    "a" * 5000,
    "\x1b[2J",
    "0.1.x",
)
_VALUES = (
    None,
    True,
    False,
    0,
    -1,
    1,
    10**30,
    10**400,
    1e308,
    -1e-320,
    float("nan"),
    float("inf"),
    [],
    {},
    [[]],
    [None],
    {"a": {}},
    {"value": 1},
    {"value": "3 mm", "origin": "stated"},
    {"value": {}, "origin": 7},
    {"kind": "none"},
    {"based_on": None},
    [1, "a", {}],
    {"file": "x"},
    {1: 2},
    {None: 1},
    {True: "x"},
)


def reshaped(rng, document):
    """A copy of ``document`` with one to four changes at places drawn at random."""
    document = deepcopy(document)
    for _ in range(int(rng.integers(1, 5))):
        places = list(_places(document))
        if not places:
            return draw(rng, _VALUES)
        node, key = draw(rng, places)
        draw(rng, _CHANGES)(rng, node, key, places)
    return document


def _places(node):
    """(container, key or index) of every value within ``node``."""
    for key in list(node) if isinstance(node, dict) else range(len(node)) if isinstance(node, list) else ():
        yield node, key
        yield from _places(node[key])


def _lose(rng, node, key, places):
    del node[key]


def _rename(rng, node, key, places):
    if isinstance(node, dict):
        name = draw(rng, (f"{key}s", str(key)[:-1], draw(rng, _TEXTS), str(draw(rng, places)[1]), None, 7, True))
        node[name] = node.pop(key)


def _retype(rng, node, key, places):
    node[key] = deepcopy(draw(rng, _VALUES))


def _reword(rng, node, key, places):
    node[key] = draw(rng, (*_TEXTS, *EXTREMES))


def _nest(rng, node, key, places):
    value = node[key]
    for _ in range(int(draw(rng, (1, 1, 2, 60)))):
        value = draw(rng, ([value], {"value": value}, {str(key): value}))
    node[key] = value


def _exchange(rng, node, key, places):
    other, there = draw(rng, places)
    try:
        node[key] = deepcopy(other[there])
    except (KeyError, IndexError):  # a place that an earlier change took away
        node[key] = None


def _repeat(rng, node, key, places):
    if isinstance(node, list):
        node.insert(key, deepcopy(node[key]))
    else:
        node[f"{key}_2"] = deepcopy(node[key])


def _rescale(rng, node, key, places):
    """Another number in front of the same unit."""
    value = node[key]
    if isinstance(value, str) and " " in value:
        node[key] = f"{draw(rng, EXTREMES)} {value.partition(' ')[2]}"
    elif isinstance(value, int | float) and not isinstance(value, bool):
        size = 10 ** int(rng.integers(13))
        node[key] = draw(rng, (-value, 0, value * size, value // size if value == value else 7, value + 1, f"{value}"))
    else:
        node[key] = deepcopy(draw(rng, _VALUES))


_CHANGES = (_lose, _rename, _retype, _reword, _nest, _exchange, _repeat, _rescale, _rescale)
