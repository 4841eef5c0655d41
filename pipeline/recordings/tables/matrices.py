"""Columns of matrices by name, and what the variables of a MATLAB file say of the sampling."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError, first_of

#: most columns of a matrix of samples: others are images or results
_COLUMNS = 256
_INCREMENT, _START = ".x_values.increment", ".x_values.start_value"
_RATES = re.compile(r"(.*[._])?(fs|f_?samp\w*|sampl\w*_?(rate|freq\w*)|rate)", re.IGNORECASE)
_INTERVALS = re.compile(r"(.*[._])?(dt|ts|tinterval|increment|delta_?t|sampl\w*_?(time|interval|period))",
                        re.IGNORECASE)


def vectors(variables, path, base=1):
    """{name: (sample,)} of the numeric ``variables`` {name: array}: vectors, and columns of matrices.

    Samples lie along the longer axis of a matrix. Its columns are data(:,1), data(:,2), ..., its rows data(1,:), ...;
    ``base`` 0: data[:,0], ... Raises ConfigError where there are none.
    """
    made = {}
    for name, value in variables.items():
        value = np.asarray(value)
        if value.dtype.kind not in "fiub":
            continue
        if value.ndim < 2 or (value.ndim == 2 and 1 in value.shape):
            made[name] = _numbers(value.ravel())
        elif value.ndim == 2 and 0 < min(value.shape) <= _COLUMNS:
            down, brackets = value.shape[0] >= value.shape[1], "()" if base else "[]"
            for k, column in enumerate(value.T if down else value):
                inside = f":,{k + base}" if down else f"{k + base},:"
                made[f"{name}{brackets[0]}{inside}{brackets[1]}"] = _numbers(column)
    if not made:
        raise ConfigError(path, "a vector of numbers", f"{', '.join(variables) or 'no variables'}",
                          "save samples and times as numbers: save('a.mat', 't', 'x') in MATLAB")
    return made


def _numbers(values):
    return values.astype(np.float32 if values.dtype == np.float32 else float)


def time_axes(columns):
    """{column: (rate in Hz, begin in s)} of structures with x_values and y_values, as Simcenter Testlab writes them."""
    axes = {}
    for key in columns:
        if key.endswith(_INCREMENT) and len(columns[key]) == 1 and columns[key][0] > 0:
            prefix = key.removesuffix(_INCREMENT)
            start = columns.get(prefix + _START, [0.0])
            axes |= {name: (float(1.0 / columns[key][0]), float(start[0]))
                     for name in columns if name.startswith(f"{prefix}.y_values.values")}
    return axes


def stated_rates(columns):
    """What scalar columns say of the sampling, as a remedy; '' where none does."""
    scalars = {name: float(values[0]) for name, values in columns.items() if len(values) == 1 and values[0] > 0}
    stated = [f"{name} = {value:g}, which may mean sample_rate: {value if _RATES.fullmatch(name) else 1 / value:.8g} Hz"
              for name, value in scalars.items() if _RATES.fullmatch(name) or _INTERVALS.fullmatch(name)]
    return f"; the file holds {first_of(stated, 3)}" if stated else ""
