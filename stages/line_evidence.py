"""Stage line_evidence: which explanation of a squeal makes the lines that a bench heard most probable?

Every hypothesis predicts tones for each draw of the declared scatter, from its unstable modes at the operating points
of the tests; the lines heard in each test, and the silence of others, weigh the hypotheses.
"""

from functools import partial

import numpy as np

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import DEFAULT, Source, family, fitting, friction_errors
from pipeline.contract import ConfigError, Context, ConvergenceError, Quantity, Section, option, stage
from pipeline.diagnosis.published.completed_case import chosen, companions
from pipeline.diagnosis.published.line_hypotheses import (
    FLEXIBLE,
    RIGID,
    Hypothesis,
    check_hypotheses,
    drawn,
    on_rigid_disc,
    same_solution,
)
from pipeline.diagnosis.published.line_tests import cycle_tests, record_tests, run_tests
from pipeline.diagnosis.published.line_weighing import predicted, weighed
from pipeline.diagnosis.published.pressure_cycle import Cycle, cycle_fields, no_cycle
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.products import ComplexModes, Effects, FrictionMap, LineEvidence, NoiseEvents, Recording, ReducedModel

#: draws of one task of the fan-out
_CHUNK = 10


class Settings(Section):
    """The lines, the operating points of the bench, the hypotheses and what they leave open."""

    run: str = option("bench", "recorded run of a cycle of changing load, beside a test at constant load without lines")
    runs: tuple[str, ...] = option(
        (), "instead: recorded runs, each a test at the pressure and the speed among its conditions, with a list of its"
        " lines, empty where it was silent; none = after noise_events all runs that it has searched")
    pressure_factor: float = option(1.0, "nominal pad pressure over that of the runs: area of the piston over that of"
                                    " the pad where these state the pressure in the line", gt=0)
    pressure_within: float = option(0.05, "share within which the pressures of records are those of structure", gt=0,
                                    lt=0.5)
    list: str = option("laser", "list of lines in a run")
    disc: tuple[str, ...] = option(("disc",), "bodies that are the disc", min_length=1)
    low: Quantity("Hz", ge=0) = option("1.25 kHz", "lower end of the band in which lines could be heard")
    high: Quantity("Hz", gt=0) = option("20 kHz", "upper end, at most that of complex_modes")
    unexplained: float = option(0.1, "mean number of lines there that no hypothesis explains", gt=0)
    heard: tuple[float, float] = option(
        (0.1, 0.9), "share of the growing tones that are heard in a test: range, uniformly distributed")
    elsewhere: float = option(
        0.05, "probability that a tone is heard in a test in which it does not grow", gt=0, lt=0.5)
    model_error: float = option(0.01, "relative standard deviation of a predicted frequency", gt=0, lt=0.1)
    silent_up_to: Quantity("Pa", gt=0) = option(
        "0.8 MPa", "pressures of structure up to it are the test at constant load beside a cycle, others the cycle")
    constant_speed: Quantity("rad/s", gt=0) = option("8.5 rad/s", "speed of the test at constant load")
    cycle_speed: Quantity("rad/s", gt=0) = option(
        "8.5 rad/s", "speed of the cycle at its highest pressure; at others so that pressure times speed is the same")
    hypotheses: dict[str, Hypothesis] = option(
        {"one_way": {"disc": RIGID, "harmonics": True}, "flexible_disc": {"disc": FLEXIBLE}}, "what is compared")
    cycle: Cycle | None = option(None, "the cycle of pressure, run with the nominal values and with those of the most"
                                       " probable draw of a flexible disc; none = not run")
    reference: str = option("one_way", "hypothesis that Bayes factors refer to")
    sources: tuple[Source, ...] = option(DEFAULT, "what scatters, as of probability; hypotheses replace some")
    draws: int = option(100, "draws of each hypothesis, an even number", ge=20, multiple_of=2)
    seed: int = option(11, "seed of the draws", ge=0)
    training: int = option(4, "further draws of each hypothesis that the common bases are made to serve", ge=1)
    smallest_correction: float = option(
        1e-2, "corrections of the common bases below this share of the modal amplitude are left out", gt=0)


def _check(sections):
    settings = sections["line_evidence"]
    check_hypotheses(settings.hypotheses, settings.sources, "line_evidence")
    if settings.reference not in settings.hypotheses:
        raise ConfigError("line_evidence.reference", f"one of {', '.join(settings.hypotheses)}", settings.reference)
    if {h.disc for h in settings.hypotheses.values()} != {FLEXIBLE, RIGID}:
        raise ConfigError("line_evidence.hypotheses", "some with a flexible and some with a rigid disc", "one kind")
    if not 0 < settings.heard[0] < settings.heard[1] < 1:
        raise ConfigError("line_evidence.heard", "two rising shares between 0 and 1", str(list(settings.heard)))
    if settings.cycle is not None and not settings.cycle.low < settings.cycle.high:
        raise ConfigError("line_evidence.cycle.high", f"more than low, {settings.cycle.low:g} Pa",
                          f"{settings.cycle.high:g} Pa")
    if settings.cycle is not None and "friction_map" in sections and sections["friction_map"].bulk_temperature:
        raise ConfigError("line_evidence.cycle", "friction_map.bulk_temperature: 0 K beside it, as the cycle fades"
                          " friction by a temperature of its own", f"{sections['friction_map'].bulk_temperature:g} K")
    if (settings.runs or "noise_events" in sections) and any(h.load_rate for h in settings.hypotheses.values()):
        raise ConfigError("line_evidence.hypotheses", "no load_rate, as every run of line_evidence.runs has one load",
                          "a changing load")
    if "friction_map" not in sections:
        _refuse_pressure(settings)
    if not settings.low < settings.high:
        raise ConfigError("line_evidence.high", f"more than low, {settings.low:g} Hz", f"{settings.high:g} Hz")


