"""Modes as a universal file: units (164), nodes (2411), elements (2412) and one data set 55 for each mode.

Complex modes are of analysis type 3 (complex eigenvalue, displacement) with the eigenvalue s = growth + i omega; modes
of a body of type 2 (normal mode) with frequency, modal mass and damping ratio. Numbers of shapes have six digits, as
the format holds. Elements are drawn by their corners; all nodes have data. The colour of a node is the number of its
body.
"""

import numpy as np

from pipeline.exports.run_products import refuse_existing

#: meshio cell type -> descriptor of the linear element of universal files, its corners
_ELEMENTS = {"quad": (94, 4), "quad8": (94, 4), "hexahedron": (115, 8), "hexahedron20": (115, 8),
             "hexahedron27": (115, 8), "tetra10": (111, 4), "wedge15": (112, 6)}
_NORMAL, _COMPLEX = 2, 3
#: codes of data set 55: structural model, vector of three translations, displacement, values
_STRUCTURAL, _TRANSLATIONS, _DISPLACEMENT, _REAL, _PAIRS = 1, 2, 8, 2, 5
_LINE = 80


def write_universal(modes, path, source):
    """Write a ModeSet to a new universal file; ``source``: what it is from, in words.

    Raises ConfigError where the file exists.
    """
    refuse_existing(path)
    with open(path, "x", encoding="ascii", errors="replace", newline="\n") as file:
        file.writelines((_units(), _nodes(modes), _elements(modes)))
        file.writelines(_mode(modes, k, source) for k in range(len(modes.root)))


def _set(kind, body):
    """Text of one data set of the ``body`` lines."""
    return f"    -1\n{kind:6d}\n" + "".join(f"{line}\n" for line in body) + "    -1\n"


def _units():
    """SI: all factors are 1, temperatures count from 0 K."""
    numbers = "".join(f"{value:25.16E}" for value in (1.0, 1.0, 1.0)), f"{0.0:25.16E}"
    return _set(164, [f"{1:10d}{'SI: Meter (newton)':<20}{1:10d}", *(n.replace("E", "D") for n in numbers)])


def _nodes(modes):
    lines = []
    for number, (place, body) in enumerate(zip(modes.node, modes.body, strict=True), 1):
        lines += [f"{number:10d}{1:10d}{1:10d}{body + 1:10d}", "".join(f"{x:25.16E}" for x in place).replace("E", "D")]
    return _set(2411, lines)


def _elements(modes):
    lines, number = [], 0
    for kind, cells in modes.cells:
        descriptor, corners = _ELEMENTS[kind]
        for cell in cells[:, :corners]:
            number += 1
            lines += [f"{number:10d}{descriptor:10d}{1:10d}{1:10d}{modes.body[cell[0]] + 1:10d}{corners:10d}",
                      "".join(f"{node + 1:10d}" for node in cell)]
    return _set(2412, lines) if lines else ""


def _mode(modes, k, source):
    """Data set 55 of one mode."""
    root, shape = modes.root[k], modes.shape[k]
    titles = modes.about[k], source, "NONE", modes.scale, "NONE"
    parameters = ((_STRUCTURAL, _COMPLEX, _TRANSLATIONS, _DISPLACEMENT, _PAIRS, 3) if modes.is_complex else
                  (_STRUCTURAL, _NORMAL, _TRANSLATIONS, _DISPLACEMENT, _REAL, 3))
    numbers = ((root.real, root.imag, 0.0, 0.0, 0.0, 0.0) if modes.is_complex else
               (modes.frequency[k], modes.modal_mass, modes.damping_ratio[k], 0.0))
    heads = [*(f"{title[:_LINE]:<{_LINE}}" for title in titles), "".join(f"{p:10d}" for p in parameters),
             "".join(f"{p:10d}" for p in (2, len(numbers), 1, k + 1)), _real(numbers)]
    values = np.stack((shape.real, shape.imag), axis=-1).reshape(len(shape), -1) if modes.is_complex else shape
    lines = [text for number, row in enumerate(values.tolist(), 1) for text in (f"{number:10d}", _real(row))]
    return _set(55, heads + lines)


def _real(numbers):
    return "".join(f"{number:13.5E}" for number in numbers)
