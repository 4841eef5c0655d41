"""Command 'check': in seconds, before a diagnosis, what a case and its recordings can tell, and what they cannot."""

from pathlib import Path

import click

from pipeline.cli.options import options

#: CPU s for the power of candidates; correlation of predicted and recorded, and their sizes, that are doubted
_BUDGET, _AGAINST, _OFF = 20.0, -0.3, 5.0
#: names that a sentence lists at most
_LISTED = 10


@click.command("check")
@click.argument("config", type=click.Path(path_type=Path))
@options("set", "debug")
def check(config, overrides):
    """Say in seconds what the recordings of CONFIG can tell: values, effects, cost, and what is doubtful about them."""
    import stages
    from pipeline.contract import ConfigError, case
    from pipeline.recordings import registry

    given = case.load(config, stages.CHAINS, stages.load, overrides, registry.path)
    if given.document["chain"] != "lumped_bench":
        raise ConfigError(f"{config}: chain", "lumped_bench, whose recordings can be checked", given.document["chain"])
    for line in sentences(given):
        click.echo(line)


def sentences(given):
    """Lines about a CaseFile of chain lumped_bench; ConfigError where it cannot run."""
    import stages
    from pipeline.case_models import effect_block, virtual_rig
    from pipeline.case_models.runs import recorded
    from pipeline.diagnosis.experiment_design.record_doubts import doubts

    chosen = given.sections
    rig, asked = chosen["bench"], chosen["diagnosis"]
    recording = stages.load("recording")(settings=chosen["recording"])
    model = stages.load("reduced_model")(stages.load("lumped")(settings=chosen["lumped"]),
                                         settings=chosen["reduced_model"])
    bench = effect_block.with_effects(virtual_rig.built(model, rig), effect_block.product(chosen["effects"]))
    runs = recorded(recording, rig, model)
    samples = sum(record.run.samples for record in runs.values())
    yield (f"{len(runs)} runs, {samples} samples; held out: {', '.join(asked.held_out) or 'none'};"
           f" {len(bench.model.mass)} coordinate{'s' * (len(bench.model.mass) != 1)}; {_form(rig)}")
    names = list(dict.fromkeys([*rig.channels, *(fed.channel for fed in rig.inputs.values())]))
    yield from (f"doubt: {sentence}" for sentence in doubts(recording, names, asked.held_out, not rig.inputs))
    yield from _idle(bench, runs, rig, asked)
    if rig.poles is not None:
        yield "poles are compared: what they can tell is not computed beforehand"
        return
    yield from _of_model(bench, runs, rig, asked)


def _idle(bench, runs, rig, asked):
    """Doubts about inputs that nothing feeds: runs have 0 there, whatever force the section lumped states."""
    stated = {name.split(".")[1] for name in (*rig.corrections, *asked.parameters) if name.startswith("inputs.")}
    fed = {*rig.inputs, *rig.courses, *stated, rig.blow, *(key for r in runs.values() for key in r.run.conditions)}
    for name in bench.model.input_name:
        if name not in fed:
            yield (f"doubt: the input {name} does nothing: no channel, course or condition of a run feeds it; of a"
                   f" constant force write bench.corrections: {{inputs.{name}.offset: 9.81 N}}")


def _form(rig):
    return "balance of forces" if rig.forward == "equation" else "poles" if rig.poles is not None else "simulation"


def _of_model(bench, runs, rig, asked):
    """Lines from one linearisation about the nominal values."""
    from pipeline.contract.errors import first_of
    from pipeline.diagnosis.experiment_design.what_runs_tell import telling
    from pipeline.diagnosis.signals.posed import posed

    problem = posed(bench, runs, asked, rig)
    seen = telling(problem, asked.kept, _BUDGET)
    yield from _signs(seen, rig)
    told = [name for name in seen.kept if name not in seen.silent]
    if told:
        yield ("values that these runs tell (left of what the case says of them): "
               + ", ".join(f"{name} {100 * seen.kept[name]:.2g} %" for name in told))
    if seen.silent:
        yield f"values of which they say next to nothing, so that they stay as stated: {', '.join(seen.silent)}"
    for a, b, correlation in seen.pairs:
        yield (f"{a} and {b} only go together ({'in opposite ways' if correlation < 0 else 'in the same way'}): no run"
               " tells them apart; state one of them, or record what differs")
    for what, names in (("effects", set(seen.power) - seen.sensors), ("faults of sensors", seen.sensors)):
        power = {name: d for name, d in seen.power.items() if name in names}
        strong = sorted((n for n, d in power.items() if d >= asked.plan.needed), key=power.get, reverse=True)
        weak = [n for n in power if n not in strong]
        yield (f"{what} that these runs can tell beside the nominal values, by standard deviations at an expected"
               f" size: {first_of([f'{n} {power[n]:.0f}' for n in strong], _LISTED) or 'none'}"
               + (f"; not: {first_of(weak, _LISTED)}" if weak else ""))
    if seen.untried:
        yield f"not tried within {_BUDGET:g} s: {first_of(seen.untried, _LISTED)}"
    yield (f"a prediction of all runs takes {seen.seconds:.2g} CPU s; the diagnosis of {len(problem.candidates)}"
           f" candidates roughly {_rounded(seen.cost)}")


def _signs(seen, rig):
    """Doubts where what is recorded goes against what the nominal values predict, or has another size."""
    channels = {c for of_run in seen.alike.values() for c in of_run}
    for channel in sorted(channels):
        likeness = [of_run[channel] for of_run in seen.alike.values() if channel in of_run]
        size = [of_run[channel] for of_run in seen.size.values() if channel in of_run]
        if max(likeness) < _AGAINST:
            what = "the force that the motion needs" if rig.forward == "equation" else "what is predicted"
            yield (f"doubt: {channel}: {what} and what is recorded go against one another in every run (correlation"
                   f" {max(likeness):.2f} at most): a sign is wrong; write -1 as the weight of the input in"
                   " lumped.inputs, or as gain of the channel")
        elif min(size) > _OFF or max(size) < 1 / _OFF:
            yield (f"doubt: {channel}: predicted with {min(size):.2g} to {max(size):.2g} times the size that is"
                   " recorded: a unit, a gain or a nominal value is off by such a factor")


def _rounded(seconds):
    return f"{max(seconds, 1):.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
