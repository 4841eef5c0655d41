"""Command 'new NAME --from FILE': a first case of recorded files."""

import click


def write(file, paths):
    """Write the case ``file`` of the recorded ``paths`` and say what was found."""
    from pipeline.cli.bench.rig import rig
    from pipeline.cli.bench.rig_text import text
    from pipeline.contract.store import write_companion

    found = rig(paths)
    write_companion(file, text(found, file))
    for line in told(found):
        click.echo(line)
    click.echo(f"{file}: see its lines with <-, then\n    brakechain check {file}\n    brakechain run {file}")


def told(rig):
    """Lines: channels with unit, rate and length, runs, and what is proposed of them."""
    used = {s.column for s in rig.roles.responses} | {s.column for s, _ in rig.roles.drives}
    for contents in rig.files:
        yield f"{contents.path}: {contents.kind}"
        for s in contents.signals.values():
            count = sum(map(len, s.pieces.values()))
            unit = s.meaning.unit if s.meaning.stated else f"{s.meaning.unit}? (not stated)"
            what = "response" if s.column in {r.column for r in rig.roles.responses} else "excitation" if s.column in (
                used) else "base" if rig.roles.base and s.column == rig.roles.base.column else (
                f"left out: {rig.roles.left_out.get(s.column, 'not in the first file')}")
            yield f"    {s.column:<20} {unit:<20} {s.rate:g} Hz, {count} samples   {what}"
    yield from dict.fromkeys(rig.remarks)
    runs = [name for each in rig.runs for name in each]
    yield f"runs: {', '.join(runs[:8])}{' ...' if len(runs) > 8 else ''}; held out: {rig.held_out or 'none'}"
    yield ("form: balance of forces (displacements at every coordinate, and what acts)" if rig.balance else
           f"form: simulation, start {'fitted' if rig.start else 'at rest'}")