def _refuse_pressure(settings):
    every = (*settings.sources, *(s for h in settings.hypotheses.values() for s in h.sources))
    if any(source.kind == "friction_over_pressure" for source in every):
        raise ConfigError("line_evidence.sources", "none of friction_over_pressure, as there is no friction map",
                          "friction_over_pressure", "state the sources without it")


@stage(companions=companions, check=_check)
def line_evidence(model: ReducedModel, friction_map: FrictionMap | None, modes: ComplexModes, recording: Recording,
                  events: NoiseEvents | None, effects: Effects | None, settings: Settings,
                  context: Context) -> LineEvidence:
    """Weigh hypotheses on a squeal by how probable they make the lines that were heard.

    Effects of the case act in all of them.

    Method:
    Each hypothesis was drawn {draws} times over the declared scatter (seed {seed}). The unstable modes of a draw at the
    operating points of the tests are its tones; each leaves a Poisson number of lines, scattered by the error of the
    model and marked with the tests that heard it, beside {unexplained} unexplained lines in the band on average. The
    evidence of a hypothesis is the mean probability density of the heard lines and of no others. Its standard error is
    by bootstrap over the draws; lists simulated by one half of the draws and weighed by the other calibrate it.
    """
    settings = settings.model_copy(update={"sources": fitting(settings.sources, model)})
    points = StabilitySettings.of(modes)
    if settings.high > points.frequency_max:
        raise ConfigError("line_evidence.high", f"at most {points.frequency_max:g} Hz, where the complex modes end",
                          f"{settings.high:g} Hz", "raise complex_modes.frequency_max")
    tests = _tests(recording, events, settings, model.pressure)
    errors = friction_errors(friction_map, points.sliding_distance)

    def draws(hypothesis, count, seed):
        return drawn(hypothesis, settings.sources, errors, model, count, seed)

    made = {name: draws(h, settings.draws, settings.seed) for name, h in settings.hypotheses.items()}
    keys = {name: same_solution(h) for name, h in settings.hypotheses.items()}
    variants = {keys[name]: made[name].factors for name in made}
    training = {key: draws(settings.hypotheses[name], settings.training, [settings.seed, 1]).factors
                for name, key in keys.items()}
    families = {disc: [_family(model, state, friction_map, points, effects, () if disc == FLEXIBLE else settings.disc)
                       for state in range(len(model.pressure))] for disc in (FLEXIBLE, RIGID)}
    roots = _solved(families, variants, training, tests, points, settings, context)
    hypotheses = {name: predicted(h, made[name], roots[keys[name]], tests, settings.high, settings.model_error)
                  for name, h in settings.hypotheses.items()}
    fields = weighed(hypotheses, tests, settings)
    run = no_cycle()
    if settings.cycle is not None:
        row, draw = chosen(fields["disc"], fields["evidence"], fields["weight"])
        tried = [(row, -1, NOMINAL), (row, draw, made[fields["hypothesis"][row]].factors[draw])]
        still = np.flatnonzero(tests.silent[tests.test])
        run = cycle_fields(
            settings.cycle, families[FLEXIBLE][-1], model.input_area, tried,
            (model.pressure[tests.state[still]], tests.speed[still]), points.frequency_max, settings.model_error,
            context.map)
    return LineEvidence(pressure=model.pressure[tests.state], speed=tests.speed, operating_test=tests.test, **fields,
                        **run)


def _tests(recording, events, settings, pressure):
    """BenchTests of the settings: squeal of records, lists of runs, or a cycle beside a silent test."""
    if events is not None:
        return record_tests(recording, events, settings, pressure)
    return (run_tests if settings.runs else cycle_tests)(recording, settings, pressure)


def _family(model, state, friction_map, points, effects, held):
    whole = family(model, state, friction_map, points, effects)
    return on_rigid_disc(whole, held) if held else whole


def _solved(families, variants, training, tests, points, settings, context):
    """{key: [draw][operating point] roots (r,)} of the ``variants`` {key: [Factors]}."""
    operating = range(len(tests.state))
    bases = [(disc, o) for disc in families for o in operating]
    training = {disc: [NOMINAL, *(f for key, more in training.items() if key[0] == disc for f in more)]
                for disc in families}
    tasks = [(families[disc][tests.state[o]], tests.speed[o], training[disc]) for disc, o in bases]
    cases = dict(zip(bases, context.map(partial(_sampled, points.frequency_max, settings.smallest_correction), tasks,
                                        "common bases"), strict=True))
    chunks = [(key, o, factors[k:k + _CHUNK]) for key, factors in variants.items() for o in operating
              for k in range(0, len(factors), _CHUNK)]
    tasks = [(key, cases[key[0], o].compact(), tests.speed[o], chunk) for key, o, chunk in chunks]
    solved = {key: [[] for _ in operating] for key in variants}
    for (key, o, _), roots in zip(chunks, context.map(_roots, tasks, "draws"), strict=True):
        solved[key][o] += roots
    return {key: list(map(list, zip(*of_points, strict=True))) for key, of_points in solved.items()}


def _sampled(below, smallest, task):
    case, speed, training = task
    return sampled(case, [speed], below, training, smallest)


def _roots(task):
    """[draw] roots (r,) of some draws at one operating point."""
    key, case, speed, factors = task
    try:
        return [case.roots(f, speed) for f in factors]
    except ConvergenceError as error:
        raise ConvergenceError(f"line_evidence, disc {key[0]}: {error.where}", error.expected, error.found,
                               error.remedy) from error
