"""Modes that recorded tones are compared with: stated by name, or of a product of another run."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError, store
from pipeline.products import ComplexModes, MatrixModes, ModalTest

#: roots whose frequencies differ by less than this share are one mode
_SAME = 5e-3
#: products that hold modes, and what it takes to read them
_READ = {"complex_modes": (ComplexModes, lambda product: _complex(product)),
         "matrix_modes": (MatrixModes, lambda product: _of_matrices(product)),
         "modal_test": (ModalTest, lambda product: _tested(product))}


@dataclass(frozen=True)
class NamedModes:
    """name : (mode,); frequency : (mode,) [Hz], rising; unstable : (mode,) 1 or 0, -1 where it is not known."""

    name: tuple
    frequency: np.ndarray
    unstable: np.ndarray

    def nearest(self, frequency, share):
        """(n,) index of the mode nearest to each ``frequency`` (n,) [Hz], -1 where none lies within ``share`` of it."""
        if not self.name:
            return np.full(len(frequency), -1)
        distance = abs(np.asarray(frequency)[:, None] / self.frequency - 1.0)
        return np.where(distance.min(axis=1) <= share, distance.argmin(axis=1), -1)

    def covered(self, band, share, unstable=False):
        """Share of a ``band`` (lowest, highest) [Hz], on a logarithmic axis, that lies within ``share`` of a mode: how
        often a tone that has nothing to do with them does. ``unstable``: of those that are predicted to be unstable."""
        kept = self.frequency[self.unstable == 1] if unstable else self.frequency
        reach, whole = float(np.log(band[0])), np.log(band[1] / band[0])
        total = 0.0
        for low, high in zip(np.log(kept * (1.0 - share)), np.log(kept * (1.0 + share)), strict=True):
            total += max(min(high, np.log(band[1])) - max(low, reach), 0.0)
            reach = max(reach, high)
        return float(total / whole)


def named_modes(stated, file, where):
    """NamedModes of ``stated`` {name: frequency in Hz} and of a product ``file`` (None: none).

    Raises ConfigError, with ``where``, for a file that is no product with modes.
    """
    rows = [(name, frequency, -1) for name, frequency in stated.items()]
    if file is not None:
        identity = store.identity(file)
        if identity is None or identity[0] not in _READ:
            raise ConfigError(where, f"a product {' or '.join(_READ)} of a run", f"{identity[0] if identity else file}",
                              "give its file, such as data/runs/brake/complex_modes.h5")
        product, modes = _READ[identity[0]]
        rows += modes(store.read(product, file))
    rows.sort(key=lambda row: row[1])
    return NamedModes(tuple(row[0] for row in rows), np.array([row[1] for row in rows], float),
                      np.array([row[2] for row in rows], int))


def _complex(product):
    """(name, frequency, unstable) of the modes: means over the operating points, unstable where it is so at any."""
    return _marked(np.abs(product.operating_root.imag).mean(axis=0), product.unstable_root)


def _of_matrices(product):
    """(name, frequency, unstable) of the modes of the first operating point, and of those that are unstable at any."""
    found = product.roots
    return _marked(np.abs(found.root[found.root_operating == 0].imag), found.unstable_root)


def _marked(angular, growing):
    """(name, frequency, unstable) of modes at ``angular`` frequencies, those of the ``growing`` roots marked."""
    frequency = angular[angular > 0.0] / (2.0 * np.pi)
    unstable = np.zeros(len(frequency), int)
    for squealing in np.abs(growing.imag) / (2.0 * np.pi):
        near = abs(frequency / squealing - 1.0) < _SAME if squealing > 0.0 else np.zeros(len(frequency), bool)
        if near.any():
            unstable[np.argmin(abs(frequency - squealing))] = 1
        elif squealing > 0.0:
            frequency, unstable = np.append(frequency, squealing), np.append(unstable, 1)
    order = np.argsort(frequency, kind="stable")
    return [(f"mode {k + 1}", float(frequency[i]), int(unstable[i])) for k, i in enumerate(order)]


def _tested(product):
    """(name, frequency, -1) of the modes of every run of a modal test."""
    return [(f"{run} {k + 1}", float(frequency), -1) for run, modes in product.runs.items()
            for k, frequency in enumerate(np.sort(modes.frequency))]
