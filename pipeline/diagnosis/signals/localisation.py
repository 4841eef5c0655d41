"""Where forced recordings and the recalibrated nominal model differ: stage, place, run, band.

Stage: a bench seldom records what lies between two stages, so that nothing measured can be put in place of it; each
stage scores as the best of its hypotheses, and its probability is theirs together. Place: a force acts there that is an
unknown function of what moves there (displacement x and velocity v as recorded, up to third order, and the harmonics of
a turning drive); a force with any history at all would explain the few channels of a bench from every place alike.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import BrakechainError
from pipeline.contract.errors import sentence_of
from pipeline.diagnosis.problem import LocatedAxes
from pipeline.diagnosis.signals.deconvolution import EXTRA, motion, moved
from pipeline.diagnosis.signals.forward_model import STEP, completed, shown
from pipeline.diagnosis.signals.start_states import begun_as
from pipeline.effects import CATALOGUE
from pipeline.effects.effect import STAGES
from pipeline.effects.typical import ASPERITIES
from pipeline.inference.fitting.effective_sample_size import effective_share
from pipeline.inference.fitting.fit_state import whitened
from pipeline.inference.fitting.run_parameters import on_all_runs
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search import localisation
from pipeline.physics.virtual_rig.inputs import run_inputs
from pipeline.physics.virtual_rig.response import run_drive

#: octaves below the highest frequency of the records that are bands of their own
OCTAVES = 8
#: a stage of the chain as a hypothesis: that reading its map instead of computing at the points makes the difference
INTERPOLATION, MAP = "interpolation", "friction_map"
#: stages of a bench, and the solver
_STAGES = (*STAGES, "numerics")
#: rows of a smaller angle are one place: no recording tells them apart
_ALIKE = 1e-6
#: share of the rest that a unit force of the place axis has: of the largest root mean square force of a run
_SHARE = 0.1
#: divisors of that force that are tried one after the other
_SMALLER = (1, 10, 100, 1000)
#: harmonics of the drive's angle that a force may follow
_ORDERS = 3


@dataclass(frozen=True)
class Axes:
    """Locator by residuals alone: stage, run and frequency band.

    ``level``: power of the noise at most, in units of that of the budget; ``stages``: those that the mismatch can lie
    in.
    """

    problem: object
    budget: dict
    level: float = 1 + DEFAULTS.decision.noise_uncertainty
    draws: int = 2000
    seed: int = 0
    stages: tuple = _STAGES

    @classmethod
    def under(cls, problem, budget, settings, stages=_STAGES):
        """Axes under the settings of inference."""
        return cls(problem, budget, 1 + settings.rules.decision.noise_uncertainty, seed=settings.seed, stages=stages)

    def located(self, diagnosis):
        sampling = {"draws": self.draws, "seed": self.seed}
        whites = residuals(self.problem, self.budget, diagnosis.recalibrated)
        axes = {"stage": (stage_axis(diagnosis, self.stages), "", None),
                "run": (run_axis(whites, self.budget, self.level, **sampling), "", None)}
        if band := band_axis(self.problem.runs, whites, self.budget, self.level, **sampling):
            axes["band"] = band
        return axes


@dataclass(frozen=True)
class ForcedAxes:
    """Locator by ``Axes`` and by place, over ``runs`` {name: Run} of a Bench."""

    bench: object
    runs: dict
    residual: Axes

    def located(self, diagnosis):
        first = diagnosis.base or diagnosis
        axes = LocatedAxes(self.residual.located(diagnosis))
        runs = begun_as(self.runs, first.null.hypothesis, first.null.values)
        try:
            location = place_axis(fitted(self.bench, first.null), runs, first.null, first.weights,
                                  self.residual.draws, self.residual.seed)
        except Exception as error:
            axes.failures = (f"the place of the mismatch could not be computed: {sentence_of(error)}",)
            return axes
        return axes | {"place": (location, "", None)} if location else axes


def leading_place(axes, largest_p=0.05):
    """Index of the leading item of the axis place among axes of location; None where its p-value exceeds
    ``largest_p``."""
    if "place" not in axes:
        return None
    location = axes["place"][0]
    leader = int(np.argmax(location.score))
    return leader if location.p_value[leader] <= largest_p else None


def fitted(bench, fit):
    """The bench with the values and effects of a Fit."""
    return completed(bench, fit.hypothesis, fit.values)


def residuals(problem, budget, fit):
    """{run name: whitened residual (m,)} of a Fit on all runs, those held out included."""
    whites, error = whitened(problem, [budget[r.name] for r in problem.runs], fit.hypothesis,
                             on_all_runs(problem, budget, fit), problem.runs)
    if error:
        raise error
    return {run.name: white for run, white in zip(problem.runs, whites, strict=True)}


def stage_of(effects):
    """Stage of ((effect, place), ...) by the first; ``numerics`` for the solver, empty for none of the catalogue.

    What acts on asperities belongs to the stage of the chain that has them.
    """
    if effects and effects[0][1] == ASPERITIES:
        return "micro_friction"
    stages = {STEP: "numerics", INTERPOLATION: MAP, **{effect.name: effect.stage for effect in CATALOGUE}}
    return stages.get(effects[0][0], "") if effects else ""


def stage_axis(diagnosis, names=_STAGES):
    """Location over the stages ``names`` from what was screened and refitted (see the head of this file)."""
    first = diagnosis.base or diagnosis
    refitted = {w.candidate.name: w.statistics.posterior for w in first.weighed}
    score, p_value, share = np.full(len(names), -np.inf), np.ones(len(names)), np.zeros(len(names))
    for k, candidate in enumerate(first.screen.candidates):
        row = names.index(stage_of(candidate.effects))
        score[row] = max(score[row], first.screen.score[k])
        p_value[row] = min(p_value[row], first.screen.p_value[k])
        share[row] += refitted.get(candidate.name, 0.0)
    kept = np.flatnonzero(np.isfinite(score))
    share = share[kept] if share[kept].sum() > 0 else np.ones(len(kept))
    return localisation.Location(tuple(names[k] for k in kept), score[kept], p_value[kept],
                           localisation.credible_set(share / share.sum()))


def run_axis(whites, budget, level=1.0, draws=2000, seed=0):
    """Location over runs by the mean square of their whitened residuals; null: noise of power ``level``."""
    return _power_axis({name: [(white, effective_share(budget[name], white))] for name, white in whites.items()},
                       level, draws, seed)


def channel_axis(names, whites, budget, level=1.0, draws=2000, seed=0):
    """Location over the channels ``names`` that all runs have, by the same measure as over runs."""
    parts = {name: [] for name in names}
    for run, white in whites.items():
        share = effective_share(budget[run], white)
        for name, part in zip(names, budget[run].by_channel(white), strict=True):
            parts[name].append((part, share))
    return _power_axis(parts, level, draws, seed)


def _power_axis(parts, level, draws, seed):
    """Location over the names of {name: [(whitened residual (m,), share of it that is effective)]}."""
    power = np.array([np.mean(np.concatenate([white for white, _ in members]) ** 2) for members in parts.values()])
    count = np.array([sum(len(white) for white, _ in members) for members in parts.values()])
    real = np.array([sum(len(white) * share for white, share in members) for members in parts.values()])
    random = np.random.default_rng(seed)
    null = (random.gamma(count / 2, 2 / count, (draws, len(count))) - 1) * np.sqrt(count / 2)
    again = power * random.gamma(real / 2, 2 / real, (draws, len(count)))
    return localisation.against_null(tuple(parts), (power / level - 1) * np.sqrt(count / 2), null, again)


def band_axis(runs, whites, budget, level=1.0, draws=2000, seed=0):
    """(Location, "Hz", edges) over octaves of the whitened residuals of all runs of the most common rate, or None."""
    rates = [run.rate for run in runs if run.rate]
    if not rates:
        return None
    rate = max(rates, key=rates.count)
    parts = [part for run in runs if run.rate == rate for part in budget[run.name].by_channel(whites[run.name])]
    edges = np.concatenate(([0.0], 0.5 * rate * 2.0 ** np.arange(-OCTAVES, 1)))
    located = localisation.bands(np.concatenate(parts) / np.sqrt(level), rate, edges, draws, seed)
    return _named(located, "Hz"), "Hz", np.array(located.items)


def place_axis(bench, runs, null, weights, draws=2000, seed=0):
    """Location over joints, contact groups and points at the Fit ``null``, or None where no force would be seen."""
    size = _force(bench, [runs[run.name] for run in null.runs])
    bases = {}
    for name, rows in places(bench).items():
        whole = _pushed(bench, runs, null, rows, size).T
        if np.isfinite(whole).all() and whole.any():
            bases[name] = whole
    return localisation.places(tuple(bases), bases, null, weights, draws, seed) if bases else None


def places(bench):
    """{name: rows (r, n)} where a force can act: joints, contact groups (along and across their normal), points.

    Places of parallel rows are one, named ``first = second``, because no recording can tell them apart.
    """
    model, contacts = bench.model, bench.model.contacts
    rows_of = {str(name): np.atleast_2d(row) for name, row in zip(model.joints.name, model.joints.rows, strict=True)}
    for group in dict.fromkeys(("contact", *bench.groups)) if len(contacts.area) else ():
        members = bench.contacts(group)
        rows = np.array([contacts.tangent[members].mean(axis=0), contacts.normal[members].mean(axis=0)])
        rows_of[group] = rows[rows.any(axis=1)]
    rows_of |= {str(name): np.atleast_2d(row) for name, row in zip(model.sensor_name, model.sensor_rows, strict=True)
              if name not in rows_of}
    merged = []
    for name, rows in rows_of.items():
        if not rows.any():
            continue
        twin = next((m for m in merged if _alike(m[1], rows)), None)
        if twin:
            twin[0].append(name)
        else:
            merged.append(([name], rows))
    return {" = ".join(names): rows for names, rows in merged}


def drive_angle(bench, run):
    """Angle (samples,) of the drive in rad; None where nothing turns past a contact."""
    if not len(bench.model.contacts.area):
        return None
    speed = np.broadcast_to(run_drive(bench, run), run.samples)
    return np.cumsum(speed) / run.sample_rate if speed.any() else None


def _alike(first, second):
    if len(first) != len(second):
        return False
    first_rows, second_rows = (r / np.linalg.norm(r, axis=1, keepdims=True) for r in (first, second))
    return bool((1 - np.abs(np.sum(first_rows * second_rows, axis=1)) < _ALIKE).all())


def _force(bench, runs):
    """Force (N) of a unit function: a share of the largest root mean square input, else of what joints carry."""
    inputs = [float(np.sqrt(np.mean(np.square(i)))) for run in runs for i in run_inputs(bench, run)]
    loads = float(np.abs(bench.model.contacts.preload).sum())
    return _SHARE * (max([*inputs, loads]) or _joint_force(bench, runs) or 1.0)


def _joint_force(bench, runs):
    forces = [0.0]
    for row, k, c in zip(bench.model.joints.rows, bench.model.joints.stiffness, bench.model.joints.damping,
                         strict=True):
        for run in runs:
            x, v = moved(bench, run, row)
            forces.append(float(np.sqrt(np.mean((k * x + c * v) ** 2))))
    return max(forces)


def _pushed(bench, runs, null, rows, size):
    """``_basis``, by smaller forces where these drive the model beyond what it holds for; the change is scaled up."""
    for smaller in _SMALLER[:-1]:
        with suppress(BrakechainError):
            return _basis(bench, runs, null, rows, size / smaller) * smaller
    return _basis(bench, runs, null, rows, size / _SMALLER[-1]) * _SMALLER[-1]


def _basis(bench, runs, null, rows, size):
    """(q, m) whitened change by a force ``size`` times each function of the motion, along each of ``rows``."""
    unpushed_runs = [shown(bench, runs[run.name], run.channels) for run in null.runs]
    changes = []
    for row in rows:
        pushed = replace(bench, model=replace(bench.model, input_name=(*bench.model.input_name, EXTRA),
                                              input_rows=np.vstack((bench.model.input_rows, row))))
        parts = []
        tables = _tables(bench, runs, null, row)
        for run, noise, unpushed, table in zip(null.runs, null.noises, unpushed_runs, tables, strict=True):
            run_model = runs[run.name]
            parts.append(noise.whiten(np.array([
                shown(pushed, replace(run_model, inputs={**run_model.inputs, EXTRA: size * f}), run.channels) - unpushed
                for f in table])))
        changes.append(np.concatenate(parts, axis=1))
    return np.concatenate(changes)


def _tables(bench, runs, null, row):
    """[(q, n) functions of the motion along a row] of each run, of one scale over all runs."""
    moves = [motion(bench, row, runs[run.name], run, noise) for run, noise in zip(null.runs, null.noises, strict=True)]
    sizes = [np.sqrt(np.mean(np.concatenate(part) ** 2)) or 1.0 for part in zip(*moves, strict=True)]
    return [_functions(x / sizes[0], v / sizes[1], drive_angle(bench, runs[run.name]))
            for run, (x, v) in zip(null.runs, moves, strict=True)]


def _functions(x, v, angle):
    """Functions (q, n) of a motion: powers and products, a smooth sign, a constant, harmonics of an angle."""
    functions = [x, v, x**2, x * v, v**2, x**3, x**2 * v, x * v**2, v**3, np.tanh(5 * v), np.ones(len(x))]
    if angle is not None:
        functions += [f(k * angle) for k in range(1, _ORDERS + 1) for f in (np.cos, np.sin)]
    return np.array(functions)


def _named(location, unit):
    return replace(location, items=tuple(f"{low:.3g} to {high:.3g} {unit}" for low, high in location.items))
