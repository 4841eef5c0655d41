"""Command 'export': what other programs read of the products of a run."""

from pathlib import Path

import click

from pipeline.cli.options import options

_RUN = click.argument("run", type=click.Path(exists=True, file_okay=False, path_type=Path))
_STATE = click.option("--state", type=int, metavar="N", help="operating point of complex_modes, from 0  [default: that"
                                                              " of the most unstable mode]")


@click.group("export")
def export():
    """Write what other programs read of the products in the folder RUN."""


@export.command("matrices")
@_RUN
@click.argument("folder", type=click.Path(path_type=Path))
@_STATE
@click.option("--full", is_flag=True, help="the full finite-element matrices instead of the reduced model")
@click.option("--format", "kind", type=click.Choice(["both", "npz", "mtx"]), default="both", show_default=True,
              help="NumPy, Matrix Market")
@options("debug")
def matrices(run, folder, state, full, kind):
    """Write mass, damping, stiffness, gyroscopic and circulatory matrices about a sliding state to FOLDER.

    A case of the chain 'matrices' lies beside them, ready to run.
    """
    from pipeline.exports import matrix_files, matrix_system
    from pipeline.physics.numerics import sparse_solver

    matrix_files.refuse_existing(folder)
    if matrix_system.is_given_as_matrices(run):
        system = matrix_system.given_system(run)
    elif full:
        system = matrix_system.full_system(run, state, sparse_solver.available()[0])
    else:
        system = matrix_system.reduced_system(run, state)
    case = matrix_files.write_system(system, folder, str(run), matrix_files.FORMATS[kind])
    click.echo(f"{folder}: {len(system.terms)} matrices, {system.about}\nrun them with: brakechain run {case}")


@export.command("modes")
@_RUN
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--body", metavar="NAME", help="real modes of this body on its supports instead of the unstable modes")
@options("debug")
def modes(run, file, body):
    """Write mode shapes to FILE: universal file (.unv, .uff) or VTKHDF for ParaView (.vtkhdf).

    By default the unstable complex modes, strongest first, on the surface of all bodies.
    """
    from pipeline.contract import ConfigError
    from pipeline.exports import mode_set
    from pipeline.exports.run_products import refuse_existing

    kind = file.suffix.lower()
    if kind not in (".unv", ".uff", ".vtkhdf"):
        raise ConfigError(file, "a name that ends in .unv, .uff or .vtkhdf", repr(file.suffix))
    refuse_existing(file)
    chosen = mode_set.body_modes_of(run, body) if body else mode_set.complex_modes_of(run)
    if kind == ".vtkhdf":
        from pipeline.exports.vtkhdf_modes import write_vtkhdf as write
    else:
        from pipeline.exports.universal_modes import write_universal as write
    write(chosen, file, str(run))
    click.echo(f"{file}: {len(chosen.root)} modes at {len(chosen.node)} nodes, {chosen.scale}")


@export.command("fmu")
@_RUN
@click.argument("file", type=click.Path(path_type=Path))
@_STATE
@click.option("--contacts", metavar="STEP", help="with contacts that lift and stick, in steps of at most STEP, such as"
              " '1 us'; needs brakechain where the unit runs  [default: linearised]")
@options("debug")
def fmu(run, file, state, contacts):
    """Write the reduced sliding model about steady sliding to FILE.fmu: FMI 2.0, co-simulation.

    Needs the extra 'fmu'.
    """
    from pipeline.contract import ConfigError
    from pipeline.contract.units import to_si
    from pipeline.exports.fmu import contact_unit_of, unit_of, write_fmu
    from pipeline.exports.run_products import refuse_existing

    if file.suffix.lower() != ".fmu":
        raise ConfigError(file, "a name that ends in .fmu", repr(file.suffix))
    refuse_existing(file)
    step = to_si(contacts, "s", "--contacts") if contacts else None
    if step is not None and not step > 0:
        raise ConfigError("--contacts", "a step above 0", contacts)
    unit = unit_of(run, state) if step is None else contact_unit_of(run, state, step)
    write_fmu(unit, file, str(run))
    click.echo(f"{file}: {unit.about}\ninputs: {', '.join(name for name, *_ in unit.inputs)}\n"
               f"outputs: {', '.join(name for name, *_ in unit.outputs)}")
