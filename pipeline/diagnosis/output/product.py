"""From a solved problem to the product Diagnosis: hypotheses, parameters, errors, runs under three models."""

import numpy as np

from pipeline.case_models.corrections import is_factor
from pipeline.diagnosis.experiment_design.next_run import NOTHING, next_experiment
from pipeline.diagnosis.output.attempts import Attempts
from pipeline.diagnosis.output.combinations import combinations
from pipeline.diagnosis.output.remainder import Remainder, remainder
from pipeline.diagnosis.problem import label, split_name
from pipeline.diagnosis.signals.localisation import stage_of
from pipeline.effects import family
from pipeline.inference.decision import several_laws
from pipeline.inference.decision.candidate_statistics import unexplained
from pipeline.inference.decision.held_out import errors
from pipeline.inference.diagnosis import over_noise
from pipeline.inference.fitting.noise import normalised_error
from pipeline.inference.fitting.parameter_drift import spread
from pipeline.inference.fitting.run_parameters import short
from pipeline.inference.search.score_screen import short_name
from pipeline.products import DiagnosedRun, Diagnosis, Follows, LatentForce, LatentPrediction, Located, SquealCheck

#: models that are compared, in the order of the tables
MODELS = ("nominal", "recalibrated", "completed", "noise")
#: factor by which the error of the fitted runs may grow with the recalibration before it is told
_GROWN = 1.1


def product(problem, diagnosis, contacts=None):
    """Product Diagnosis of a DiagnosisProblem and the inference's Diagnosis of it.

    ``contacts`` {location: names that the case gives to the contacts there}.
    """
    completed, recalibrated, table = diagnosis.completed, diagnosis.recalibrated, _hypotheses(diagnosis)
    std, attempt = _std(diagnosis, completed), Attempts()
    table["contacts"] = [_contacts(place, contacts or {}) for place in table["place"]]
    runs = problem.problem
    fits = [_errors(problem, diagnosis, part, attempt) for part in (runs.training, runs.held_out)]
    axes = attempt("where the mismatch lies", problem.locator.located, diagnosis, otherwise={})
    attempt.failures.extend(getattr(axes, "failures", ()))
    latent = attempt("the missing force", problem.latent.described, diagnosis, axes) if problem.latent else None
    axes |= latent.regimes if latent else {}
    predicts = latent and problem.predicts_with_force and diagnosis.decision.verdict == "unknown"
    use = attempt("held-out runs with the missing force", problem.latent.predicted, diagnosis,
                  latent) if predicts else None
    squeals = attempt("the comparison of saturated squeal", problem.squeals.compared, recalibrated, completed,
                      otherwise={}) if problem.squeals else {}
    channels, rows = tuple(problem.units), problem.rules.rows()
    left = attempt("what is left", remainder, problem, diagnosis, otherwise=Remainder(0.0, "", ""))
    levels = attempt("the verdict at other levels of noise", over_noise, diagnosis, problem.settings,
                     problem.noise_levels, otherwise=())
    further = attempt("the next experiment", next_experiment, problem, diagnosis, otherwise=NOTHING)
    result = Diagnosis(
        verdict=diagnosis.decision.verdict, other_machine="", failure=diagnosis.decision.failure,
        runs_differ=diagnosis.decision.runs_differ, model_error=diagnosis.model_error,
        in_part=int(bool(diagnosis.decision.named) and left.floors > problem.rules.decision.in_part),
        reason=[*diagnosis.decision.reasons, *_grown(fits[0]), *problem.remarks, *short(runs, problem.budget),
                *attempt.failures],
        channel=channels, channel_unit=[problem.units[c] for c in channels], **table,
        **_parameters(completed, std, table), **combinations(diagnosis), **_leading(diagnosis, table),
        leading_set=_leading_set(problem, diagnosis),
        **_levels(levels), left_floors=left.floors, left_sentence=left.sentence,
        left_candidate=left.candidate, **_starts(runs, completed, std),
        completed_step=problem.step / 2**halvings if (halvings := completed.hypothesis.halvings) > 0 else 0.0,
        fit=[_part(part) for part in fits], unexplained_share=unexplained(recalibrated, completed, problem.rules),
        drift_p_value=diagnosis.weighing.drift.p_value,
        location={name: located(*axis) for name, axis in axes.items()},
        **_latent(latent), **_used(use, runs), **further,
        runs={run.name: _run(problem, run, fits[run.held_out]) for run in runs.runs
              if run.name in fits[run.held_out].by_run},
        squeal={name: squeal_check(comparison) for name, comparison in squeals.items()},
        threshold=[row[0] for row in rows], threshold_value=[row[1] for row in rows],
        threshold_unit=[row[2] for row in rows], threshold_meaning=[row[3] for row in rows])
    return problem.revision.revised(result, diagnosis) if problem.revision else result


