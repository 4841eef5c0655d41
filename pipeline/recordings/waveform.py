"""One channel of a file as the file has it, before the case says what it means."""

from dataclasses import dataclass
from importlib import import_module

import numpy as np

from pipeline.contract.errors import ConfigError

#: units as measurement systems write them, and as they are read; none where nothing is stated
SPELT = {"NONE": "", "none": "", "-": "", "?": ""}


@dataclass(frozen=True)
class Waveform:
    """``values`` (sample,) in ``unit`` ('': none told), at ``rate`` in Hz (None: none told), from ``begin`` in s."""

    values: np.ndarray
    unit: str = ""
    rate: float | None = None
    begin: float = 0.0


def library(module, package, path):
    """The ``module`` of a ``package`` that reads files like ``path``; ConfigError where it is not installed."""
    try:
        return import_module(module)
    except ImportError:
        raise ConfigError(path, f"the package {package}, which reads such files", "none",
                          "install it: pip install 'brakechain[bench]'") from None
