"""The force that is missing at a place, whatever its physics: from residuals back to a force, and what it follows.

Residuals are deconvolved (``deconvolution``), a Gaussian process smooths the force (``inference.unknown``), and what
it follows is tested against circular shifts of it.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.diagnosis.rules import DEFAULTS, DiagnosisRules
from pipeline.diagnosis.signals.deconvolution import FADE, deconvolved
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.diagnosis.signals.latent_force_law import LABEL, used
from pipeline.diagnosis.signals.localisation import drive_angle, fitted, leading_place, places
from pipeline.diagnosis.signals.start_states import begun_as
from pipeline.inference.fitting.run_parameters import on_all_runs
from pipeline.inference.search import gp_latent_force, localisation

#: samples from which the covariance of the force is estimated
LEARNED = 2000
#: samples of a run at which its force is told, at least
FEWEST = 64
BINS = 7


@dataclass(frozen=True)
class LatentRun:
    """Per sample (n,): ``time`` s, ``force`` N with ``std``, ``displacement`` m and ``velocity`` m/s at the place."""

    time: np.ndarray
    force: np.ndarray
    std: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    angle: np.ndarray | None


@dataclass(frozen=True)
class Description:
    """``runs`` {name: LatentRun} of the force at ``location``; ``follows``: (Dependence, unit of its regressor);
    ``regimes``: axes of location."""

    location: str
    runs: dict
    follows: tuple
    regimes: dict
    sentence: str


@dataclass(frozen=True)
class Describe:
    """LatentForces over {name: Run} of a Bench: at the leading place, where it is significant."""

    bench: object
    runs: dict
    problem: object
    budget: dict
    rules: DiagnosisRules = DEFAULTS
    draws: int = 2000
    seed: int = 0

    def described(self, diagnosis, axes):
        leader = leading_place(axes, self.rules.latent_force.place_p)
        if leader is None:
            return None
        begun = self._begun(diagnosis)
        runs = {r.name: (begun[r.name], r, self.budget[r.name]) for r in self.problem.runs}
        return describe(fitted(self.bench, diagnosis.recalibrated), runs, [r.name for r in self.problem.held_out],
                        axes["place"][0].items[leader], self.draws, self.seed, self.rules.latent_force)

    def predicted(self, diagnosis, description):
        """LatentUse of a Description on the held-out runs."""
        return used(self.bench, places(self.bench)[description.location][0], description, self.problem, self.budget,
                    diagnosis.recalibrated, SimulatedRuns(self._begun(diagnosis)), self.rules)

    def _begun(self, diagnosis):
        """{name: Run} with the starts of the recalibrated nominal model."""
        hypothesis = diagnosis.recalibrated.hypothesis
        latent = on_all_runs(self.problem, self.budget, diagnosis.recalibrated)
        return begun_as(self.runs, hypothesis, hypothesis.values(latent))


@dataclass(frozen=True)
class SimulatedRuns:
    """Simulator: what the channels of ``runs`` {name: Run} show on a Bench."""

    runs: dict

    def simulated(self, bench, run):
        return shown(bench, self.runs[run.name].until(run.samples.shape[1]), run.channels)


def describe(bench, runs, held_out, location, draws=2000, seed=0, rules=DEFAULTS.latent_force):
    """Description of the force missing at ``location`` of a fitted Bench, or None where no frequency rises above noise.

    ``runs`` {name: (Run, Observed, Noise)}; runs ``held_out`` are transformed, but nothing is learned from them.
    """
    row = places(bench)[location][0]
    forces = {name: force for name, parts in runs.items()
              if (force := latent_run(bench, row, *parts, rules.above_noise)) is not None}
    learned = [force for name, force in forces.items() if name not in held_out]
    if not learned:
        return None
    follows = dependences(learned, seed)
    return Description(location, forces, follows, regimes(learned, draws, seed),
                       sentence(location, learned, follows, rules.dependence_p))


def latent_run(bench, row, run, observed, noise, above_noise=DEFAULTS.latent_force.above_noise):
    """LatentRun of one run along a row (n,), or None where the residual says nothing."""
    residual = deconvolved(bench, row, run, observed, noise, above_noise)
    if residual is None:
        return None
    count = run.samples
    every = max(1, min(int(run.sample_rate / (4 * residual.highest)), int((1 - 2 * FADE) * count) // FEWEST))
    chosen = slice(int(FADE * count), int((1 - FADE) * count), every)
    raw, rate = residual.force[chosen], run.sample_rate / every
    learned = gp_latent_force.latent_force(raw[:LEARNED], rate)
    smooth = gp_latent_force.smooth(raw, rate, learned.size, learned.length, learned.noise)
    angle = drive_angle(bench, run)
    return LatentRun(run.time[chosen], smooth.mean, smooth.std, residual.displacement[chosen],
                     residual.velocity[chosen], None if angle is None else angle[chosen])


def dependences(runs, seed=0):
    """(Dependence, unit) of the force of LatentRuns on displacement, velocity, angle of the drive and time."""
    force, x, v = (np.concatenate([getattr(r, key) for r in runs]) for key in ("force", "displacement", "velocity"))
    follows = [(gp_latent_force.dependence("displacement", force, x, seed=seed), "m"),
             (gp_latent_force.dependence("velocity", force, v, seed=seed), "m/s")]
    if all(r.angle is not None for r in runs):
        angle = np.concatenate([r.angle for r in runs])
        turned = gp_latent_force.dependence("angle of the drive", force, np.mod(angle, 2 * np.pi), seed=seed)
        share, p_value = gp_latent_force.order_locked(force, angle, seed=seed)
        follows.append((replace(turned, share=share, p_value=p_value), "rad"))
    return (*follows, (_drift(max(runs, key=lambda r: len(r.time)), seed), "s"))


def _drift(run, seed):
    """Dependence of the size of the force on time within one run."""
    share, p_value = gp_latent_force.slow_drift(run.force, seed=seed)
    parts = np.array_split(np.arange(len(run.time)), 32)
    return gp_latent_force.Dependence("time", share, p_value, np.array([run.time[p].mean() for p in parts]),
                              np.array([np.sqrt(np.mean(run.force[p] ** 2)) for p in parts]))


def regimes(runs, draws=2000, seed=0):
    """{axis: (Location, unit, edges)} of the power of the force over amplitude, velocity and time of the runs."""
    power = np.concatenate([r.force**2 for r in runs])
    axes = {"amplitude": (np.concatenate([np.abs(r.displacement) for r in runs]), "m"),
            "velocity": (np.concatenate([r.velocity for r in runs]), "m/s"),
            "time": (np.concatenate([r.time for r in runs]), "s")}
    located = {}
    for name, (coordinate, unit) in axes.items():
        edges = np.unique(np.quantile(coordinate, np.linspace(0, 1, BINS + 1)))
        if len(edges) > 2 and power.any():
            at = localisation.regimes(power, coordinate, edges, draws, seed)
            named = tuple(f"{low:.3g} to {high:.3g} {unit}" for low, high in at.items)
            located[name] = (localisation.Location(named, at.score, at.p_value, at.members), unit, np.array(at.items))
    return located


def sentence(location, runs, follows, largest_p=DEFAULTS.latent_force.dependence_p):
    """What the force is and follows, in one sentence."""
    force = np.concatenate([r.force for r in runs])
    power = float(np.mean(force * np.concatenate([r.velocity for r in runs])))
    clear = sorted((f for f, _ in follows if f.p_value <= largest_p), key=lambda f: -f.share)
    regressors = " and ".join(f"the {f.name} ({100 * f.share:.0f} % of its variation)" for f in clear[:2])
    return (f"At {location} a force of {np.sqrt(np.mean(force**2)):.3g} N root mean square is missing; it"
            f" follows {regressors or 'neither displacement nor velocity nor time clearly'} and"
            f" {'takes' if power < 0 else 'puts'} {abs(power):.3g} W {'out' if power < 0 else 'in'} on average:"
            f" {LABEL}.")