def _errors(problem, diagnosis, part, attempt):
    """Errors over the runs of a ``part``, without those that a model cannot predict."""
    def of(runs):
        return errors(problem.problem, problem.budget, problem.problem.nominal, diagnosis.recalibrated,
                      diagnosis.completed, runs, problem.rules.decision.start_share)

    try:
        return of(part)
    except Exception:
        return of([run for run in part if attempt(f"errors of run {run.name}", of, [run])])


def _grown(errors):
    """A sentence where the Errors of the fitted runs grew with the recalibration, as one of noise floors may."""
    if errors.runs and errors.recalibrated > _GROWN * errors.before:
        yield (f"the recalibrated nominal model errs more on the fitted runs than the given values do"
               f" ({errors.recalibrated:.2g} against {errors.before:.2g} of their standard deviation), since runs of"
               " large motion count most: it lacks something that these ask for; its values say little")


def located(location, unit="", edges=None):
    """Product Located of a Location; ``edges`` (n, 2) of bins in ``unit``."""
    edges = np.zeros((len(location.items), 2)) if edges is None else np.asarray(edges, float)
    return Located(item=[str(i) for i in location.items], low=edges[:, 0], high=edges[:, 1], unit=unit,
                   score=location.score, p_value=location.p_value, member=location.members.astype(int))


def squeal_check(compared):
    """Product SquealCheck of a Compared."""
    who, heard = list(compared.heard), list(compared.heard.values())
    unit = {feature: name for sound in heard for feature, name in sound.unit.items()}

    def table(number):
        return np.array([[number(name, sound, f) if f in sound.values else 0 for f in unit]
                         for name, sound in compared.heard.items()]).reshape(len(who), len(unit))

    return SquealCheck(
        sentence=compared.sentence, who=who, records=[len(sound.states) for sound in heard],
        squealing=[sound.squealing for sound in heard], feature=list(unit), unit=list(unit.values()),
        known=table(lambda name, sound, f: 1), mean=table(lambda name, sound, f: sound.values[f].mean()),
        spread=table(lambda name, sound, f: sound.values[f].std()),
        agrees=table(lambda name, sound, f: int(compared.agrees.get(name, {}).get(f, False))))


def _latent(description):
    """Fields of the latent force of a Description or None."""
    if description is None:
        return {"latent_place": "", "latent_sentence": "", "latent": {}, "follows": {}}
    return {"latent_place": description.location, "latent_sentence": description.sentence,
            "latent": {name: LatentForce(time=run.time, force=run.force, std=run.std, displacement=run.displacement,
                                         velocity=run.velocity) for name, run in description.runs.items()},
            "follows": {f.name.replace(" ", "_"): Follows(share=f.share, p_value=f.p_value, unit=unit, centre=f.centre,
                                                          curve=f.curve) for f, unit in description.follows}}


def _used(use, problem):
    """Fields of the LatentUse of a force or None."""
    if use is None:
        return {"latent_use": "", "latent_term": [], "latent_coefficient": [], "latent_unit": [],
                "latent_predicted": {}}
    terms = list(use.law.coefficient) if use.law else []
    held_out = {run.name: run for run in problem.held_out}
    return {"latent_use": use.sentence, "latent_term": terms, "latent_unit": [use.law.unit(term) for term in terms],
            "latent_coefficient": [use.law.coefficient[term] for term in terms],
            "latent_predicted": {name: LatentPrediction(predicted=p, error=normalised_error(
                held_out[name], held_out[name].samples - p)) for name, p in use.runs.items()}}


