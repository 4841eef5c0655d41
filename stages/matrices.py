"""Stage matrices: a system that another program wrote as matrices."""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.case_models.matrices import constraints
from pipeline.case_models.matrices.dependence import summands
from pipeline.case_models.matrices.sections import Term
from pipeline.case_models.matrices.symmetry import as_meant
from pipeline.contract import ConfigError, Context, Quantity, Section, option, stage
from pipeline.contract.errors import first_of
from pipeline.decks.entries import named
from pipeline.decks.matrix_files import read
from pipeline.products import Matrices, MatrixTerm

KINDS = ("mass", "damping", "stiffness", "loss")
#: a mass matrix is symmetric to this share of its largest entry
_SYMMETRIC = 1e-8
#: degrees of freedom that a remark names
_NAMED = 6


class Settings(Section):
    """Terms of the matrices, each by a name of yours; units are consistent, and times in seconds."""

    mass: dict[str, Term] = option({}, "terms of the mass matrix")
    damping: dict[str, Term] = option({}, "terms of the matrix of velocities: damping, gyroscopic, of friction")
    stiffness: dict[str, Term] = option({}, "terms of the matrix of displacements: stiffness, circulatory, of spin")
    loss: dict[str, Term] = option({}, "terms of the imaginary part of the stiffness, by loss factors (hysteretic)")
    reference_speed: Quantity("rad/s", gt=0) = option("1 rad/s", "speed for which the terms are given")


def _check(sections):
    """Refuse a system without mass or stiffness, names that stand twice, and dependences that cannot be read."""
    settings = sections["matrices"]
    named = [(name, kind) for kind in KINDS for name in getattr(settings, kind)]
    for kind in ("mass", "stiffness"):
        if not getattr(settings, kind):
            raise ConfigError(f"matrices.{kind}", "at least one term", "none", "name a file, such as"
                              " {structure: {file: K.mtx}}")
    if len({name for name, _ in named}) < len(named):
        raise ConfigError("matrices", "a name of its own for every term", ", ".join(name for name, _ in named))
    for name, kind in named:
        term = getattr(settings, kind)[name]
        summands(term.times, f"matrices.{kind}.{name}.times")
        if term.at_frequency is not None and kind != "damping":
            raise ConfigError(f"matrices.{kind}.{name}.at_frequency", "none but in damping",
                              f"{term.at_frequency:g} Hz")


@stage(check=_check)
def matrices(settings: Settings, context: Context) -> Matrices:
    """Read a system that another program wrote as matrices.

    Method:
    The system was read as matrices of mass, damping, stiffness and hysteretic loss; terms are given for
    {reference_speed} and one coefficient of friction, and change with both as stated. Degrees of freedom that penalties
    hold on the diagonal of the stiffness were taken out.
    """
    given = {name: (kind, term, read(term.file, term.variable)) for kind in KINDS
             for name, term in getattr(settings, kind).items()}
    labels, size = _freedoms(given)
    terms, remarks = {}, []
    for name, (kind, term, entries) in given.items():
        where = f"matrices.{kind}.{name}"
        changes = any(friction for *_, friction in summands(term.times, f"{where}.times"))
        entries, remark = as_meant(entries, kind, term, changes, size, where)
        if kind == "mass":
            _refuse_masses(entries.matrix(), f"{where}: {term.file.name}")
        terms[name] = _term(kind, term, *_placed(entries, labels), where)
        remarks += [remark] if remark else []
    kept, told = _kept(terms, size, labels)
    for remark in (remarks := remarks + told):
        context.remark(remark)
    if len(kept) < size:
        terms = {name: _without(term, kept, size) for name, term in terms.items()}
    return Matrices(size=len(kept), node=labels[kept, 0] if len(labels) else [],
                    direction=labels[kept, 1] if len(labels) else [], reference_speed=settings.reference_speed,
                    constrained=np.setdiff1d(np.arange(size), kept), remark=remarks, terms=terms)


