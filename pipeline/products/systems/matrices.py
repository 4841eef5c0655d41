"""A system that is given as matrices, and its complex modes over speed and friction."""

from pipeline.contract import Array, count, part, parts, product, quantity, text


@product(version=1)
class MatrixTerm:
    """A sparse matrix that is multiplied by a sum of a speed^m friction^n, both over those of the matrices."""

    kind: Array = text("", "what it is: mass, damping, stiffness or loss, the imaginary part of the stiffness")
    times: Array = text("", "what it is multiplied by, in words")
    source: Array = text("", "name of its file")
    row: Array = count("entry", "row of the entry")
    column: Array = count("entry", "column of the entry")
    value: Array = quantity("1", "entry", "entries, in the units of the files, which are consistent and have seconds")
    coefficient: Array = quantity("1", "summand", "factors a")
    speed_power: Array = count("summand", "powers m of the speed")
    friction_power: Array = count("summand", "powers n of the coefficient of friction")


@product(version=2)
class Matrices:
    """s^2 M + s C + K + i H, each a sum of terms."""

    size: Array = count("", "degrees of freedom")
    node: Array = count("freedom", "node of each, empty where the files merely count them")
    direction: Array = count("freedom", "direction of each, 1 to 6, of the node")
    reference_speed: Array = quantity("rad/s", "", "speed for which the terms are given")
    constrained: Array = count("constrained", "degrees of freedom that were taken out, since constraints hold them, counted"
                                              " from 0 among all of the files")
    remark: Array = text("remark", "what was taken out, and what was guessed of the files")
    terms: dict[str, MatrixTerm] = parts("terms by name")


@product(version=1)
class RootsOfMatrices:
    """Roots at the operating points of one friction, those that grow with what moves them."""

    speed: Array = quantity("rad/s", "operating", "speeds of the operating points")
    searched: Array = quantity("Hz", "", "half the width about the imaginary axis within which no root is missed")
    root_operating: Array = count("root", "operating point of each root")
    root: Array = quantity("1/s", "root", "roots up to the highest frequency, by frequency", complex)
    unstable_operating: Array = count("unstable", "operating point of each unstable root")
    unstable_root: Array = quantity("1/s", "unstable", "roots that grow", complex)
    residual: Array = quantity("1", "unstable", "what a mode leaves of its equation, over the sum of its terms")
    per_term: Array = quantity("1/s", "unstable term", "change of the root per relative change of each term", complex)
    per_speed: Array = quantity("1/s", "unstable", "change of the root per relative change of the speed", complex)
    per_friction: Array = quantity("1/s", "unstable", "change of the root per relative change of friction", complex)


@product(version=1)
class MatrixModes:
    """Complex modes of a system of matrices: at its operating points, and over speed and friction."""

    friction: Array = quantity("1", "", "coefficient of friction over that of the matrices")
    highest: Array = quantity("Hz", "", "highest frequency that was searched")
    neutral: Array = quantity("1", "", "growth below this share of the angular frequency counts as none")
    term: Array = text("term", "terms by name")
    roots: RootsOfMatrices = part("roots at the operating points")
    map_speed: Array = quantity("rad/s", "map_speed", "speeds of the map")
    map_friction: Array = quantity("1", "map_friction", "coefficients of friction of the map, over that of the matrices")
    map_growth: Array = quantity("1/s", "map_speed map_friction", "largest growth rate")
    map_frequency: Array = quantity("Hz", "map_speed map_friction", "its frequency")
    map_unstable: Array = count("map_speed map_friction", "modes that grow")
