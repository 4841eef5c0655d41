"""YAML sections of a system that is given as matrices."""

from typing import Literal

from pipeline.contract import InputFile, Quantity, Section, option


class Term(Section):
    """A matrix from a file, and what it is multiplied by."""

    file: InputFile = option(..., "file of the matrix: .mat, .mtx, .npz, or a .pch of Nastran")
    variable: str | None = option(None, "its name in a file of several")
    times: str = option("1", "how it changes with speed and friction, each over that of the matrices, such as"
                             " 'friction/speed - 1'")
    symmetry: Literal["symmetric", "skew-symmetric", "general"] | None = option(
        None, "its form, where the file does not say it: one triangle of a symmetric or skew-symmetric matrix will do,"
              " a general one is taken as it stands; none = as its file says")
    at_frequency: Quantity("Hz", gt=0) | None = option(
        None, "frequency at which a loss, given as a stiffness, becomes viscous: it is divided by 2 pi times it")
