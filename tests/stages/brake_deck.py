"""A brake as one Abaqus deck in mm-t-s: the program's meshes, but linings and backplates unlike and tied."""

import numpy as np

from pipeline.physics.fem.mesh import revolve
from pipeline.systems.disc_brake import caliper
from pipeline.systems.disc_brake_disc import disc_mesh

#: corners of the faces S1 to S6 of C3D20
_FACES = (0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)
#: what mesh_sets of a case says of the deck
SETS = {"disc": "DISC", "pad_outer": ["OUTER_LINING", "OUTER_PLATE"], "pad_inner": ["INNER_LINING", "INNER_PLATE"],
        "caliper": "CALIPER"}
MATERIALS = """*MATERIAL, NAME=IRON
*ELASTIC
120000., 0.27
*DENSITY
7.2e-9
*MATERIAL, NAME=NODULAR
*ELASTIC
170000., 0.275
*DENSITY
7.1e-9
*MATERIAL, NAME=STEEL
*ELASTIC
207000., 0.29
*DENSITY
7.82e-9
*MATERIAL, NAME=RESIN
*ELASTIC, TYPE=ENGINEERING CONSTANTS
6000., 6000., 1500., 0.2, 0.2, 0.2, 2500., 1200.,
1200.
*DENSITY
2.6e-9
*ORIENTATION, NAME=AXES
1., 0., 0., 0., 1., 0.
"""
_OF = {"DISC": "IRON", "CALIPER": "NODULAR", "PLATE": "STEEL", "LINING": "RESIN, ORIENTATION=AXES"}


def layer(pad, cells, low, high, side):
    """A layer of a pad from height ``low`` to ``high`` on a ``side``; ``cells`` radial, angular and through it."""
    line = np.linspace(low, high, cells[2] + 1)
    return revolve(np.linspace(pad.inner_radius, pad.outer_radius, cells[0] + 1),
                   np.linspace(-pad.angle / 2, pad.angle / 2, cells[1] + 1), line if side > 0 else -line[::-1])


def meshes(settings, lining=(3, 6, 1), plate=(4, 5, 1)):
    """{name: mesh} of a brake without bracket and piston."""
    pad, face = settings.pad, settings.disc.ring_thickness / 2
    back = face + pad.lining_thickness
    made = {"DISC": disc_mesh(settings.disc), "CALIPER": caliper(settings).mesh}
    for name, side in (("OUTER", 1), ("INNER", -1)):
        made[f"{name}_LINING"] = layer(pad, lining, face, back, side)
        made[f"{name}_PLATE"] = layer(pad, plate, back, back + pad.backplate_thickness, side)
    return made


def deck(settings, lift=0.0, **cells):
    """Text of the deck; ``lift``: of the outer pad in m."""
    lines, first, firstel, surfaces = ["*HEADING", "a brake"], 0, 0, []
    for name, mesh in meshes(settings, **cells).items():
        node = 1e3 * (mesh.node + (0, 0, lift * name.startswith("OUTER")))
        lines += ["*NODE", *(f"{first + k}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(node, 1))]
        lines.append(f"*ELEMENT, TYPE=C3D20, ELSET={name}")
        for k, nodes in enumerate(mesh.element + first + 1, firstel + 1):
            values = [str(value) for value in (k, *nodes)]
            lines += [", ".join(values[:11]) + ",", ", ".join(values[11:])]
        if name.endswith(("LINING", "PLATE")):
            surfaces += surface(name, mesh, firstel, name.startswith("OUTER") == name.endswith("LINING"))
        lines.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={_OF[name.split('_')[-1]]}")
        first, firstel = first + len(mesh.node), firstel + len(mesh.element)
    lines += ["*ELSET, ELSET=LINING", "OUTER_LINING, INNER_LINING", *surfaces, MATERIALS]
    lines += [line for pad in ("OUTER", "INNER") for line in (
        f"*TIE, NAME={pad}_GLUE, POSITION TOLERANCE=0.1", f"{pad}_LINING_FACE, {pad}_PLATE_FACE")]
    return "\n".join([*lines, "*STEP", "*FREQUENCY", "20,", "*END STEP", ""])


def surface(name, mesh, first, top):
    """*SURFACE of the elements' faces at the top, or else at the bottom, of a mesh."""
    z = mesh.node[:, 2]
    level = z.max() if top else z.min()
    lines = [f"*SURFACE, NAME={name}_FACE, TYPE=ELEMENT"]
    for k, nodes in enumerate(mesh.element, first + 1):
        lines += [f"{k}, S{side}" for side, corner in enumerate(_FACES, 1)
                  if (abs(z[nodes[list(corner)]] - level) < 1e-9).all()]
    return lines
