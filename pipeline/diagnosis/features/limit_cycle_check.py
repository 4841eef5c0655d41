"""Verification by saturated squeal: features of recorded squeals beside those of simulated repeats.

Nothing is fitted and no verdict hangs on it. Every recorded point that slides is simulated from several small starts,
with the recalibrated nominal model and with the completed one; a feature agrees where its mean lies within the spread
of both.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.virtual_rig import only
from pipeline.contract import BrakechainError
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.diagnosis.signals.localisation import fitted
from pipeline.physics.signals.squeal_features import GROWING, SATURATED, agree, means, motion_features, saturated, state
from pipeline.physics.time_stepping.initial_state import random_kick, steady_start
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.virtual_rig.inputs import stated_inputs
from pipeline.physics.virtual_rig.normal_load import loaded
from pipeline.physics.virtual_rig.response import at_begin, run_friction
from pipeline.physics.virtual_rig.sensor import FRICTION_FORCE, NORMAL_FORCE, Sensor

#: who squeals, in the order of the tables
WHO = ("recorded", "recalibrated", "completed")
#: what a model shows beside the sensors: forces of all contacts
_NORMAL, _DRAWN = "normal force of the contacts", "friction of the contacts"


@dataclass(frozen=True)
class Heard:
    """States (r,) of the records of one point, and {feature: values over all saturated stretches}, {feature: unit}."""

    states: tuple
    values: dict
    unit: dict

    @property
    def squealing(self):
        return self.states.count(SATURATED)

    @property
    def growing(self):
        return self.states.count(GROWING)


@dataclass(frozen=True)
class Compared:
    """One recorded point: {who: Heard}; ``agrees`` {who: {feature: bool}} of the models; ``failure`` {who: why}."""

    heard: dict
    agrees: dict
    failure: dict

    @property
    def sentence(self):
        """Who squeals, in words."""
        sounds = {who: sound.squealing + sound.growing > 0 for who, sound in self.heard.items()}
        sentences = [f"{who}: {sound.squealing} of {len(sound.states)} saturated"
                     + (f", {sound.growing} still growing" if sound.growing else "")
                     for who, sound in self.heard.items()]
        sentences += [f"squeals in only one of recording and {who} model" for who, sound in sounds.items()
                      if sound != sounds["recorded"]]
        return "; ".join(sentences + [f"{who}: {why}" for who, why in self.failure.items()])


@dataclass(frozen=True)
class Squeals:
    """SquealComparison over {name: Recorded} of a Bench: {run: Compared}; ``settings`` the section SaturatedSqueal."""

    bench: object
    recorded: dict
    settings: object
    seed: int = 0

    def compared(self, recalibrated, completed):
        models = {"recalibrated": recalibrated}
        models |= {"completed": completed} if completed.hypothesis.effects else {}
        benches = {who: fitted(self.bench, fit) for who, fit in models.items()}
        return {name: self._compared(benches, records) for name, records in self._points().items()}

    def _points(self):
        """{run: its records} of runs that slide and show a motion, repeats with the run that they repeat."""
        points = {}
        for name, record in self.recorded.items():
            point = record.repeat_of or name
            wanted = not self.settings.runs or {name, point} & set(self.settings.runs)
            if wanted and at_begin(self.bench, record.run)[0] and self._motions(record.channels):
                points.setdefault(point, []).append(record)
        return points

    def _compared(self, benches, records):
        heard, failure = {"recorded": self._heard([dict(zip(r.channels, r.samples, strict=True)) for r in records],
                                                  records[0])}, {}
        for who, bench in benches.items():
            try:
                heard[who] = self._heard(simulated(bench, records[0], self.settings, self.seed), records[0])
            except BrakechainError as error:
                failure[who] = str(error)
        measured = heard["recorded"].values
        agrees = {who: {f: agree(measured[f], values, self.settings.tolerance) for f, values in sound.values.items()
                        if f in measured} for who, sound in heard.items() if who != "recorded"}
        return Compared(heard, agrees, failure)

    def _motions(self, channels):
        moves = {c.name: c.moves for c in self.bench.channels}
        return [name for name in channels if moves[name]]

    def _heard(self, motions, like):
        """Heard of [{channel: (n,)}] at the rate and with the units of the Recorded ``like``."""
        rate, names = like.run.sample_rate, self._motions(like.channels)
        size, unit = round(self.settings.stretch * rate), dict(zip(like.channels, like.unit, strict=True))
        states, all_values, units = [], {}, {}
        for motion in motions:
            together = np.array([motion[name] for name in names])
            states.append(state(together, size))
            if states[-1] == SATURATED:
                features = _features(motion, names, rate, size, saturated(together, size), self.settings.lowest, unit)
                units |= {feature: feature_unit for feature, (_, feature_unit) in features.items()}
                for feature, (stretches, _) in features.items():
                    all_values.setdefault(feature, []).extend(stretches)
        return Heard(tuple(states), {f: np.array(v) for f, v in all_values.items()}, units)


def simulated(bench, like, settings, seed=0):
    """[{channel: (n,)}] of the repeats of a Recorded run on a completed Bench, forces of its contacts beside."""
    speed, first = at_begin(bench, like.run)
    run = replace(like.run, duration=settings.duration, drive=speed,
                  inputs={name: float(np.ravel(value)[0]) for name, value in
                          zip(bench.model.input_name, stated_inputs(bench, like.run), strict=True)})
    there = loaded(bench, run)
    model = there.model.at_speed(speed)
    steady = steady_start(model, there.law, run_friction(there, run), first)
    system = modal_system(model)
    rows = np.array([bench.sensor(c.source) for c in bench.channels if c.moves])
    seen = only(bench, like.channels)
    seen = replace(seen, channels=(*seen.channels, Sensor(_NORMAL, NORMAL_FORCE, "contact"),
                                   Sensor(_DRAWN, FRICTION_FORCE, "contact")))
    names = tuple(c.name for c in seen.channels)
    motions = []
    for repeat in range(settings.repeats):
        start = steady.kicked(random_kick(system, rows, settings.kick, [seed, repeat]))
        motions.append(dict(zip(names, shown(seen, replace(run, start=start), names), strict=True)))
    return motions


def _features(motion, names, rate, size, stretches, lowest, unit):
    """{feature: (values (k,), unit)} of one motion {channel: (n,)}."""
    result = {}
    for name in names:
        features = motion_features(motion[name], rate, size, stretches, lowest)
        result |= {f"frequency of {name}": (features["frequency"], "Hz"),
                   f"level of {name}": (features["level"], unit[name])}
        result |= {f"{feature}, {name}": (values, "dB") for feature, values in features.items() if " over " in feature}
    result |= {f"mean of {name}": (means(motion[name], size, stretches), unit[name])
               for name in unit if name not in names}
    if _NORMAL in motion:
        normal, drawn = (means(motion[name], size, stretches) for name in (_NORMAL, _DRAWN))
        result["share of time open"] = means(motion[_NORMAL] <= 0, size, stretches), "1"
        result["friction over normal force"] = np.abs(drawn) / np.maximum(normal, 1e-300), "1"
    return result
