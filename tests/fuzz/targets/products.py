"""Products and the list of what was checked in a run folder."""

import io
import json
import tempfile
from functools import cache
from pathlib import Path

import h5py
import numpy as np

from pipeline.cli.inspect import describe
from pipeline.contract import store
from pipeline.contract.integrity import checksum, seen, verify
from tests.contract.toy.products import Inner, Source
from tests.fuzz.documents import reshaped
from tests.fuzz.mutation import damaged, draw, garbled
from tests.fuzz.targets.vectors import _attribute, _lost, _renamed, _replaced
from tests.fuzz.trial import Target, Trial, difference

_VALUES = {
    "time": np.linspace(0, 1, 6),
    "signal": np.arange(12.0).reshape(2, 6),
    "root": np.array([1 + 2j, -3j]),
    "flag": np.array([0, 1]),
    "scale": 3.5,
}
_PROVENANCE = {
    "stage": "source",
    "companions": "{}",
    "fingerprint": "{}",
    "settings": "{}",
    "packages": '{"numpy": "2"}',
    "kernels": "[]",
}


@cache
def _product():
    """Bytes of a product with its checksum."""
    item = Source(**_VALUES, label=["a", "b"], inner=Inner(position=np.zeros((2, 3))))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "source.h5"
        store.write(item, path, _PROVENANCE)
        return path.read_bytes()


def _bare():
    return _product()[: -checksum._BEHIND]


def _sealed(content):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "p"
        path.write_bytes(content)
        checksum.seal(path)
        return path.read_bytes()


def _read(path):
    found = store.read(Source, path)
    store.identity(path)
    verify.verify(path.parent)
    return {name: getattr(found, name) for name in _VALUES}


def _described(path):
    return "\n".join(describe(path))


def _unsealed(rng):
    """Whatever byte of a product is other than it was written: it is refused before HDF5 opens the file."""
    content = _product()
    while content == _product():
        content = damaged(rng, content)
    return Trial("source.h5", content, "damaged product", must="refuse")


def _same(value):
    return difference(value, _VALUES)


def _whole(rng):
    return Trial("source.h5", _product(), "product as it was written", check=_same, must="read")


def _resealed(rng):
    """Damaged, and then sealed by whoever damaged it."""
    return Trial("source.h5", _sealed(damaged(rng, _bare())), "damaged and sealed again")


def _edited(rng):
    stream = io.BytesIO(_bare())
    with h5py.File(stream, "r+") as h5:
        for _ in range(int(rng.integers(1, 4))):
            nodes = [h5]
            h5.visititems(lambda _, node, nodes=nodes: nodes.append(node))
            node = draw(rng, nodes)
            change = draw(rng, (_attribute, _attribute, _lost, _renamed, _replaced, _note))
            if node.name != "/" or change in (_attribute, _note):
                change(rng, h5, node)
    return Trial("source.h5", _sealed(stream.getvalue()), "edited and sealed again")


def _note(rng, h5, node):
    """An attribute of identity or provenance of another type or content."""
    name = draw(rng, ("product", "version", "content", "companions", "fingerprint", "units", "long_name", "settings"))
    home = h5 if name in ("product", "version", "content") else h5.get("provenance", h5)
    home.attrs[name] = draw(
        rng,
        (
            "",
            "{",
            "[1]",
            '{"a": 1}',
            '{"../x": "0"}',
            7,
            1.5,
            np.arange(3),
            b"\xff",
            "source",
            "x" * 5000,
            '{"fingerprint": []}',
            "[" * 3000,
            "nan",
        ),
    )


def _listed(path):
    """What a run folder with this list says of its product, and of one that was changed since."""
    folder = path.parent
    (folder / "source.h5").write_bytes(_product())
    right = seen.flaw(folder / "source.h5")
    (folder / "source.h5").write_bytes(_product()[:-1] + b"\0")
    wrong = seen.flaw(folder / "source.h5")
    seen.differs(folder / "source.h5", "0" * 64)
    (folder / "source.h5").unlink()
    return right, wrong


def _list_damaged(rng):
    entries = {"source.h5": [len(_product()), 1, 2, ""], "a.csv": [3, 4, 5, "0" * 64]}
    content = json.dumps(reshaped(rng, entries), default=str).encode()
    return Trial(
        seen.LIST,
        garbled(rng, content) if rng.random() < 0.5 else content,
        check=lambda value: "" if value[0] == "" and value[1] else f"{value}",
        must="read",
    )


def _shown(rng):
    return Trial(
        "source.h5",
        _product(),
        "product as it was written",
        must="read",
        check=lambda text: (
            "" if ("source version 1" in text and "label (channel: 2)" in text and "0 .. 11 Pa" in text) else text
        ),
    )


TARGETS = (
    Target("product", _read, lambda rng: draw(rng, (_unsealed, _resealed, _edited))(rng), (_whole, _unsealed), True),
    Target("inspect", _described, lambda rng: draw(rng, (_unsealed, _resealed, _edited))(rng), (_shown,), True),
    Target("run list", _listed, _list_damaged),
)
