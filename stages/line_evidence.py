"""Stage line_evidence: which explanation of a squeal makes the lines that a bench heard most probable?

Every hypothesis predicts tones for each draw of the declared scatter, from its unstable modes over the operating points
of the bench's cycle; the lines heard there, and the silence at constant load, weigh the hypotheses.
"""

from functools import partial

import numpy as np

from pipeline.case_models.scatter import DEFAULT, Source, family, friction_deviations, stability_settings
from pipeline.contract import ConfigError, Context, ConvergenceError, Quantity, Section, option, stage
from pipeline.diagnosis.published.frequency_lists import lines_of
from pipeline.diagnosis.published.line_hypotheses import (
    FLEXIBLE,
    RIGID,
    Hypothesis,
    check_hypotheses,
    drawn,
    on_rigid_disc,
    same_solution,
)
from pipeline.diagnosis.published.line_weighing import predicted, weighed
from pipeline.physics.stability.sampled_roots import sampled
from pipeline.physics.stability.scatter import NOMINAL
from pipeline.products import ComplexModes, FrictionMap, LineEvidence, Recording, ReducedModel

_DISC = "disc"
#: draws of one task of the fan-out
_CHUNK = 10


class Settings(Section):
    """The lines, the operating points of the bench, the hypotheses and what they leave open."""

    run: str = option("bench", "recorded run")
    list: str = option("laser", "list with its lines")
    low: Quantity("Hz", ge=0) = option("1.25 kHz", "lower end of the band in which lines could be heard")
    high: Quantity("Hz", gt=0) = option("20 kHz", "upper end, at most that of complex_modes")
    unexplained: float = option(0.1, "mean number of lines there that no hypothesis explains", gt=0)
    heard: tuple[float, float] = option((0.1, 0.9), "share of tones that leave a line: range, uniformly distributed")
    model_error: float = option(0.01, "relative standard deviation of a predicted frequency", gt=0, lt=0.1)
    silent_up_to: Quantity("Pa", gt=0) = option(
        "0.8 MPa", "pressures of structure up to it are the test at constant load, those above it the cycle")
    constant_speed: Quantity("rad/s", gt=0) = option("8.5 rad/s", "speed of the test at constant load")
    cycle_speed: Quantity("rad/s", gt=0) = option(
        "8.5 rad/s", "speed of the cycle at its highest pressure; at others so that pressure times speed is the same")
    hypotheses: dict[str, Hypothesis] = option(
        {"one_way": {"disc": RIGID, "harmonics": True}, "flexible_disc": {"disc": FLEXIBLE}}, "what is compared")
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
    if not settings.low < settings.high:
        raise ConfigError("line_evidence.high", f"more than low, {settings.low:g} Hz", f"{settings.high:g} Hz")


@stage(check=_check)
def line_evidence(model: ReducedModel, friction_map: FrictionMap, modes: ComplexModes, recording: Recording,
                  settings: Settings, context: Context) -> LineEvidence:
    """Weigh hypotheses on a squeal by how probable they make the lines that were heard.

    Method:
    Each hypothesis was drawn {draws} times over the declared scatter (seed {seed}). The unstable modes of a draw at the
    operating points of the bench are its tones; each leaves a Poisson number of lines, scattered by the error of the
    model, beside {unexplained} unexplained lines in the band on average. The evidence of a hypothesis is the mean
    probability density of the heard lines and of no others, times that of silence at constant load. Its standard error
    is by bootstrap over the draws; lists simulated by one half of the draws and weighed by the other calibrate it.
    """
    points = stability_settings(modes)
    if settings.high > points.frequency_max:
        raise ConfigError("line_evidence.high", f"at most {points.frequency_max:g} Hz, where the complex modes end",
                          f"{settings.high:g} Hz", "raise complex_modes.frequency_max")
    lines, reading = _heard(recording, settings)
    speed, silent = _operating_points(model, settings)
    deviations = friction_deviations(friction_map, points.sliding_distance)

    def draws(hypothesis, count, seed):
        return drawn(hypothesis, settings.sources, deviations, model, count, seed)

    made = {name: draws(h, settings.draws, settings.seed) for name, h in settings.hypotheses.items()}
    keys = {name: same_solution(h) for name, h in settings.hypotheses.items()}
    variants = {keys[name]: made[name].factors for name in made}
    training = {key: draws(settings.hypotheses[name], settings.training, [settings.seed, 1]).factors
                for name, key in keys.items()}
    families = {disc: [_family(model, state, friction_map, points, disc) for state in range(len(model.pressure))]
                for disc in (FLEXIBLE, RIGID)}
    roots = _solved(families, variants, training, speed, points, settings, context)
    hypotheses = {
        name: predicted(h, made[name], *_split(roots[keys[name]], silent), settings.high, settings.model_error)
        for name, h in settings.hypotheses.items()}
    return LineEvidence(
        pressure=model.pressure, speed=speed, silent=silent,
        **weighed(hypotheses, lines, reading, (settings.low, settings.high), settings.unexplained,
                  settings.heard, settings.model_error, settings.reference, settings.seed))


