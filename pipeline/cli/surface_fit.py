"""Option '--fit SCAN' of the command of the stage surface."""

import click


def with_fit(command):
    """The command of the stage with '--fit SCAN': it then takes no CONFIG and prints a section of the YAML instead."""
    run = command.callback
    config = next(p for p in command.params if p.name == "config")
    config.required = False
    command.params.append(click.Option(
        ["--fit", "scan"], metavar="SCAN", help="print the section 'surface' of a generator whose surfaces match SCAN,"
        " and how well; --set patch_length=..., shortest_wavelength, body, transposed, channel, height_unit,"
        " pixel_size, seeds; no CONFIG"))

    def callback(config, overrides, scan, **rest):
        if (config is None) == (scan is None):
            raise click.UsageError("expected either CONFIG or --fit SCAN")
        if scan is None:
            run(config=config, overrides=overrides, **rest)
        else:
            _print_fit(scan, overrides)

    command.callback = callback
    return command


def _print_fit(scan, overrides):
    from pipeline.case_models.rough.prescriptions import fit
    from pipeline.case_models.rough.sections import FitSettings
    from pipeline.contract.documents import parse_value, yaml_text
    from pipeline.contract.settings import fill
    from pipeline.recordings import registry

    given = {"file": scan}
    for override in overrides:
        key, _, value = override.partition("=")
        given[key.strip()] = parse_value(value)
    document, lines = fit(fill(FitSettings, given, "surface --fit", {"measured": registry.path}))
    click.echo("".join(f"# {line}\n" for line in lines) + yaml_text(document), nl=False)