def _kept(terms, size, labels):
    """(indices of the degrees of freedom that are kept, remarks on the others)."""
    sums = {kind: sum((abs(_matrix(term, size)) * abs(term.coefficient).sum() for term in terms.values()
                       if str(term.kind) == kind), scipy.sparse.csr_matrix((size, size))) for kind in KINDS}
    stiff = constraints.held(sums["stiffness"], sums["mass"].diagonal())
    empty = constraints.empty([*sums.values()], stiff)
    if len(stiff) + len(empty) == size:
        raise ConfigError("matrices", "degrees of freedom that can move", "none", "is every one of them constrained?")
    told = []
    if len(stiff):
        largest = sums["stiffness"].diagonal()[stiff].max()
        told.append(f"{_counted(stiff, size, labels)}: held by a penalty of up to {largest:.3g} on the diagonal of the"
                    " stiffness, as a constraint is written, and taken out of the system")
    if len(empty):
        told.append(f"{_counted(empty, size, labels)}: without entries{' beside these' if len(stiff) else ''}, and"
                    " taken out of the system")
    return np.setdiff1d(np.arange(size), np.concatenate((stiff, empty))), told


def _counted(chosen, size, labels):
    """How many degrees of freedom of the whole ``size`` were ``chosen``, and which."""
    return (f"matrices: {len(chosen)} of {size} degrees of freedom"
            f" ({first_of([named(labels, k) for k in chosen], _NAMED)})")


def _matrix(term, size):
    return scipy.sparse.csr_matrix((term.value, (term.row, term.column)), (size, size))


def _without(term, kept, size):
    """The MatrixTerm with the degrees of freedom that are ``kept`` of the whole ``size``."""
    place = np.full(size, -1)
    place[kept] = np.arange(len(kept))
    row, column = place[term.row], place[term.column]
    inside = (row >= 0) & (column >= 0)
    return replace(term, row=row[inside], column=column[inside], value=term.value[inside])


def _freedoms(given):
    """(labels (n, 2) in order, none where rows are counted; number of degrees of freedom n)."""
    labelled = {name: entries.label for name, (_, _, entries) in given.items() if entries.label is not None}
    sizes = {name: entries.size for name, (_, _, entries) in given.items()}
    if not labelled:
        largest = max(sizes.values())
        if len(set(sizes.values())) > 1:
            raise ConfigError("matrices", "matrices of one size", ", ".join(f"{n}: {k}" for n, k in sizes.items()))
        return np.empty((0, 2), int), largest
    if len(labelled) < len(given):
        raise ConfigError("matrices", "nodes and directions in all files or in none",
                          f"none in {', '.join(set(given) - set(labelled))}")
    labels = np.unique(np.concatenate(list(labelled.values())), axis=0)
    return labels, len(labels)


def _placed(entries, labels):
    """(row, column, value) of Entries among all degrees of freedom."""
    if entries.label is None:
        return entries.row, entries.column, entries.value
    place = {tuple(label): k for k, label in enumerate(labels.tolist())}
    index = np.array([place[tuple(label)] for label in entries.label.tolist()])
    return index[entries.row], index[entries.column], entries.value


def _term(kind, term, row, column, value, where):
    dependence = summands(term.times, f"{where}.times")
    scale = 1.0 if term.at_frequency is None else 1 / (2 * np.pi * term.at_frequency)
    coefficient, speed, friction = zip(*dependence, strict=True)
    return MatrixTerm(kind=kind, times=str(term.times), source=term.file.name, row=row, column=column,
                      value=scale * value, coefficient=coefficient, speed_power=speed, friction_power=friction)


def _refuse_masses(matrix, where):
    """ConfigError for a mass matrix that is not symmetric, or has a negative mass on its diagonal."""
    if abs(matrix - matrix.T).max() > _SYMMETRIC * abs(matrix).max():
        raise ConfigError(where, "a symmetric mass matrix", "another one", "is it the stiffness?")
    if matrix.diagonal().min() < 0:
        raise ConfigError(where, "masses above 0", f"{matrix.diagonal().min():g} in row {matrix.diagonal().argmin()}")
