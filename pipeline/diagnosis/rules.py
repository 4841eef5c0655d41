"""The rules of a diagnosis: those of inference, and what decides in recordings, latent forces and published lists.

They are settings of a case (section ``diagnosis.rules``) and a table of the product.
"""

from dataclasses import dataclass, fields

from pipeline.contract.settings import option, section
from pipeline.inference import rules as inference
from pipeline.inference.rules import threshold


@dataclass(frozen=True)
class LatentForceRules:
    """When a force is described that stands for physics outside the catalogue."""

    place_p: float = threshold(0.05, "largest p-value of the leading place at which a latent force is described")
    dependence_p: float = threshold(0.01, "largest p-value of a dependence that the force is said to follow")
    above_noise: float = threshold(4.0, "power over that of the noise up to whose highest frequency residuals are"
                                        " turned into a force")


@dataclass(frozen=True)
class PoleRules:
    """How poles of recordings are paired with eigenvalues, and how well they are known."""

    near: float = threshold(0.1, "typical prior error of an eigenvalue, as a fraction of its size")
    far: float = threshold(3.0, "such errors beyond which distance no longer outweighs the mode shape")
    reach: float = threshold(0.1, "distance, as a fraction of a pole, beyond which an eigenvalue no longer draws")
    unresolved: float = threshold(0.05, "standard deviation of a pole as a fraction of the resolution of its record")
    gain_std: float = threshold(0.005, "standard deviation of the logarithm of a ratio of gains, at least")
    delay_std: float = threshold(1e-6, "standard deviation of a delay between channels, at least", "s")
    heard: float = threshold(0.02, "amplitude at a sensor, as a fraction of its largest, from which a mode counts")
    other_machine: float = threshold(0.25, "logarithm of the ratio of a recorded frequency to that of its mode beyond"
                                            " which it is far from the model with its given values")
    missed: float = threshold(0.03, "the same, as a fraction, once all values are fitted")
    other_share: float = threshold(0.25, "share of such poles at which recordings are of another machine")


@dataclass(frozen=True)
class ListRules:
    """When published lines differ from a model, and when agreement is more than chance."""

    differs_p: float = threshold(0.05, "largest p-value, over all lists, of one that differs from the model")
    outlying: float = threshold(3.0, "standard deviations beyond which a line counts as one that differs")
    factor_p: float = threshold(0.05, "p-value above which one factor on all frequencies explains the rows")
    change: float = threshold(0.1, "relative change of frequencies that an alternative of the model makes")
    anywhere: float = threshold(2.0, "prior scale of an alternative whose line could lie anywhere")
    twins: float = threshold(0.01, "relative distance of two computed lines of one pair")
    farthest: float = threshold(1.25, "frequency ratio beyond which a computed mode is not that of a row")
    half_std: float = threshold(0.25, "standard deviation of a line that stands or does not (0 or 1)")
    soft: float = threshold(10.0, "uncertainty of where the range of a spectrum ends", "dB")
    chance: float = threshold(0.01, "probability of agreement by chance that all lists share")
    axial: float = threshold(0.5, "axial fraction of a shape from which a laser along the axis sees it")
    worth_telling: float = threshold(0.01, "probability below which alternatives are not reported beside the one taken"
                                           " as known")
    next_value: float = threshold(1e-3, "expected information below which a record is not proposed", "nat")


@dataclass(frozen=True)
class DiagnosisRules(inference.Rules):
    """The rules of all steps and all kinds of data."""

    latent_force: LatentForceRules = LatentForceRules()
    poles: PoleRules = PoleRules()
    lists: ListRules = ListRules()


def rules_stated(settings):
    """DiagnosisRules of a filled section ``diagnosis``."""
    return DiagnosisRules(**{group.name: group.type(**dict(getattr(settings.rules, group.name)))
                             for group in fields(DiagnosisRules)})


#: the rules as they are where a case says nothing else
DEFAULTS = DiagnosisRules()


def _group(group):
    """Section of one group of rules."""
    return section(group.type.__name__, group.type.__doc__, {
        rule.name: (rule.type, option(rule.default, _meaning(rule), gt=0)) for rule in fields(group.type)})


def _meaning(rule):
    unit = rule.metadata["unit"]
    return rule.metadata["meaning"] + ("" if unit == "1" else f" [{unit}]")


_GROUPS = {group.name: _group(group) for group in fields(DiagnosisRules)}
RulesSection = section("RulesSection", "Thresholds of every step, from the recordings to the verdict.", {
    name: (kind, option(kind(), kind.__doc__)) for name, kind in _GROUPS.items()})
