"""Baseline: the single law that predicts the held-out run best, without asking what chance would reach."""

from pipeline.blind_trial.baselines.answers import named, nothing
from pipeline.blind_trial.baselines.regression import equations
from pipeline.blind_trial.baselines.rig import read
from pipeline.contract import ConfigError


def answer(folder):
    """The law whose fit to the training runs leaves least in the held-out ones, none where the nominal model does."""
    rig = read(folder)
    if not rig.held_out:
        raise ConfigError("baseline best_held_out", "a held-out run", "none", "set diagnosis.held_out")
    train, held = equations(rig, rig.runs), equations(rig, rig.held_out)

    def left(terms):
        residual = held.residual(terms, train.fit(terms))
        return residual @ residual

    ranked = sorted(train.library, key=lambda term: left((term,)))
    return nothing() if left(()) <= left((ranked[0],)) else named(ranked)
