"""MATLAB files and recordings in HDF5."""

import io
from functools import cache

import h5py
import numpy as np
from scipy.io import savemat

from stages import recording
from tests.fuzz.mutation import damaged, draw
from tests.fuzz.targets import plain
from tests.fuzz.targets.tables import COUNT, EXPECTED, FORCE, MOVED, RATE, SETTINGS, TIME, read, right
from tests.fuzz.trial import Target, Trial

_GIVEN = {key: value for key, value in SETTINGS.items() if key != "time"} | {"sample_rate": "2 kHz"}
_HEAD = b"MATLAB 7.3 MAT-file, Platform: any".ljust(124) + b"\0\2IM"


def _matlab(path, **given):
    return read(path, recording.Matlab, **given)


def in_matlab(variables, form):
    """Bytes of a MATLAB file: version 4, 5, 5 compressed or 7.3."""
    if form == "7.3":
        return _hdf5(
            lambda h5: [h5.create_dataset(name, data=np.atleast_2d(values).T) for name, values in variables.items()],
            _HEAD,
        )
    stream = io.BytesIO()
    savemat(stream, variables, format=form[0], do_compression="c" in form, oned_as="row")
    return stream.getvalue()


def _hdf5(fill, head=b""):
    """Bytes of an HDF5 file that ``fill(h5)`` fills."""
    stream = io.BytesIO()
    with h5py.File(stream, "w", userblock_size=512 if head else 0) as h5:
        fill(h5)
    content = stream.getvalue()
    return head + content[len(head) :]


def _variables(rng):
    return {"force": FORCE, "moved": MOVED, "time": TIME, "note": "bench"} | (
        {"s": {"rate": RATE, "x": FORCE}} if rng.random() < 0.3 else {}
    )


def _matlab_damaged(rng):
    form = draw(rng, ("4", "5", "5c", "7.3"))
    variables = {"force": FORCE, "moved": MOVED, "time": TIME} if form in ("4", "7.3") else _variables(rng)
    return Trial("a.mat", damaged(rng, in_matlab(variables, form)), given=draw(rng, (_GIVEN, SETTINGS)))


def _matlab_odd(rng):
    """Whole files with variables of other types and shapes than vectors of numbers."""
    odd = [
        np.array([]),
        np.array([[1 + 2j, 3]]),
        np.array("text"),
        np.array([True] * COUNT),
        np.zeros((3, COUNT)),
        np.arange(COUNT, dtype=np.int8),
        np.array([[FORCE, "a"]], object),
        np.full(COUNT, np.inf),
        7,
        {"x": FORCE, "y": {"z": MOVED}},
        np.zeros((0, COUNT)),
        np.full(COUNT, np.nan),
        FORCE.astype(complex),
    ]
    names = draw(rng, (("force", "moved", "time"), ("force", "moved"), ("x", "force")))
    variables = {name: odd[int(rng.integers(len(odd)))] if rng.random() < 0.5 else FORCE for name in names}
    return Trial("a.mat", in_matlab(variables, draw(rng, ("5", "5c"))), "odd variables", draw(rng, (_GIVEN, SETTINGS)))


def _matlab_arranged(rng):
    """Another version, order, shape and precision of the same record."""
    form, kind = draw(rng, ("4", "5", "5c", "7.3")), draw(rng, ("<f8", ">f8", "<f4"))
    names = rng.permutation(["force", "moved", "time", "other"])
    shape = draw(rng, ((-1,), (-1, 1), (1, -1)))
    variables = {
        name: {"force": FORCE, "moved": MOVED, "time": TIME, "other": np.ones(3)}[name].astype(kind).reshape(shape)
        for name in names
    }
    return Trial("a.mat", in_matlab(variables, form), "version, order, shape", _GIVEN, right(), "read")


def _neutral(path):
    return read(path, recording.Neutral, kind="hdf5")


_FRF = {
    "drive": {"frequency": np.array([10.0, 20.0, 30.0]), "response": np.array([1 + 1j, 2.0, -1j]), "unit": "m/s^2/N"}
}
_HEIGHTS = np.arange(12.0).reshape(3, 4)
WHOLE = {
    "a": plain.run(
        EXPECTED["a"]["channels"],
        frf=_FRF,
        conditions={"pressure": {"value": [2e5], "unit": "Pa"}},
        modes={"hammer": {"frequency": np.array([100.0, 200.0]), "damping": np.zeros(2), "shape": np.zeros((2, 0))}},
        friction={"bench": {"friction": [0.4], "pressure": [1e6], "speed": [1.0], "temperature": [293.15]}},
        topography={"pad": {"height": _HEIGHTS * 1e-6, "x": 1e-6 * np.arange(4), "y": 1e-6 * np.arange(3)}},
    )
}


