"""Mutations: seeded, and of every kind that they promise."""

import json

import numpy as np
import pytest

from tests.fuzz.documents import reshaped
from tests.fuzz.mutation import damaged, garbled

TEXT = b"time,force,moved\n" + b"".join(b"%d,%d.5,1e-3\n" % (k, k) for k in range(20))


@pytest.mark.parametrize(
    "change, given", [(damaged, bytes(range(256)) * 4), (garbled, TEXT), (damaged, b""), (garbled, b"")]
)
def test_bytes_and_texts(change, given):
    made = [change(np.random.default_rng(k), given) for k in range(200)]
    assert made == [change(np.random.default_rng(k), given) for k in range(200)]
    if given:
        assert len(set(made)) > 150
        assert any(len(m) < len(given) / 2 for m in made) and any(len(m) > len(given) for m in made)


def test_documents():
    given = {"a": {"b": [1, 2.5, "3 mm"], "c": "text"}, "d": None}
    before = json.dumps(given)
    made = [repr(reshaped(np.random.default_rng(k), given)) for k in range(300)]
    assert json.dumps(given) == before and len(set(made)) > 200
    assert made == [repr(reshaped(np.random.default_rng(k), given)) for k in range(300)]
    assert any("'a'" not in m for m in made) and any("nan" in m for m in made)
    reshaped(np.random.default_rng(0), [])
