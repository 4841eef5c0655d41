"""The problem of recorded time signals, by the section ``bench``: simulated runs, or a balance of forces."""

from dataclasses import replace

from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.forced_response import check_names, forced_problem
from pipeline.diagnosis.problem import split_name
from pipeline.diagnosis.signals.balanced_bench import balanced_bench
from pipeline.diagnosis.signals.start_states import started
from pipeline.diagnosis.signals.usable_runs import without


def posed(bench, runs, settings, rig):
    """DiagnosisProblem over {name: Recorded} of a Bench, under the sections ``diagnosis`` and ``bench``.

    An effect whose stated values are fitted as nominal ones is no candidate at its place.
    """
    if rig.forward == "equation":
        problem = force_balance_problem(balanced_bench(bench, runs), runs, settings, rig.equation)
    else:
        check_names("held_out", settings.held_out, runs)
        runs = started(bench, runs, rig, refused := {})
        problem = forced_problem(bench, runs, without(settings, refused), tuple(refused.values()))
    fitted = {split_name(p.name)[:2] for p in problem.problem.nominal.parameters if not p.run}
    return replace(problem, candidates=tuple(c for c in problem.candidates if not fitted & set(c.effects)))