def _heard(recording, settings):
    """(lines (n,) Hz ascending, standard deviation of reading them, Hz). ConfigError for lines outside the band."""
    stated = lines_of(recording, settings.run, settings.list, "line_evidence.list")
    lines = np.sort(stated.frequency)
    if not len(lines) or lines[0] < settings.low or lines[-1] > settings.high:
        raise ConfigError("line_evidence.low", "a band that holds all lines", f"{settings.low:g} to"
                          f" {settings.high:g} Hz, lines at {', '.join(f'{f:g}' for f in lines) or 'none'}")
    return lines, float(stated.frequency_tolerance.max()) / np.sqrt(3)


def _operating_points(model, settings):
    """(speed (o,) rad/s, silent (o,)): one operating point for each pressure of a product ReducedModel."""
    silent = model.pressure <= settings.silent_up_to
    if silent.all() or not silent.any():
        raise ConfigError("structure.pressures", "some up to line_evidence.silent_up_to and some above it",
                          ", ".join(f"{p:g} Pa" for p in model.pressure))
    cycle = settings.cycle_speed * model.pressure.max() / model.pressure
    return np.where(silent, settings.constant_speed, cycle), silent


def _family(model, state, friction_map, points, disc):
    whole = family(model, state, friction_map, points)
    return whole if disc == FLEXIBLE else on_rigid_disc(whole, _DISC)


def _solved(families, variants, training, speed, points, settings, context):
    """{key: [draw][operating point] roots (r,)} of the ``variants`` {key: [Factors]}."""
    bases = [(disc, state) for disc in families for state in range(len(speed))]
    training = {disc: [NOMINAL, *(f for key, more in training.items() if key[0] == disc for f in more)]
                for disc in families}
    tasks = [(families[disc][state], speed[state], training[disc]) for disc, state in bases]
    cases = dict(zip(bases, context.map(partial(_sampled, points.frequency_max, settings.smallest_correction), tasks,
                                        "common bases"), strict=True))
    chunks = [(key, state, factors[k:k + _CHUNK]) for key, factors in variants.items() for state in range(len(speed))
              for k in range(0, len(factors), _CHUNK)]
    tasks = [(key, cases[key[0], state].compact(), speed[state], chunk) for key, state, chunk in chunks]
    solved = {key: [[] for _ in speed] for key in variants}
    for (key, state, _), roots in zip(chunks, context.map(_roots, tasks, "draws"), strict=True):
        solved[key][state] += roots
    return {key: list(map(list, zip(*of_states, strict=True))) for key, of_states in solved.items()}


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


def _split(roots, silent):
    """(cycle, constant load) [draw][operating point] of ``roots`` of all operating points."""
    return tuple([[r for r, s in zip(of_draw, silent, strict=True) if s == kind] for of_draw in roots]
                 for kind in (False, True))
