"""From the course of a diagnosis to its product: hypotheses, parameters, errors, runs under three models."""

import numpy as np

from pipeline.diagnosis.experiment_design.next_run import next_experiment
from pipeline.diagnosis.question import label, split_name
from pipeline.diagnosis.signals.localisation import stage_of
from pipeline.inference.decision.candidate_statistics import unexplained
from pipeline.inference.decision.held_out import errors
from pipeline.inference.fitting.effective_sample_size import tempering
from pipeline.inference.fitting.noise import normalised_error
from pipeline.products import DiagnosedRun, Diagnosis, Follows, LatentForce, LatentPrediction, Located, SquealCheck

#: models that are compared, in the order of the tables
MODELS = ("nominal", "recalibrated", "completed", "noise")


def answer(question, found):
    """Product Diagnosis of a Question and the inference's Diagnosis over it."""
    first = found.base or found
    best = _best(found)
    table = _hypotheses(found)
    problem = question.problem
    fits = [errors(problem, question.budget, problem.nominal, first.null, best, part)
            for part in (problem.training, problem.held_out)]
    runs = {run.name: _run(question, run, fits[run.held_out]) for run in problem.runs}
    channels = tuple(question.units)
    axes = question.axes(found)
    latent = question.describe(found, axes)
    axes |= latent.regimes if latent else {}
    use = question.use(found, latent) if latent and found.decision.verdict == "unknown" else None
    return Diagnosis(
        verdict=found.decision.verdict, reason=list(found.decision.reasons), channel=channels,
        channel_unit=[question.units[c] for c in channels], **table, **_parameters(question, found, best, table),
        fit=[_part(told) for told in fits],
        unexplained_share=unexplained(first.null, best, question.rules),
        drift_p_value=found.drift.p_value, location={name: located(*axis) for name, axis in axes.items()},
        **_latent(latent), **_used(use, problem), **next_experiment(question, found), runs=runs,
        squeal={name: squeal_check(one) for name, one in (question.squeal(first.null, best) or {}).items()})


def located(location, unit="", edges=None):
    """Product Located of a Location; ``edges`` (n, 2) of bins in ``unit``."""
    edges = np.zeros((len(location.items), 2)) if edges is None else np.asarray(edges, float)
    return Located(item=[str(i) for i in location.items], low=edges[:, 0], high=edges[:, 1], unit=unit,
                   score=location.score, p_value=location.p_value, member=location.members.astype(int))


def squeal_check(compared):
    """Product SquealCheck of a Compared."""
    who, heard = list(compared.heard), list(compared.heard.values())
    unit = {feature: own for one in heard for feature, own in one.unit.items()}

    def table(number):
        return np.array([[number(name, one, f) if f in one.values else 0 for f in unit]
                         for name, one in compared.heard.items()]).reshape(len(who), len(unit))

    return SquealCheck(
        sentence=compared.sentence, who=who, records=[len(one.states) for one in heard],
        squealing=[one.squealing for one in heard], feature=list(unit), unit=list(unit.values()),
        known=table(lambda name, one, f: 1), mean=table(lambda name, one, f: one.values[f].mean()),
        spread=table(lambda name, one, f: one.values[f].std()),
        agrees=table(lambda name, one, f: int(compared.agrees.get(name, {}).get(f, False))))


