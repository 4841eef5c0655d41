"""Command 'catalogue': the catalogue of what a model may lack."""

import click

from pipeline.cli.options import options


@click.command()
@click.argument("name", required=False)
@options("debug")
def catalogue(name):
    """List the effects that a diagnosis knows, by where they act, or all that is known of the effect NAME."""
    from pipeline.case_models.effect_block import CATALOGUE
    from pipeline.contract.errors import ConfigError

    if name is None:
        for place in dict.fromkeys(e.location for e in CATALOGUE):
            click.echo(f"at: {place}")
            for e in (e for e in CATALOGUE if e.location == place):
                when = "  (weighed where simpler ones leave something)" * e.elaborate + "  (weighed if asked for)" * (
                    not e.weighed)
                click.echo(f"    {e.name:<28}{e.summary}{when}")
        return
    known = {e.name: e for e in CATALOGUE}
    if name not in known:
        raise ConfigError("catalogue", "the name of an effect", name, "'brakechain catalogue' lists them")
    click.echo(_all_of(known[name]))


def _all_of(effect):
    from pipeline.case_models.effect_block import parameters

    lines = [f"{effect.name}: {effect.summary}", f"at: {effect.location}{' or asperities' * effect.micro}",
             *([f"family: {effect.family}"] if effect.family else []),
             *([f"has as limits: {', '.join(effect.extends)}"] if effect.extends else []),
             *(f"    {p.name} [{p.unit}]" for p in parameters(effect)), f"source: {effect.source}", effect.valid]
    return "\n".join(lines)
