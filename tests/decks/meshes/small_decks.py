"""Decks of one or two elements, and of whole meshes, written without what is tested."""

import numpy as np

from pipeline.physics.fem.mesh import block, revolve
from pipeline.physics.fem.reference_cells import by_kind
from tests.physics.fem.mixed_meshes import cut

#: order in which each program writes the nodes of a cell, as rows of meshio's
NASTRAN = {"hexahedron20": [*range(12), 16, 17, 18, 19, 12, 13, 14, 15], "tetra10": range(10),
           "wedge15": [*range(9), 12, 13, 14, 9, 10, 11]}
_CARD = {"hexahedron20": "CHEXA", "tetra10": "CTETRA", "wedge15": "CPENTA"}
_TYPE = {"hexahedron20": "C3D20", "tetra10": "C3D10", "wedge15": "C3D15", "hexahedron27": "C3D27"}
#: nodes of C3D27, centre before the middles of faces 1 to 6, by rows of meshio's
_C3D27 = [*range(20), 26, 24, 25, 22, 21, 23, 20]
#: SOLID186 of a wedge and of a tetrahedron, by rows of meshio's
SOLID186 = {"hexahedron20": range(20), "wedge15": [0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14],
             "tetra10": [0, 1, 2, 2, 3, 3, 3, 3, 4, 5, 2, 6, 3, 3, 3, 3, 7, 8, 9, 9]}
#: cast iron of the decks, in mm-t-s
YOUNG, POISSON, DENSITY = 110000.0, 0.26, 7.1e-9


def ring(kind="hexahedron20", cells=16):
    """A ring of 100 to 150 mm and 20 mm height, in metres."""
    lines = np.array([0.1, 0.15]), np.linspace(0, 2 * np.pi, cells + 1), np.array([0, 0.02])
    return cut(revolve(*lines, kind="hexahedron27"), kind)


def cube(kind="hexahedron20"):
    """A cube of 100 mm in metres, of 2 x 2 x 2 hexahedra or cut into other cells."""
    return cut(block(*[np.linspace(0, 0.1, 3)] * 3, kind="hexahedron27"), kind)


def cells(mesh):
    """Yield (number from 1, kind, numbers of nodes from 1 in the order of meshio)."""
    for kind, rows, nodes in by_kind(mesh.kind, mesh.element):
        for row, each in zip(rows, nodes, strict=True):
            yield row + 1, kind, each + 1


def abaqus(mesh, scale=1e3, more=""):
    """Text of an Abaqus deck: nodes in mm, 10 numbers in a line of elements, one set ``ALL``, and ``more``."""
    lines = ["*HEADING", "a body", "*NODE, NSET=NALL"]
    lines += [f"{k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(scale * mesh.node, 1)]
    known = None
    for number, kind, nodes in cells(mesh):
        lines += [f"*Element, type={_TYPE[kind]}, ELSET=all"] * (kind != known)
        known, values = kind, [number, *nodes[_C3D27 if len(nodes) == 27 else slice(None)]]
        lines += [", ".join(map(str, values[k:k + 10])) + "," * (k + 10 < len(values))
                  for k in range(0, len(values), 10)]
    return "\n".join([*lines, more]) + "\n"


IRON = f"*SOLID SECTION, ELSET=ALL, MATERIAL=Iron\n*MATERIAL, NAME=iron\n*ELASTIC\n{YOUNG}, {POISSON}\n" \
       f"*DENSITY\n{DENSITY},\n"
#: the same for Nastran: property 1
NASTRAN_IRON = f"PSOLID,1,7\nMAT1,7,{YOUNG},,{POISSON},{DENSITY}\n"


def nastran(mesh, form="fixed", scale=1e3, more="", end="ENDDATA\n"):
    """Text of a Nastran deck in fields of a ``form``: fixed, marked (fixed, with marks of continuations), large, free
    or open (free, continuations without marks)."""
    nodes = (scale * mesh.node).round(3)
    rows = [("GRID", k, "", *(f"{x:.8g}" for x in position)) for k, position in enumerate(nodes, 1)]
    rows += [(_CARD[kind], number, 1, *nodes[list(NASTRAN[kind])]) for number, kind, nodes in cells(mesh)]
    return "\n".join(["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "$ a body", *(_card(form, row) for row in rows),
                      more]) + end


def _card(form, row):
    """Lines of one card."""
    (name, *values), count = row, 4 if form == "large" else 8
    parts = [list(map(str, values[k:k + count])) for k in range(0, len(values), count)]
    lines = []
    for k, part in enumerate(parts):
        last = k == len(parts) - 1
        if form in ("free", "open"):
            mark = "" if form == "open" else "+"
            lines.append(",".join([name if k == 0 else mark, *part, *([] if last else [mark])]))
        elif form == "large":
            begin = f"{name}*" if k == 0 else "*"
            lines.append(f"{begin:8}" + "".join(f"{each:>16}" for each in part) + "*" * (not last))
        else:
            mark = f"+{values[0]}{'ABC'[k]}" if form == "marked" and not last else ""
            begin = name if k == 0 else (f"+{values[0]}{'ABC'[k - 1]}" if form == "marked" else "")
            lines.append(f"{begin:8}" + "".join(f"{each:8}" for each in part) + mark)
    return "\n".join(lines)


#: the same for Ansys: material 1
ANSYS_IRON = f"MPTEMP,R5.0, 1, 1,  0.0,\nMPDATA,R5.0, 1,EX  ,     1, 1,  {YOUNG}    ,\nMP,PRXY,1,{POISSON}\n" \
             f"MPDATA,R5.0, 1,DENS,     1, 1,  {DENSITY}    ,\n"


def ansys(mesh, tetra=187, scale=1e3, more=ANSYS_IRON, system=0):
    """Text of an Ansys archive: SOLID186, of which wedges and tetrahedra are collapsed ones unless ``tetra`` is 187."""
    nodes = [f"{k:9d}{0:9d}{0:9d}" + "".join(f"{x:21.13E}" for x in position).rstrip()
             for k, position in enumerate(scale * mesh.node, 1)]
    rows = []
    for number, kind, each in cells(mesh):
        own = kind == "tetra10" and tetra == 187
        chosen = list(each) if own else [each[k] for k in SOLID186[kind]]
        values = [1, 2 if own else 1, 1, 1, system, 0, 0, 0, len(chosen), 0, number, *chosen]
        rows += ["".join(f"{v:9d}" for v in values[:19]), "".join(f"{v:9d}" for v in values[19:])]
    count = len(mesh.element)
    return "\n".join([
        "/COM,ANSYS RELEASE 2023 R1", "/PREP7", "ET,        1,186", "ETBLOCK,        1,        1", "(2i9,19a9)",
        "        2      187", "       -1", f"NBLOCK,6,SOLID,{len(nodes):9d},{len(nodes):9d}", "(3i9,6e21.13e3)", *nodes,
        "N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{count:9d},{count:9d}", "(19i9)", *rows, "       -1",
        "CMBLOCK,RIM     ,NODE,       3  ! users node component", "(8i10)", "         1         4        -7",
        "CMBLOCK,BODY,ELEM,       2", "(8i10)", f"         1{-count:10d}", more, "FINISH", ""])
