"""The section ``diagnosis`` of a case: what may be wrong or missing, what was held out, how noise is known."""

from dataclasses import replace
from typing import Literal

from pipeline.contract import ConfigError, Quantity, Section, option
from pipeline.contract.units import to_si
from pipeline.diagnosis.published.harmonics import Harmonics
from pipeline.diagnosis.published.mode_table import ModeTable
from pipeline.diagnosis.published.squeal_frequencies import SquealLines
from pipeline.diagnosis.rules import RulesSection, rules_stated
from pipeline.inference.diagnosis import Settings as ProcedureSettings
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter, Uniform


class Prior(Section):
    """How far a nominal value may be off."""

    prior: Literal["log_normal", "normal", "half_normal", "uniform"] = option(
        "log_normal", "log_normal: positive, spread relative; normal: either sign; half_normal: zero or more")
    spread: float = option(0.2, "log_normal: standard deviation of the logarithm, 0.2 = about 20 %", gt=0)
    std: str | float | None = option(None, "normal: standard deviation; half_normal: root mean square")
    low: str | float | None = option(None, "uniform: lower end")
    high: str | float | None = option(None, "uniform: upper end")


class NominalPrior(Prior):
    """The same of a value of the nominal model."""

    between_runs: str | float | None = option(None, "standard deviation by which the value differs from run to run, as"
                                                    " after reassembly or with temperature: log_normal: relative, 0.02"
                                                    " = 2 %; else with its unit; none = it is the same in all")


class NoiseOf(Section):
    """What is known of the noise of the channels; none of it: from repeats of runs."""

    std: dict[str, str | float] = option({}, "standard deviation by channel, with its unit")
    above: Quantity("Hz", gt=0) | None = option(None, "frequency above which recordings hold nothing but noise")
    levels: tuple[float, ...] = option((0.5, 2.0, 4.0), "noise, as multiples of what is known of it, at which the"
                                                        " verdict is told too")


class PlannedInput(Section):
    """A sine sweep that a planned run feeds to an input."""

    amplitude: Quantity("N", gt=0) = option(..., "amplitude")
    start: Quantity("Hz", ge=0) = option("1 Hz", "frequency at the begin")
    end: Quantity("Hz", ge=0) = option("10 Hz", "frequency at the end")


class PlannedRun(Section):
    """A run that could be recorded."""

    duration: Quantity("s", gt=0) = option(..., "length")
    sample_rate: Quantity("Hz", gt=0) = option(..., "samples per second of every channel")
    inputs: dict[str, PlannedInput] = option({}, "input of the model: what it is fed")
    speed: Quantity("rad/s") | None = option(None, "speed of the drive; none = that of the bench")
    cost: float = option(1.0, "what it costs, in any unit", gt=0)


class Plan(Section):
    """What could be recorded, and what it should be able to name: 'brakechain plan'."""

    runs: dict[str, PlannedRun] = option({}, "runs that could be recorded")
    wanted: tuple[str, ...] = option((), "effects that the cheapest set of runs must be able to name; none = all")
    needed: float = option(4.0, "standard deviations that naming takes", gt=0)


class SpotRuns(Section):
    """Runs of the rough pair between which friction is interpolated."""

    pressures: int = option(8, "nominal pressures, evenly in their logarithm", ge=4)
    distances: int = option(10, "sliding distances", ge=4)
    reach: float = option(1.6, "how far beyond the recorded pressures and distances the runs go, as a factor", ge=1)
    model_error: float = option(0.02, "relative standard deviation of computed friction and wear by mesh and cycles;"
                                      " the refinement of micro_friction tells it", gt=0)


class LatentForce(Section):
    """What the force is used for that stands for physics which the catalogue does not hold."""

    predict: bool = option(False, "at verdict unknown, predict the held-out runs by the nominal model with the latent"
                                  " force, as a function of what it follows: description, not identified physics")


class SaturatedSqueal(Section):
    """Simulated repeats of recorded squeals."""

    repeats: int = option(3, "simulated repeats of each model, each from another small start", ge=3)
    runs: tuple[str, ...] = option((), "recorded runs; none = all that slide")
    duration: Quantity("s", gt=0) = option("0.5 s", "length of every simulated motion")
    stretch: Quantity("s", gt=0) = option("25 ms", "stretches into which motions are cut")
    kick: Quantity("m/s", gt=0) = option("1 mm/s", "effective value of the start velocities at the sensors")
    lowest: Quantity("Hz", gt=0) = option("200 Hz", "frequencies are sought above it")
    tolerance: float = option(2.0, "standard deviations of both spreads together within which means agree", gt=0)


