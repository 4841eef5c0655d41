"""A friction table mu(pressure, speed, distance) in the words of other programs; SI units throughout.

Arrays: ``pressure`` (p,) Pa, ``speed`` (v,) m/s, ``distance`` (s,) m, ``friction`` (p, v, s).
"""

import numpy as np


def as_csv(pressure, speed, distance, friction, deviation):
    """One line per point; ``deviation`` (p, v, s): standard error."""
    head = "pressure [Pa],speed [m/s],distance [m],friction [1],friction_std [1]"
    rows = zip(*(a.ravel() for a in (*np.meshgrid(pressure, speed, distance, indexing="ij"), friction, deviation)),
               strict=True)
    return "\n".join([head, *(",".join(_number(v) for v in row) for row in rows)]) + "\n"


def as_abaqus(pressure, speed, distance, friction, warm=None):
    """Option *FRICTION of Abaqus: mu over slip rate and contact pressure; the sliding distance is field variable 1.
    Rows rise in pressure within a slip rate, in that within a temperature, and in that within a distance, as it asks.
    ``warm``: temperatures (t,) above that of reference and friction (t, p, v, s) there; None: without temperature."""
    told = "(none)" if warm is None else "of the bodies above reference K"
    lines = [f"** coefficient of friction, slip rate m/s, contact pressure Pa, temperature {told}, sliding distance m",
             "*FRICTION, DEPENDENCIES=1"]
    layers = [("", friction)] if warm is None else [(_number(t), f) for t, f in zip(
        warm.temperature, warm.friction, strict=True)]
    for s, way in enumerate(distance):
        for degrees, values in layers:
            for v, fast in enumerate(speed):
                lines += [f"{_number(values[p, v, s])}, {_number(fast)}, {_number(load)}, {degrees}, {_number(way)}"
                          for p, load in enumerate(pressure)]
    return "\n".join(lines) + "\n"


def as_adams(pressure, speed, distance, friction):
    """SPLINE statements of an Adams dataset (.adm), one a distance: x speed in m/s, one curve a pressure in Pa."""
    lines = ["! mu = CUBSPL or AKISPL(speed, pressure, id): x speed m/s, z contact pressure Pa, one spline a distance"]
    for s, way in enumerate(distance):
        lines += [f"! sliding distance {_number(way)} m", f"SPLINE/{s + 1}",
                  *_continued("X", speed), *(line for p, load in enumerate(pressure)
                                             for line in _continued("Y", [load, *friction[p, :, s]]))]
    return "\n".join(lines) + "\n"


def as_modelica(pressure, speed, distance, friction):
    """Text file of Modelica's CombiTable2Ds, which FMUs read: a table mu_1, mu_2, ... a distance, rows pressure in Pa,
    columns speed in m/s."""
    lines = ["#1"]
    for s, way in enumerate(distance):
        lines += [f"# sliding distance {_number(way)} m",
                  f"double mu_{s + 1}({len(pressure) + 1},{len(speed) + 1})",
                  " ".join(map(_number, [0.0, *speed])),
                  *(" ".join(map(_number, [load, *friction[p, :, s]])) for p, load in enumerate(pressure))]
    return "\n".join(lines) + "\n"


def _continued(name, values):
    """Lines of one argument of an Adams statement, continued by a comma at the begin, five values each."""
    texts = [_number(v) for v in values]
    parts = [", ".join(texts[k:k + 5]) for k in range(0, len(texts), 5)]
    return [f", {name} = {parts[0]}", *(f", {part}" for part in parts[1:])]


def _number(value):
    return f"{value:.10g}"
