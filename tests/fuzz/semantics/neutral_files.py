"""Planted facts in plain HDF5 by h5py: units, rates, begins, gaps and conditions as attributes state them."""

import io

import h5py
import numpy as np

from tests.fuzz.mutation import draw
from tests.fuzz.semantics.labels import LABELS
from tests.fuzz.semantics.planted import Meant, Planted, column, gaps
from tests.fuzz.trial import Trial

_RATES = (10.0, 50.0, 256.0, 1000.0, 25600.0, 44100.0, 51200.0)


def hdf5(rng):
    """Runs of channels, each with its unit, quantity, rate and begin, and conditions."""
    stream, meant, conditions = io.BytesIO(), {}, {}
    whole = [one for one in LABELS if not one.level and not one.stated]
    with h5py.File(stream, "w") as h5:
        for r in range(int(rng.integers(1, 3))):
            run = h5.create_group(f"runs/r{r}")
            meant[f"r{r}"] = {}
            for k in range(int(rng.integers(1, 4))):
                one = column(rng, int(rng.integers(40, 200)), True, (1.0,), 0.03)
                one = gaps(rng, one)[0] if rng.random() < 0.25 else one
                rate, begin = float(draw(rng, _RATES)), float(draw(rng, (0.0, 0.5, -0.25, 12.125)))
                kind = draw(rng, ("<f8", ">f8", "<f4"))
                node = run.create_dataset(f"channels/c{k}", data=one.numbers.astype(kind))
                node.attrs.update(units=one.label, quantity=one.measured, sample_rate=rate)
                if begin or rng.random() < 0.5:
                    node.attrs["t0"] = begin
                meant[f"r{r}"][f"c{k}"] = one.planted(rate, begin, exact=1e-5 if kind == "<f4" else 1e-6)
            label, value = draw(rng, whole), float(np.round(rng.normal() * 10, 3))
            run.create_dataset("conditions/state", data=value).attrs["units"] = label.text
            conditions[f"r{r}"] = (label.size * value + label.zero, label.si, label.text in ("g", "[g]", "mg"))
    offset = float(draw(rng, (0.0, 0.0, 1.5, -2.25)))
    stated = {"kind": "hdf5"} | ({"offset": f"{offset!r} s"} if offset else {})
    moved = {run: {key: Planted(one.samples, one.si, one.rate, one.begin + offset, one.exact, asked=one.asked)
                   for key, one in channels.items()} for run, channels in meant.items()}
    must = "either" if any(one.asked for channels in moved.values() for one in channels.values()) else "read"
    return Trial("a.h5", stream.getvalue(), "attributes of plain HDF5", {"files": [stated]},
                 Stated(moved, conditions=conditions), must)


class Stated(Meant):
    """Meant with ``conditions`` {run: (value, SI unit, whether a mass may be meant)}."""

    def __init__(self, runs, conditions):
        super().__init__(runs)
        object.__setattr__(self, "conditions", conditions)

    def __call__(self, value):
        for run, (true, si, mass) in self.conditions.items():
            found = value["runs"].get(run, {}).get("conditions", {}).get("state")
            if found is None or (str(found["unit"]) != si and not mass) or (
                    not mass and not np.isclose(float(np.ravel(found["value"])[0]), true, rtol=1e-9)):
                return f"{run}: condition {found} for {true} {si}"
        return super().__call__(value)