def _latent(description):
    """Fields of the latent force of a Description or None."""
    if description is None:
        return {"latent_place": "", "latent_sentence": "", "latent": {}, "follows": {}}
    return {"latent_place": description.place, "latent_sentence": description.sentence,
            "latent": {name: LatentForce(time=one.time, force=one.force, std=one.std, displacement=one.displacement,
                                         velocity=one.velocity) for name, one in description.runs.items()},
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


def _best(found):
    """The Fit of the model that the decision completes: that of its first named hypothesis, else the nominal one."""
    named = [c.name for c in found.decision.named]
    return next((w.fit for name in named for w in found.weighed if w.candidate.name == name), found.null)


def _hypotheses(found):
    """Columns of the table of everything weighed; its probabilities sum to 1.

    Nothing missing first, then what is taken as known, alone, then the catalogue: candidates beside what is known.
    """
    known, screen = found.nominal.effects, found.screen
    weighed = {w.candidate.name: w for w in found.weighed}
    rows, share = [_row("nothing missing", (), "physics", posterior=found.posterior[0])], found.posterior
    if known:
        nothing = found.base.posterior[0]
        rows[0]["posterior"], share = nothing, (1 - nothing) * share
        rows.append(_alone(found) | {"posterior": share[0]})
    for k, candidate in enumerate(screen.candidates):
        own = weighed.get(candidate.name)
        rows.append(_screened(screen, k, own) | {
            "posterior": share[1 + k], "objection": _objection(found, candidate, own)})
    names = [row["hypothesis"] for row in rows]
    return {**{key: [row[key] for row in rows] for key in rows[0]},
            "named": [names.index(c.name) for c in found.decision.named], "known": [1] if known else []}


def _alone(found):
    """Row of what is taken as known, as it stood when it was weighed alone."""
    before, effects = found.base, found.nominal.effects
    k = next(k for k, c in enumerate(before.screen.candidates) if c.effects == effects)
    own = next(w for w in before.weighed if w.candidate.effects == effects)
    return _screened(before.screen, k, own)


def _screened(screen, k, own):
    """Row of the candidate of this index in a Screen; ``own``: it refitted, whose p-value the rule went by, or None."""
    candidate, judged = screen.candidates[k], own.contender if own else None
    return _row(candidate.name, candidate.effects, candidate.kind, score=max(float(screen.score[k]), -1e3),
                p_value=float(judged.p_value if judged else screen.p_value[k]), power=float(screen.power[k]),
                evidence_gain=judged.evidence_gain if judged else 0.0, refitted=int(own is not None))


def _objection(found, candidate, own):
    """Why a candidate was not judged, or what speaks against its fit."""
    return "; ".join(filter(None, (found.failures.get(candidate.name, ""), own.contender.forbidden if own else "",
                                   *(own.contender.doubts if own else ()))))


def _row(name, effects, kind, **values):
    row = {"hypothesis": name, "effect": " + ".join(e for e, _ in effects), "place": " + ".join(p for _, p in effects),
           "kind": kind, "stage": stage_of(effects), "posterior": 0.0, "score": 0.0, "p_value": 1.0, "power": 0.0,
           "evidence_gain": 0.0, "refitted": 0, "objection": ""}
    return row | values


def _spread(found, best):
    """{name: standard deviation} of the values of the Fit ``best``; what a model leaves counts as its noise.

    Where nothing could be named, values depend on what is missing: they are those of ``best`` or of a refitted
    candidate that fits better, each as likely as the others since none of them suffices.
    """
    unknown = found.decision.verdict == "unknown"
    models = [best, *(w.fit for w in found.weighed if unknown and w.fit.objective < best.objective)]
    spreads = [fit.spread(tempering(fit.noises, fit.residuals)) for fit in models]
    return {name: float(np.sqrt(np.mean([std[name] ** 2 + (fit.values[name] - value) ** 2
                                         for fit, std in zip(models, spreads, strict=True)])))
            for name, value in best.values.items()}


def _parameters(question, found, best, table):
    std, values = _spread(found, best), best.values
    owners = dict(zip(table["hypothesis"], range(len(table["hypothesis"])), strict=True))
    rows = []
    for parameter in best.hypothesis.parameters:
        effect, place, _ = split_name(parameter.name)
        given = parameter.nominal if parameter.null is None else parameter.null
        rows.append((parameter.name, parameter.unit, given, values[parameter.name], std[parameter.name],
                     owners.get(label(((effect, place),)), 0)))
    keys = ("parameter", "parameter_unit", "parameter_nominal", "parameter_value", "parameter_std", "parameter_owner")
    return {key: [row[k] for row in rows] for k, key in enumerate(keys)}


def _part(told):
    """Row of the table of fits from the Errors of one part; zeros where it has no runs."""
    return [told.before, told.recalibrated, told.after, told.noise_floor] if told.runs else [0.0] * len(MODELS)


def _run(question, run, told):
    """DiagnosedRun of one run of the Errors ``told``."""
    nominal, recalibrated, completed = told.predicted[run.name]
    return DiagnosedRun(
        held_out=int(run.held_out), time=np.arange(run.samples.shape[1]) / (run.rate or 1.0), measured=run.samples,
        valid=run.valid.astype(int), nominal=nominal, recalibrated=recalibrated, completed=completed,
        noise=question.budget[run.name].std, error=told.by_run[run.name])
