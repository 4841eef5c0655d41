"""FE bodies and the rows that tie them, joint by joint and contact by contact; their update by a modal test."""

from pipeline.contract import Array, count, parts, product, quantity, text


@product(version=1)
class MeshTie:
    """Springs that hold two unlike meshes of one body together: relative means over the nodes of a surface."""

    row: Array = count("entry", "row of the entry")
    node: Array = count("entry", "node of the entry")
    weight: Array = quantity("1", "entry", "weight; alike in all three directions")
    area: Array = quantity("m^2", "tied", "area of the surface for which a row stands")
    stiffness: Array = quantity("Pa/m", "", "stiffness per area, in each direction")
    share: Array = quantity("1", "", "part of the first surface that meets the second")


@product(version=3)
class Body:
    """One elastic body: FE mesh, materials and real modes on its supports."""

    node: Array = quantity("m", "nodes xyz", "node positions")
    element: Array = count("elements vertex", "node numbers of each element, order of meshio")
    kind: Array = text("", "meshio cell type of the elements, or mixed: rows of shorter cells repeat"
                              " their first vertex")
    element_material: Array = count("elements", "row of the material table")
    material_name: Array = text("material", "material names")
    density: Array = quantity("kg/m^3", "material", "density")
    elasticity: Array = quantity("Pa", "material voigt strain", "elastic constants, order xx yy zz yz xz xy")
    loss_factor: Array = quantity("1", "material", "loss factor: lost per cycle over 2 pi times the strain energy")
    damping_ratio: Array = quantity("1", "", "damping ratio of the elastic modes of the body, beside its loss factors")
    frequency: Array = quantity("Hz", "mode", "natural frequencies of the body on its supports alone")
    shape: Array = quantity("1/kg^0.5", "mode nodes xyz", "mass-normalised mode shapes")
    supported: Array = count("support", "nodes held in all directions (rigid supports; none = empty)")
    ties: dict[str, MeshTie] = parts("ties of unlike meshes of the body", empty=True)


@product(version=1)
class Incidence:
    """Sparse rows: displacement of row i = sum of weight * u[body][node, axis]."""

    rows: Array = count("", "number of rows")
    row: Array = count("entry", "row of the entry")
    body: Array = count("entry", "body of the entry, index into Structure.body_name")
    node: Array = count("entry", "node of the entry")
    axis: Array = count("entry", "axis of the entry: 0, 1, 2 = x, y, z")
    weight: Array = quantity("1", "entry", "weight")


@product(version=2)
class ModelUpdate:
    """Values of a body or a brake that its modal test asks for, and the pairs of modes that they come from."""

    run: Array = text("", "run of the modal test")
    body: Array = text("", "body of the brake, or assembly")
    parameter: Array = text("parameter", "names of the values with their sections, as in disc.young")
    unit: Array = text("parameter", "their SI units")
    before: Array = quantity("1", "parameter", "values stated, in the unit that `unit` names")
    before_spread: Array = quantity("1", "parameter", "standard deviation of the logarithm that was stated")
    after: Array = quantity("1", "parameter", "values that the test asks for")
    after_spread: Array = quantity("1", "parameter", "standard deviation of their logarithm")
    correlation: Array = quantity("1", "parameter other", "correlation of the errors of the logarithms")
    mesh_spread: Array = quantity("1", "parameter", "part of that standard deviation by the error of the mesh; 0 where it"
                                                    " was not estimated")
    mesh_checked: Array = count("", "1 where the error of the mesh was estimated on a finer one")
    model_error: Array = quantity("1", "", "relative error of natural frequencies that no value mends")
    model_error_spread: Array = quantity("1", "", "standard deviation of its logarithm")
    measured_frequency: Array = quantity("Hz", "measured", "natural frequencies of the test")
    measured_std: Array = quantity("Hz", "measured", "their standard deviations")
    pair: Array = count("measured", "group of the model that a measured mode is, -1 for none")
    rival: Array = count("measured", "group that it would be otherwise, -1 for none")
    odds: Array = quantity("1", "measured", "logarithm of the odds of the pair over the rival; inf where there is none")
    clear: Array = count("measured", "1 where the pair counts: beyond doubt")
    likeness: Array = quantity("1", "measured cluster", "modal assurance criterion of measured shape and group; 0 where"
                                                        " no point is known")
    frequency_before: Array = quantity("Hz", "cluster", "mean natural frequency of each group of the model as stated")
    frequency: Array = quantity("Hz", "cluster", "the same of the updated model")
    frequency_spread: Array = quantity("1", "cluster", "its relative standard deviation by the values")
    members: Array = count("cluster", "modes of each group: 2 for a pair of a disc")
    diameters: Array = count("cluster", "nodal diameters of a disc, -1 of other bodies")
    mover: Array = text("cluster", "body that moves most in each group")
    mover_share: Array = quantity("1", "cluster", "its share of the kinetic energy")
    place: Array = text("seen", "measured points that the shapes are compared at")
    reference: Array = text("seen", "their references")
    agreement: Array = quantity("1", "seen", "correlation of measured and computed motion over the pairs: its square is"
                                             " the COMAC, a sensor that is mounted in reverse has a negative one")
    distance: Array = quantity("m", "seen", "distance of the node that stands for a point")