def _bench(h5, force=("N", 1.0), length=("m", 1.0), kind="<f8", order=(0, 1, 2, 3, 4, 5), **storage):
    """The runs of WHOLE, in these units, precision, order and storage."""
    run = h5.create_group("runs/a")
    run.attrs["description"] = "hammer"

    def channels():
        for name, values, (unit, size), measures in (
            ("force", FORCE, force, "force"),
            ("moved", MOVED, length, "displacement"),
        ):
            data = run.create_dataset(f"channels/{name}", data=(values / size).astype(kind), **storage)
            data.attrs.update(units=unit, quantity=measures, sample_rate=RATE)

    def conditions():
        run.create_dataset("conditions/pressure", data=2.0).attrs["units"] = "bar"

    def responses():
        frf = run.create_group("frf/drive")
        frf.attrs.update(units="m/s^2/N", response="pad z", reference="pad z")
        frf["frequency"], frf["response"] = _FRF["drive"]["frequency"], _FRF["drive"]["response"]

    def modes():
        run["modes/hammer/frequency"] = [100.0, 200.0]

    def heights():
        run.create_dataset("topography/pad", data=_HEIGHTS).attrs.update(units="um", pixel_size=1e-6)

    def friction():
        for name, value in {"friction": [0.4], "pressure": 1e6, "speed": 1.0}.items():
            run[f"friction/bench/{name}"] = value

    for k in order:
        (channels, conditions, responses, modes, heights, friction)[k]()


def _neutral_damaged(rng):
    return Trial("a.h5", damaged(rng, _stored(draw(rng, ("plainly", "packed", "in chunks")))))


@cache
def _stored(how):
    storage = {
        "plainly": {},
        "packed": {"chunks": True, "compression": "gzip"},
        "in chunks": {"chunks": (7,), "fletcher32": True},
    }[how]
    return _hdf5(lambda h5: _bench(h5, **storage))


_ODD = (
    None,
    "",
    "x",
    b"\xff\xfe",
    -1.0,
    0.0,
    float("nan"),
    1e308,
    [1.0, 2.0],
    [],
    "kNN",
    "m",
    "9**9 m",
    True,
    10**30,
    "10 Hz",
    [[1.0]],
    "dB re 20 uPa",
    "ü",
    "a" * 3000,
    np.array(["a"], object),
    np.float32(3),
    np.int8(-1),
    1j,
)


def _neutral_odd(rng):
    """Members and attributes lost, renamed, of other types and shapes."""

    def fill(h5):
        _bench(h5)
        for _ in range(int(rng.integers(1, 4))):
            nodes = []
            h5.visititems(lambda _, node, nodes=nodes: nodes.append(node))
            if not nodes:
                break       # all are lost
            node = draw(rng, nodes)
            draw(rng, (_attribute, _attribute, _lost, _renamed, _replaced))(rng, h5, node)

    return Trial("a.h5", _hdf5(fill), "odd members")


def _attribute(rng, h5, node):
    names = [*node.attrs, "units", "t0", "role", "point", "direction", "sample_rate", "pixel_size", "place"]
    name, value = draw(rng, names), draw(rng, _ODD)
    if value is None:
        node.attrs.pop(name, None)
    else:
        try:
            node.attrs[name] = value
        except (TypeError, ValueError, OverflowError):
            node.attrs[name] = 7


def _lost(rng, h5, node):
    del h5[node.name]


def _renamed(rng, h5, node):
    target = draw(
        rng, (f"{node.name}_2", f"/runs/{node.name.rpartition('/')[2]}", "/x", f"{node.name} ü", "/runs/a/../b")
    )
    if target not in h5:
        h5[target] = node
        del h5[node.name]


def _replaced(rng, h5, node):
    name = node.name
    del h5[name]
    value = draw(
        rng,
        (
            np.float64(1),
            np.zeros((2, 2)),
            np.zeros(0),
            "text",
            np.array([1j, 2]),
            np.full(3, np.nan),
            np.array([1e308, -1e308]),
            np.arange(3, dtype="i1"),
            np.array([b"a", b"b"]),
            None,
            np.zeros(3, [("r", "f8"), ("i", "i4")]),
            np.array([True, False]),
            h5py.Empty("f8"),
        ),
    )
    if value is None:
        h5.create_group(name)
    else:
        h5[name] = value


def _neutral_arranged(rng):
    force, length = draw(rng, (("N", 1.0), ("kN", 1e3))), draw(rng, (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)))
    kind, order = draw(rng, ("<f8", ">f8", "<f4")), rng.permutation(6)
    storage = draw(
        rng,
        (
            {},
            {"chunks": (5,)},
            {"chunks": (8,), "compression": "gzip", "shuffle": True},
            {"chunks": (8,), "compression": "lzf"},
            {"chunks": (9,), "fletcher32": True},
        ),
    )
    return Trial(
        "a.h5",
        _hdf5(lambda h5: _bench(h5, force, length, kind, order, **storage)),
        "units, order, storage",
        {},
        right(WHOLE),
        "read",
    )


TARGETS = (
    Target(
        "matlab",
        _matlab,
        lambda rng: (_matlab_damaged if rng.random() < 0.75 else _matlab_odd)(rng),
        (_matlab_arranged,),
        True,
    ),
    Target(
        "hdf5",
        _neutral,
        lambda rng: (_neutral_damaged if rng.random() < 0.6 else _neutral_odd)(rng),
        (_neutral_arranged,),
        True,
    ),
)