def _hypotheses(diagnosis):
    """Columns of the table of everything weighed; its probabilities sum to 1.

    Nothing missing first, then what is taken as known, alone, then the catalogue: candidates beside what is known.
    """
    screen = diagnosis.screen
    weighed = {w.candidate.name: w for w in diagnosis.weighed}
    rows, posterior = [_row("nothing missing", (), "physics", posterior=diagnosis.posterior[0])], diagnosis.posterior
    known = _known(diagnosis)
    if known:
        nothing = diagnosis.base.posterior[0]
        rows[0]["posterior"], posterior = nothing, (1 - nothing) * posterior
        rows += [known[0] | {"posterior": posterior[0]}, *known[1:]]
    for k, candidate in enumerate(screen.candidates):
        refitted = weighed.get(candidate.name)
        rows.append(_screened(screen, k, refitted) | {
            "posterior": posterior[1 + k], "objection": _objection(diagnosis, candidate, refitted)})
    names = [row["hypothesis"] for row in rows]
    return {**{key: [row[key] for row in rows] for key in rows[0]},
            "named": [names.index(c.name) for c in diagnosis.decision.named], "known": list(range(1, 1 + len(known)))}


def _leading(diagnosis, table):
    """Fields of what leads where nothing is named, and of the family of that or of what is named."""
    decision = diagnosis.decision
    every = (decision.leading, *decision.family) if decision.leading else ()
    rows = [table["hypothesis"].index(c.name) for c in every]
    told = table["named"] or rows
    return {"leading": rows, "family": family(*([table[key][k] for k in told] for key in ("effect", "place"))),
            "leading_takes": [c.takes for c in every], "leading_stays": [c.stays for c in every],
            "leading_values": [_values_of(diagnosis, c.name) for c in every]}


def _values_of(diagnosis, name):
    """Values of the hypothesis of this ``name`` with their standard deviations, in words."""
    best = next(w for w in diagnosis.weighed if w.candidate.name == name)
    std = spread(best.fit, best.fit.weights)
    return ", ".join(f"{short_name(p).replace('_', ' ')} {best.fit.values[p.name]:.4g} +- {std[p.name]:.2g}"
                     + (f" {p.unit}" if p.unit != "1" else "") for p in best.candidate.parameters if not p.run)


def _leading_set(problem, diagnosis):
    single = diagnosis.base or diagnosis
    alone = min((w.statistics.unexplained for w in single.weighed), default=1.0)
    few = len(problem.problem.training) < problem.rules.decision.naming_runs        # laws of one run tell little
    best = None if few else several_laws.leading(diagnosis.combinations, diagnosis.decision, problem.rules, alone)
    return np.array([] if best is None else [best], int)


def _levels(levels):
    """Fields of the verdict at other levels of noise, [VerdictAtNoise]."""
    return {"noise_level": [level.factor for level in levels], "noise_verdict": [level.verdict for level in levels],
            "noise_named": [" or ".join(level.named) for level in levels]}


def _contacts(place, names):
    """Contacts at a place, or at those of a pair, in the words of the case."""
    return ", ".join(dict.fromkeys(name for each in place.split(" + ") for name in names.get(each, ())))


def _known(diagnosis):
    """Rows of what is taken as known, as each stood when it was weighed alone."""
    base, effects = diagnosis.base, set(diagnosis.nominal.effects)
    if base is None or not effects:
        return []
    weighed = {w.candidate.name: w for w in base.weighed}
    return [_screened(base.screen, k, weighed.get(c.name)) for k, c in enumerate(base.screen.candidates)
            if effects.issuperset(c.effects) and c.effects]


