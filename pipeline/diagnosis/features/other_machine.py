"""Whether poles were recorded on the machine of the model: a few far from all its modes are missing physics or a value
that is far off, many are another machine.

Far off before any fit, they are refused; far off still when all values have been fitted, nothing is named.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import BrakechainError, ConfigError
from pipeline.diagnosis.features.pairing import assigned
from pipeline.diagnosis.rules import PoleRules
from pipeline.physics.virtual_rig.modes import modes

#: fewer poles than these are of no other machine, whatever their share
_FEWEST = 4
#: how many frequencies a sentence lists
_LISTED = 4


def refuse(bench, shown, rules):
    """ConfigError where many poles of {run: Features} ``shown`` lie far from those of a Bench with its given values."""
    far, count = {}, 0
    for name, features in shown.items():
        if features.seen is None or not len(features.seen.root):
            continue
        try:
            root, shape = modes(bench, features.run)
        except BrakechainError:         # no steady state with these values: a fit may find one
            continue
        nearest = root[assigned(features.seen, root, features.shown(shape), rules)]
        seen = features.seen.root.imag / (2 * np.pi)
        beyond = abs(np.log(features.seen.root.imag / nearest.imag)) > rules.other_machine
        far[name], count = seen[beyond], count + len(seen)
    if _many(far, count, rules):
        raise ConfigError("diagnosis", "recordings of the machine of the case, whose poles lie within"
                          f" {rules.other_machine:.0%} of its modes", f"{_told(far, count)} farther off",
                          "is this a recording of that machine? Compare drawing, loads and sensors with the case, or"
                          " correct the values that are far off")


@dataclass(frozen=True)
class OtherMachine:
    """Revision of the product Diagnosis of poles: nothing is named where many lie off whatever the values."""

    rules: PoleRules

    def revised(self, product, diagnosis):
        far, count = {}, 0
        pole = np.array([str(c).startswith("pole") and str(c).endswith("frequency") for c in product.channel])
        for name, run in product.runs.items():
            there = pole & (run.valid[:, 0] > 0)
            measured = run.measured[there, 0]
            off = np.min([abs(model[there, 0] / measured - 1) for model in (run.recalibrated, run.completed)], axis=0)
            far[name], count = measured[off > self.rules.missed], count + len(measured)
        if not _many(far, count, self.rules):
            return product
        sentence = (f"{_told(far, count)}: more than {self.rules.missed:.0%} off any mode of the model, whatever its"
                    " values. Is this a recording of the machine that the case describes?")
        none = np.zeros(0, int)
        return replace(product, verdict=np.array("unknown", dtype=object), named=none, known=none,
                       family=np.array("", dtype=object), model_error=np.ones(()), in_part=np.zeros((), int),
                       leading=none, leading_set=none, leading_takes=np.zeros(0), leading_stays=np.zeros(0),
                       other_machine=np.array(sentence, dtype=object),
                       reason=np.array([sentence, *product.reason], dtype=object))


def _many(far, count, rules):
    """Whether ``far`` {run: (n,) Hz} of ``count`` poles are of another machine."""
    found = [len(lines) for lines in far.values()]
    return max(found, default=0) >= _FEWEST and sum(found) > rules.other_share * count


def _told(far, count):
    """'71 of 198 poles (in rest_1: 361, 365, 437, 459, ... Hz)' of {run: (n,) Hz}, from the run with most."""
    worst = max(far, key=lambda name: len(far[name]))
    lines = ", ".join(f"{line:.0f}" for line in far[worst][:_LISTED])
    more = ", ..." if len(far[worst]) > _LISTED else ""
    return f"{sum(map(len, far.values()))} of {count} poles (in {worst}: {lines}{more} Hz)"
