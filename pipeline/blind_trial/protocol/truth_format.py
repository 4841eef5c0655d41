"""What a truth must say, in the words of docs/trial_sets.md: checked before it is sealed, and before it is scored."""

from numbers import Real

from pipeline.blind_trial.metrics.criteria import CLASSES
from pipeline.contract.errors import ConfigError

_NUMBERS = ("size", "noise", "left", "visible")


def check_truth(trial, truth):
    """Refuse a truth {case: ...} that does not speak of every case of a TrialSet alone, or not as it must."""
    where = trial.folder / "truth.json"
    apart = sorted(set(truth) ^ set(trial.cases))
    if apart:
        raise ConfigError(where, f"the {len(trial.cases)} cases of the folder",
                          f"{', '.join(apart[:5])} in only one of both")
    for number, case in truth.items():
        _check_case(f"{where}: {number}", case)


def _check_case(where, case):
    if case.get("class") not in CLASSES:
        raise ConfigError(f"{where}: class", f"one of {', '.join(CLASSES)}", repr(case.get("class")))
    _check_effects(f"{where}: effects", case.get("effects"))
    for effect in case["effects"]:
        _check_effects(f"{where}: alike of {effect['name']}", effect.get("alike", []))
    values = {f"parameters.{name}": value for name, value in case.get("parameters", {}).items()}
    for name, value in ({key: case[key] for key in _NUMBERS if key in case} | values).items():
        if not isinstance(value, Real):
            raise ConfigError(f"{where}: {name}", "a number", repr(value))


def _check_effects(where, effects):
    if not isinstance(effects, list) or not all(map(_is_effect, effects)):
        raise ConfigError(where, 'a list of {"name": ..., "place": ...}, [] for none', repr(effects))


def _is_effect(entry):
    return isinstance(entry, dict) and all(isinstance(entry.get(key), str) for key in ("name", "place"))
