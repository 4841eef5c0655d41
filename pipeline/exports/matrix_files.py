"""Systems of matrices as files: NumPy and Matrix Market, and the case that runs them in the chain ``matrices``."""

import json

import numpy as np
import scipy

from pipeline.case_models.matrices.symmetry import one_sided
from pipeline.contract.received.files import write_new
from pipeline.contract.store import write_companion
from pipeline.exports.run_products import refuse_existing, safe_names

NPZ, MARKET = "npz", "mtx"
FORMATS = {"both": (NPZ, MARKET), NPZ: (NPZ,), MARKET: (MARKET,)}
#: kinds in the order in which a case states them
_KINDS = "mass", "damping", "stiffness", "loss"
_GIVEN = "# Terms, what they are multiplied by, and units are as they were given; freedoms.csv says what each row is.\n"
_SLIDING = """# SI units. 'times' holds while contacts and their forces stay as they are at {speed:.6g} rad/s:
# elsewhere, export another state. freedoms.csv says what each row is; rows.npz holds the rows of inputs and sensors.
"""
_HEAD = """# {about}
# Written by 'brakechain export matrices' from {source}. Run it with
#
#   brakechain run {name}.yaml
#
{notes}
chain: matrices
title: {title}
description: {description}

matrices:
  reference_speed: {speed!r} rad/s
"""


def write_system(system, folder, source, formats=(NPZ, MARKET)):
    """Write a MatrixSystem to a new ``folder``: its matrices, its degrees of freedom, and its case; returns the latter.

    ``source``: what it is from, in words. Raises ConfigError where the folder exists.
    """
    refuse_existing(folder)
    folder.mkdir()
    names = dict(zip((term.name for term in system.terms), safe_names(t.name for t in system.terms), strict=True))
    for term in system.terms:
        for suffix in formats:
            _write(folder / f"{names[term.name]}.{suffix}", term.matrix, suffix)
    if system.rows:
        np.savez_compressed(folder / "rows.npz", **system.rows)
    columns, rows = system.freedoms
    write_companion(folder / "freedoms.csv", "\n".join(",".join(map(str, row)) for row in (columns, *rows)) + "\n")
    case = folder / f"{safe_names([folder.name])[0]}.yaml"
    write_companion(case, _case(system, case.stem, source, names, formats[0]))
    return case


def _write(path, matrix, suffix):
    """One matrix: sparse in both formats, with all digits."""
    entries = scipy.sparse.coo_matrix(matrix)
    if suffix == NPZ:
        scipy.sparse.save_npz(path, entries.tocsc())
        return
    write_new(path, b"")
    scipy.io.mmwrite(path, entries, symmetry="general")


def _case(system, name, source, names, suffix):
    """The YAML of the case; values in SI."""
    source = " ".join(source.split())
    text = [_HEAD.format(about=system.about[0].upper() + system.about[1:], source=source, name=name, speed=system.speed,
                         notes=_SLIDING.format(speed=system.speed) if system.rows else _GIVEN,
                         title=json.dumps(f"{name.replace('_', ' ')}, as matrices"),
                         description=json.dumps(f"{system.about}, from {source}"))]
    for kind in _KINDS:
        members = [term for term in system.terms if term.kind == kind]
        text += [f"  {kind}:\n"] if members else []
        text += [f"    {names[t.name]}: {{file: {names[t.name]}.{suffix}"
                 + (f", times: {json.dumps(t.times)}" if t.times != "1" else "")
                 + ", symmetry: general" * one_sided(scipy.sparse.csr_matrix(t.matrix)) + "}\n" for t in members]
    speeds = ", ".join(f"{speed!r} rad/s" for speed in system.speeds or (system.speed,))
    text.append(f"\nmatrix_modes:\n  speeds: [{speeds}]\n  friction: {system.friction!r}\n"
                f"  frequency_max: {system.highest!r} Hz\n  map_friction: {[*system.map_friction]}\n")
    return "".join(text)