def _screened(screen, k, refitted):
    """Row of the candidate of this index in a Screen; ``refitted``: its Weighed, whose p-value the rules saw, or None.
    """
    candidate, seen = screen.candidates[k], refitted.statistics if refitted else None
    return _row(candidate.name, candidate.effects, candidate.kind, score=max(float(screen.score[k]), -1e3),
                p_value=float(seen.p_value if seen else screen.p_value[k]), power=float(screen.power[k]),
                evidence_gain=seen.evidence_gain if seen else 0.0, refitted=int(refitted is not None),
                held_out_error=(seen.held_out_error if seen else None) or 0.0)


def _objection(diagnosis, candidate, refitted):
    """Why a candidate was not judged, or what speaks against its fit."""
    against = (refitted.statistics.forbidden, *refitted.statistics.doubts) if refitted else ()
    return "; ".join(filter(None, (diagnosis.failures.get(candidate.name, ""), *against)))


def _row(name, effects, kind, **values):
    row = {"hypothesis": name, "effect": " + ".join(e for e, _ in effects), "place": " + ".join(p for _, p in effects),
           "kind": kind, "stage": stage_of(effects), "posterior": 0.0, "score": 0.0, "p_value": 1.0, "power": 0.0,
           "evidence_gain": 0.0, "refitted": 0, "held_out_error": 0.0, "objection": ""}
    return row | values


def _std(diagnosis, completed):
    """{name: standard deviation} of the values of the Fit ``completed``; what a model leaves counts as its noise, as
    does what runs differ by.

    Where nothing could be named, values depend on what is missing: they are those of ``completed`` or of a refitted
    candidate that fits better, each as likely as the others since none of them suffices.
    """
    unknown = diagnosis.decision.verdict == "unknown"
    models = [completed, *(w.fit for w in diagnosis.weighed if unknown and w.fit.objective < completed.objective)]
    std = [spread(fit, fit.weights) for fit in models]
    return {name: float(np.sqrt(np.mean([deviation[name] ** 2 + (fit.values[name] - value) ** 2
                                         for fit, deviation in zip(models, std, strict=True)])))
            for name, value in completed.values.items()}


def _parameters(completed, std, table):
    values = completed.values
    owners = dict(zip(table["hypothesis"], range(len(table["hypothesis"])), strict=True))
    rows = []
    for parameter in (p for p in completed.hypothesis.parameters if not p.run):
        effect, location, _ = split_name(parameter.name)
        given = parameter.nominal if parameter.null is None else parameter.null
        rows.append((parameter.name, parameter.unit, given, values[parameter.name], std[parameter.name],
                     owners.get(label(((effect, location),)), 0), int(not effect and is_factor(parameter.name))))
    keys = ("parameter", "parameter_unit", "parameter_nominal", "parameter_value", "parameter_std", "parameter_owner",
            "parameter_factor")
    return {key: [row[k] for row in rows] for k, key in enumerate(keys)}


def _starts(problem, completed, std):
    """Fields of the fitted start states of the runs that were fitted: parameters of these runs alone."""
    values, fitted = completed.values, {run.name for run in problem.training}
    rows = [(p.run, f"{p.of}, difference" if p.of else split_name(p.name)[2], p.unit, values[p.name], std[p.name])
            for p in completed.hypothesis.parameters if p.run in fitted]
    return {key: [row[k] for row in rows] for k, key in enumerate(
        ("start_run", "start_quantity", "start_unit", "start_value", "start_std"))}


def _part(errors):
    """Row of the table of fits from the Errors of one part; zeros where it has no runs."""
    if not errors.runs:
        return [0.0] * len(MODELS)
    return [errors.before, errors.recalibrated, errors.after, errors.noise_floor]


def _run(problem, run, errors):
    """DiagnosedRun of one run of the Errors of its part."""
    nominal, recalibrated, completed = errors.predicted[run.name]
    stated = {name: float(value) for name, value in run.conditions.items() if np.ndim(value) == 0}
    return DiagnosedRun(
        held_out=int(run.held_out), condition=list(stated), condition_value=list(stated.values()),
        time=np.arange(run.samples.shape[1]) / (run.rate or 1.0), measured=run.samples, valid=run.valid.astype(int),
        nominal=nominal, recalibrated=recalibrated, completed=completed, noise=problem.budget[run.name].std,
        error=errors.by_run[run.name])
