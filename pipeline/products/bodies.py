"""FE bodies and the rows that tie them, joint by joint and contact by contact."""

from pipeline.contract import Array, count, product, quantity, text


@product(version=2)
class Body:
    """One elastic body: FE mesh, materials and real modes on its supports."""

    node: Array = quantity("m", "nodes xyz", "node positions")
    element: Array = count("elements vertex", "node numbers of each element, order of meshio")
    kind: Array = text("", "meshio cell type of the elements: hexahedron20 or hexahedron27")
    element_material: Array = count("elements", "row of the material table")
    material_name: Array = text("material", "material names")
    density: Array = quantity("kg/m^3", "material", "density")
    elasticity: Array = quantity("Pa", "material voigt strain", "elastic constants, order xx yy zz yz xz xy")
    loss_factor: Array = quantity("1", "material", "loss factor: lost per cycle over 2 pi times the strain energy")
    damping_ratio: Array = quantity("1", "", "damping ratio of the elastic modes of the body, beside its loss factors")
    frequency: Array = quantity("Hz", "mode", "natural frequencies of the body on its supports alone")
    shape: Array = quantity("1/kg^0.5", "mode nodes xyz", "mass-normalised mode shapes")
    supported: Array = count("support", "nodes held in all directions (rigid supports; none = empty)")


@product(version=1)
class Incidence:
    """Sparse rows: displacement of row i = sum of weight * u[body][node, axis]."""

    rows: Array = count("", "number of rows")
    row: Array = count("entry", "row of the entry")
    body: Array = count("entry", "body of the entry, index into Structure.body_name")
    node: Array = count("entry", "node of the entry")
    axis: Array = count("entry", "axis of the entry: 0, 1, 2 = x, y, z")
    weight: Array = quantity("1", "entry", "weight")
