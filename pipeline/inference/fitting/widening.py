"""Sizes that end far out of their priors have not been tried: they are tried again under wider ones."""

from dataclasses import replace

#: factor on the scale of a prior, and times that it is widened
WIDER, TIMES = 10.0, 3


def widened(catalogue, results, null, rules):
    """{index: Hypothesis} of those of a ``catalogue`` with wider priors whose fits among ``results`` {index: Refitted}
    better the Fit ``null`` beyond chance with a size that its prior all but excludes. A wider prior costs evidence.

    None of a size whose prior the case states: that is told.
    """
    size, wider = len(null.latent), {}
    for i, result in results.items():
        fit, candidate = result.fit, catalogue[i]
        if fit is None or fit.weights.max() * fit.betters(null) <= 2 * rules.decision.evidence_gain:
            continue
        parameters = tuple(p.widened(WIDER) if (p.sign * u or abs(u)) > rules.calibration.excluded else p
                           for p, u in zip(candidate.parameters, fit.latent[size:], strict=True))
        if parameters != candidate.parameters:
            wider[i] = replace(candidate, parameters=parameters)
    return wider
