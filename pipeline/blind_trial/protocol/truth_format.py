"""What a truth must say, in the words of docs/trial_sets.md: checked before it is sealed, and before it is scored."""

from numbers import Real

from pipeline.blind_trial.metrics.criteria import CLASSES
from pipeline.contract.errors import ConfigError

_NUMBERS = ("size", "noise", "left", "visible")


def check_truth(found, truth):
    """Refuse a truth {case: ...} that does not speak of every case of a TrialSet alone, or not as it must."""
    where = found.folder / "truth.json"
    apart = sorted(set(truth) ^ set(found.cases))
    if apart:
        raise ConfigError(where, f"the {len(found.cases)} cases of the folder",
                          f"{', '.join(apart[:5])} in only one of both")
    for number, one in truth.items():
        _check_case(f"{where}: {number}", one)


def _check_case(where, one):
    if one.get("class") not in CLASSES:
        raise ConfigError(f"{where}: class", f"one of {', '.join(CLASSES)}", repr(one.get("class")))
    _check_effects(f"{where}: effects", one.get("effects"))
    for effect in one["effects"]:
        _check_effects(f"{where}: alike of {effect['name']}", effect.get("alike", []))
    own = {f"parameters.{name}": value for name, value in one.get("parameters", {}).items()}
    for name, value in ({key: one[key] for key in _NUMBERS if key in one} | own).items():
        if not isinstance(value, Real):
            raise ConfigError(f"{where}: {name}", "a number", repr(value))


def _check_effects(where, effects):
    if not isinstance(effects, list) or not all(map(_is_effect, effects)):
        raise ConfigError(where, 'a list of {"name": ..., "place": ...}, [] for none', repr(effects))


def _is_effect(one):
    return isinstance(one, dict) and all(isinstance(one.get(key), str) for key in ("name", "place"))
