"""The problem of recorded time signals, by the section ``bench``: simulated runs, or a balance of forces."""

from dataclasses import replace

from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.problem import split_name
from pipeline.diagnosis.signals.balanced_bench import balanced_bench
from pipeline.diagnosis.signals.start_states import started


def posed(bench, runs, settings, rig):
    """DiagnosisProblem over {name: Recorded} of a Bench, under the sections ``diagnosis`` and ``bench``.

    An effect whose stated values are fitted as nominal ones is no candidate at its place.
    """
    problem = (force_balance_problem(balanced_bench(bench, runs), runs, settings, rig.equation)
               if rig.forward == "equation" else forced_problem(bench, started(bench, runs, rig), settings))
    fitted = {split_name(p.name)[:2] for p in problem.problem.nominal.parameters if not p.run}
    return replace(problem, candidates=tuple(c for c in problem.candidates if not fitted & set(c.effects)))