class Settings(Section):
    """What is asked."""

    forward: Literal["simulation", "poles", "lines", "friction"] = option(
        "simulation", "simulation: samples as bench.forward predicts them; poles: poles of free vibrations by complex"
        " eigenvalues, as bench.poles says; lines: published lines or modes are compared; friction: measured friction"
        " and worn faces against micro_friction")
    rubbing: SpotRuns = option(SpotRuns(), "forward friction: the runs of the rough pair")
    lines: ModeTable | Harmonics | SquealLines | None = option(None, "forward lines: which lists are compared, and how")
    parameters: dict[str, NominalPrior] = option({}, "nominal values that may be wrong, by name as in"
                                                     " bench.corrections; of an effect that the case states:"
                                                     " coulomb@guide.force")
    nuisances: tuple[Literal["loads", "zeros", "drifts", "cogging"], ...] = option(
        (), "hidden values that are fitted beside every hypothesis where the data ask for them: loads, a constant force"
            " along each joint, as of a weight or a cable; zeros and drifts of the channels; cogging of the joints that"
            " effects.cogging gives a period")
    held_out: tuple[str, ...] = option((), "runs that are kept for verification and never fitted")
    effects: tuple[str, ...] = option((), "effects that are weighed; none = the whole catalogue")
    without: tuple[str, ...] = option((), "effects that are not weighed, because they are known not to be there")
    places: tuple[str, ...] = option((), "places that are weighed; none = all")
    priors: dict[str, Prior] = option({}, "what is known of effects, as in compliant_arm.compliance: {...}; for the"
                                          " others priors of the sizes that nominal runs have")
    next: dict[str, tuple[str | float, ...]] = option({}, "what could be recorded next, by the condition (normal_load,"
                                                          " speed, drive, an input) or number of the bench that would"
                                                          " change: values with a unit, or factors; forward equation:"
                                                          " also motion (size) and pace, none = within the recorded"
                                                          " ones; forward poles: none = recorded loads and speeds")
    noise: NoiseOf = option(NoiseOf(), "noise of the recordings")
    solver: bool = option(True, "weigh the solver too, by halving its step")
    latent_force: LatentForce = option(LatentForce(), "use of the latent force")
    saturated_squeal: SaturatedSqueal | None = option(None, "forward poles: verify by simulated squeals; none = not")
    plan: Plan = option(Plan(), "runs that could be recorded, for 'brakechain plan'")
    time: Quantity("s", gt=0) = option("5 min", "CPU time of a core for what is fitted; what was not tried by then is"
                                              " told, and nothing is named before all was tried")
    kept: int = option(8, "candidates that are refitted in the full model", ge=1)
    draws: int = option(20000, "draws of the null of the screen", ge=100)
    seed: int = option(0, "seed of all draws", ge=0)
    rules: RulesSection = option(RulesSection(), "thresholds of every step, from the recordings to the verdict")


def procedure(settings, few=False, starts=ProcedureSettings.starts):
    """Settings of inference under a filled section ``diagnosis``; ``few``: runs hold a few dozen numbers each."""
    rules = rules_stated(settings)
    if few:
        rules = replace(rules, decision=replace(rules.decision, posterior=rules.decision.posterior_of_few))
    return ProcedureSettings(settings.kept, starts, settings.draws, settings.seed, rules, seconds=settings.time)


def parameter(name, unit, value, given, where):
    """Parameter of a nominal number of ``value`` with the section ``given``; ConfigError as ``prior_of``."""
    return Parameter(name, unit, value, prior_of(unit, value, given, where))


def prior_of(unit, value, given, where):
    """Prior in ``unit`` about a nominal ``value``, as a section ``given`` states it; ConfigError without a size."""
    def size(key):
        value = getattr(given, key)
        if value is None:
            raise ConfigError(f"{where}.{key}", f"a value, because the prior is {given.prior}", "none")
        return to_si(value, unit, f"{where}.{key}")

    if given.prior == "log_normal" and not value > 0:
        raise ConfigError(f"{where}.prior", "normal, half_normal or uniform, because the nominal value is not positive",
                          f"log_normal about {value:g} {unit}")
    return {"log_normal": lambda: LogNormal(value, given.spread), "normal": lambda: Normal(value, size("std")),
            "half_normal": lambda: HalfNormal(size("std")),
            "uniform": lambda: Uniform(size("low"), size("high"))}[given.prior]()
