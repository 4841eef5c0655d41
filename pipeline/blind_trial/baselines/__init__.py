"""Other methods that answer the cases of a trial, to compare with: each sees the same two files.

A baseline is ``answer(folder)`` -> dict: it reads ``nominal.yaml`` and ``recordings.h5`` in the folder and returns at
least ``verdict`` and ``effects`` [{name, place, posterior*}] as diagnosis.json has them, ``alternatives``* where it
ranks more. A BrakechainError is a refusal. BASELINES names the module of each.
"""

from importlib import import_module

BASELINES = {name: f"pipeline.blind_trial.baselines.{name}" for name in (
    "largest_residual", "bic_library", "stlsq", "best_held_out")}


def load(name):
    """The function ``answer`` of a baseline."""
    return import_module(BASELINES[name]).answer
