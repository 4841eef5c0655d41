"""Diagnosis: the effects of a case, the predictions of its virtual rig, and what the recordings say is missing."""

from pipeline.contract import Array, count, parts, product, quantity, text


@product(version=2)
class Effects:
    """Physics that the case adds to its model: terms of the catalogue, each at a location."""

    effect: Array = text("entry", "effect of the catalogue")
    place: Array = text("entry", "joint, contact group, point or channel where it acts")
    term: Array = count("value", "term that each value belongs to")
    parameter: Array = text("value", "parameter of the effect")
    value: Array = quantity("1", "value", "its value in the SI unit that `unit` names")
    unit: Array = text("value", "SI unit of the value")
    condition: Array = text("condition", "operating condition that the recorded runs do not give, such as humidity")
    condition_value: Array = quantity("1", "condition", "its value")


@product(version=1)
class BenchRun:
    """One recorded run beside the prediction of the virtual rig."""

    time: Array = quantity("s", "sample", "time since the start of the run")
    measured: Array = quantity("1", "channel sample", "recorded samples, each channel in its SI unit; 0 where missing")
    predicted: Array = quantity("1", "channel sample", "prediction of the model")
    valid: Array = count("channel sample", "1 where a sample was recorded")
    error: Array = quantity("1", "channel", "root mean square error over the standard deviation of the recorded signal; of features, over their own")
    root_mean_square: Array = quantity("1", "channel", "root mean square error in the unit of the channel")


@product(version=1)
class BenchStops:
    """Stops that squeal at one operating point, each by itself: growth between noise floor and saturation."""

    stop: Array = text("stop", "recorded runs")
    growth_rate: Array = quantity("1/s", "stop", "growth rate; 0 where the stop tells none")
    frequency: Array = quantity("Hz", "stop", "frequency while it grows")
    std: Array = quantity("rad/s", "stop", "standard deviation of growth rate and angular frequency")
    begin: Array = quantity("s", "stop", "begin of the window")
    end: Array = quantity("s", "stop", "its end")
    grown: Array = quantity("1", "stop", "growth within the window in powers of e")
    reason: Array = text("stop", "why the stop tells no growth; empty where it does")


@product(version=2)
class Bench:
    """The virtual rig: sensors, laws and inputs of the model, and its predictions for the recorded runs."""

    settings: Array = text("", "the section of the case that describes it, as JSON")
    channel: Array = text("channel", "sensors in order")
    unit: Array = text("channel", "SI unit of each sensor")
    runs: dict[str, BenchRun] = parts("recorded runs by name")
    stops: dict[str, BenchStops] = parts("stops that squeal, by the run that the others repeat; none where none are"
                                         " read", empty=True)


@product(version=2)
class DiagnosedRun:
    """One run under the nominal, the recalibrated and the completed model."""

    held_out: Array = count("", "1 if the run was not fitted")
    condition: Array = text("condition", "conditions that were constant in it")
    condition_value: Array = quantity("1", "condition", "their values in SI units")
    time: Array = quantity("s", "sample", "time since the start of the run; sample number for features")
    measured: Array = quantity("1", "channel sample", "recorded samples; 0 where missing")
    valid: Array = count("channel sample", "1 where a sample was recorded")
    nominal: Array = quantity("1", "channel sample", "prediction with the given values")
    recalibrated: Array = quantity("1", "channel sample", "prediction with refitted nominal values")
    completed: Array = quantity("1", "channel sample", "prediction with the named effects; as recalibrated without any")
    noise: Array = quantity("1", "channel", "standard deviation of the noise")
    error: Array = quantity("1", "model", "error over standard deviation: nominal, recalibrated, completed, noise alone")


@product(version=1)
class Located:
    """One axis of the location of a mismatch."""

    item: Array = text("item", "chain stages, places, runs, bands or bins")
    low: Array = quantity("1", "item", "lower edge of a band or bin, in the unit that `unit` names; 0 for names")
    high: Array = quantity("1", "item", "upper edge")
    unit: Array = text("", "unit of the edges; empty for names")
    score: Array = quantity("1", "item", "deviation in standard deviations, or the measure of the axis")
    p_value: Array = quantity("1", "item", "family-wise over the axis")
    member: Array = count("item", "1 in the 95 % set")


@product(version=1)
class LatentForce:
    """The force missing at the identified location in one run, whatever its physics; positive along the location."""

    time: Array = quantity("s", "sample", "time since the start of the run; its ends are left out")
    force: Array = quantity("N", "sample", "smoothed force on the moving side")
    std: Array = quantity("N", "sample", "its standard deviation")
    displacement: Array = quantity("m", "sample", "displacement at the location")
    velocity: Array = quantity("m/s", "sample", "velocity at the location")


@product(version=1)
class Follows:
    """Dependence of the latent force on one quantity: its mean in bins of equal count."""

    share: Array = quantity("1", "", "fraction of the variance of the force that the curve explains")
    p_value: Array = quantity("1", "", "against circular shifts of the force")
    unit: Array = text("", "unit of the quantity")
    centre: Array = quantity("1", "bin", "mean of the quantity in each bin")
    curve: Array = quantity("N", "bin", "mean force in each bin; over time its root mean square")


@product(version=1)
class LatentPrediction:
    """A held-out run by the recalibrated nominal model with the latent force: description, not identified physics."""

    predicted: Array = quantity("1", "channel sample", "prediction, each channel in its SI unit")
    error: Array = quantity("1", "", "error over standard deviation")


@product(version=1)
class SquealCheck:
    """Features of one recorded squeal and of simulated repeats of it: for verification only, never by waveform."""

    sentence: Array = text("", "which of recording and models squeal, in one sentence")
    who: Array = text("who", "recorded, recalibrated, completed; models that could not be simulated are left out")
    records: Array = count("who", "records, or simulated repeats")
    squealing: Array = count("who", "of these, those that reached saturation")
    feature: Array = text("feature", "features of the saturated stretches")
    unit: Array = text("feature", "their units")
    known: Array = count("who feature", "1 where the feature is known")
    mean: Array = quantity("1", "who feature", "mean over stretches and repeats; 0 where not known")
    spread: Array = quantity("1", "who feature", "standard deviation over them")
    agrees: Array = count("who feature", "1 where the mean lies within the spread of both from that recorded")


@product(version=12)
class Diagnosis:
    """The verdict on recordings: what differs, where, what is missing, how sure, and what to measure next."""

    verdict: Array = text("", "consistent, parameters, missing, tie, sensor, numerics or unknown")
    reason: Array = text("reason", "why, in sentences")
    other_machine: Array = text("", "why these may be recordings of another machine; empty where nothing speaks for that")
    failure: Array = text("", "why nothing could be judged; empty where the diagnosis came to its end")
    runs_differ: Array = text("", "the values that differ where each run alone is what the nominal model predicts; else empty")
    channel: Array = text("channel", "sensors, or features")
    channel_unit: Array = text("channel", "their SI units")
    named: Array = count("named", "rows of the hypotheses that the verdict names; all of a tie")
    known: Array = count("known", "rows of the hypotheses that were assumed known (first of a pair, all but one of several)")
    leading: Array = count("leading", "row of the hypothesis that explains most beyond chance where nothing is named, then of those at its place that take nearly as much; none where no candidate helps")
    leading_takes: Array = quantity("1", "leading", "share of the excess error that it takes, on held-out runs where they can tell, else on all")
    leading_stays: Array = quantity("1", "leading", "share that stays beyond the doubt about noise")
    leading_values: Array = text("leading", "its values with their standard deviations, in words")
    family: Array = text("", "what the laws that are named, or that lead, are called together, such as dry friction, where the form of the law is open; else empty")
    model_error: Array = quantity("1", "", "error of the model beside which what is named is told from the others, in noise floors; 1 where noise alone is")
    in_part: Array = count("", "1 where what is named leaves more than noise: it holds in part")
    noise_level: Array = quantity("1", "level", "noise as a multiple of what is known of it, or of the model error")
    noise_verdict: Array = text("level", "verdict at that level, all fitted values as they are")
    noise_named: Array = text("level", "hypotheses named there, joined by ' or '; empty for none")
    completed_step: Array = quantity("s", "", "time step that the completed model needs; 0 where that of the case does")
    left_floors: Array = quantity("1", "", "root mean square of what the completed model leaves of all runs, whitened: 1 is noise alone")
    left_sentence: Array = text("", "band and dependence of what is left after naming; empty where nothing is left beyond doubt")
    left_candidate: Array = text("", "best candidate beside what is named, and why it is not named; empty for none")
    hypothesis: Array = text("hypothesis", "all hypotheses compared; first: nothing missing")
    effect: Array = text("hypothesis", "effect of the catalogue; empty for nothing missing")
    place: Array = text("hypothesis", "location at which it would act")
    contacts: Array = text("hypothesis", "names that the case gives to the contacts of that location; empty for none")
    kind: Array = text("hypothesis", "physics, sensor or numerics")
    stage: Array = text("hypothesis", "stage of the chain that it belongs to; empty for nothing missing")
    posterior: Array = quantity("1", "hypothesis", "probability among all; next to a known effect, that of the pair")
    score: Array = quantity("1", "hypothesis", "screening score in standard deviations")
    p_value: Array = quantity("1", "hypothesis", "family-wise p-value over the catalogue")
    power: Array = quantity("1", "hypothesis", "score expected at the prior's size: detectability in these runs")
    evidence_gain: Array = quantity("1", "hypothesis", "ln Z over the recalibrated nominal model; 0 where not refitted")
    refitted: Array = count("hypothesis", "1 where it was refitted in the full model")
    held_out_error: Array = quantity("1", "hypothesis", "root mean square that it leaves of held-out runs, whitened: 1 is noise alone; 0 where not known")
    objection: Array = text("hypothesis", "rules that it violates, or why it could not be assessed")
    combination: Array = text("combination", "several effects that were tried together, joined by ' + '")
    combination_gain: Array = quantity("1", "combination", "ln Z over the nominal model along measured motions or linearised, the number of such sets paid for")
    combination_refitted: Array = count("combination", "1 where it was refitted in the full model")
    combination_objective: Array = quantity("1", "combination", "squared error and squared latent values there; 0 where not refitted")
    combination_held_out: Array = quantity("1", "combination", "as held_out_error; 0 where not known")
    combination_left: Array = quantity("1", "combination", "share of the excess error that it leaves there; 0 where not refitted")
    combination_values: Array = text("combination", "values of its laws there; empty where not refitted")
    leading_set: Array = count("leading_set", "row of the combination that explains most where nothing is named and one law explains less than half of it; else none")
    combination_outcome: Array = text("combination", "what became of it")
    parameter: Array = text("parameter", "fitted parameters: nominal ones, then those of the named effects")
    parameter_unit: Array = text("parameter", "their SI units")
    parameter_nominal: Array = quantity("1", "parameter", "given value")
    parameter_value: Array = quantity("1", "parameter", "fitted value")
    parameter_std: Array = quantity("1", "parameter", "standard deviation")
    parameter_owner: Array = count("parameter", "row of the hypothesis that owns it; 0 for nominal ones")
    parameter_factor: Array = count("parameter", "1 where the value is a factor on that of the model, which 1 leaves")
    start_run: Array = text("start", "runs whose unknown start state was fitted, one row a number of it; held-out runs"
                            " are not listed, whose start each model fits to their first part")
    start_quantity: Array = text("start", "displacement, velocity or relaxed position of which body")
    start_unit: Array = text("start", "its SI unit")
    start_value: Array = quantity("1", "start", "fitted value")
    start_std: Array = quantity("1", "start", "standard deviation")
    fit: Array = quantity("1", "part model", "error over standard deviation, training and held out (0 without):"
                          " nominal, recalibrated, completed, noise alone")
    unexplained_share: Array = quantity("1", "", "fraction of the excess error that the completed model leaves")
    drift_p_value: Array = quantity("1", "", "p-value of constant fitted values over operating points; 1 if not tested")
    location: dict[str, Located] = parts("axes by name: stage, substitution, place, run, band, amplitude, velocity, time")
    latent_place: Array = text("", "location of the latent force; empty if none was identified")
    latent_sentence: Array = text("", "description of the latent force and of what it depends on")
    latent: dict[str, LatentForce] = parts("the latent force by run: description, not identified physics")
    follows: dict[str, Follows] = parts("quantities that the latent force may depend on, by name")
    latent_use: Array = text("", "how well the latent force predicts held-out runs, or why not; empty unless requested")
    latent_term: Array = text("term", "terms of the latent force as a function: x m, v m/s, angle of the drive")
    latent_coefficient: Array = quantity("1", "term", "their coefficients in the SI unit that `latent_unit` names")
    latent_unit: Array = text("term", "SI units of the coefficients")
    latent_predicted: dict[str, LatentPrediction] = parts("held-out runs predicted with it; none unless requested")
    squeal: dict[str, SquealCheck] = parts("recorded squeals by run beside simulated ones; none unless requested")
    next_condition: Array = text("next", "conditions of the next experiment, as name = value unit")
    next_separates: Array = text("separated", "hypotheses that it separates best")
    next_value: Array = quantity("1", "", "its expected information gain in nats; 0 without one")
    threshold: Array = text("threshold", "rules that decided, as named in the settings under `diagnosis.rules`")
    threshold_value: Array = quantity("1", "threshold", "their values in the unit that `threshold_unit` names")
    threshold_unit: Array = text("threshold", "their units")
    threshold_meaning: Array = text("threshold", "what they mean")
    runs: dict[str, DiagnosedRun] = parts("runs by name")


@product(version=2)
class LineEvidence:
    """Hypotheses on what makes a brake squeal, weighed by how probable they make the lines that a bench heard."""

    hypothesis: Array = text("hypothesis", "name; the last predicts no tone, so that every line is unexplained")
    disc: Array = text("hypothesis", "flexible, rigid or none")
    verdict: Array = text("", "flexible, rigid or none (no tone explains the lines) where one of these is ten times as probable as both others, beyond its standard error; else undecided")
    test: Array = text("test", "tests of the bench: a cycle and a constant load, or runs at one operating point each")
    line: Array = quantity("Hz", "line", "heard lines, ascending, each once at its mean over tests")
    heard_in: Array = count("line test", "1 for tests in which the line was heard")
    elsewhere: Array = quantity("1", "", "probability that a tone is heard in a test in which it does not grow")
    band: Array = quantity("Hz", "end", "band in which lines could be heard")
    unexplained: Array = quantity("1", "", "mean number of unexplained lines in it")
    model_error: Array = quantity("1", "", "relative standard deviation of a predicted frequency")
    pressure: Array = quantity("Pa", "operating", "pressure of the operating point")
    speed: Array = quantity("rad/s", "operating", "speed of the drive there")
    operating_test: Array = count("operating", "test that it is part of")
    evidence: Array = quantity("1", "hypothesis", "ln of the density of lines and silence over all tests, in Hz to the power of minus the number of lines")
    evidence_error: Array = quantity("1", "hypothesis", "its standard error by bootstrap over the draws")
    lines_alone: Array = quantity("1", "hypothesis", "ln of the density of the tests with lines alone")
    silence: Array = quantity("1", "hypothesis", "mean probability of silence in the silent tests; 1 without any")
    carried: Array = quantity("1", "hypothesis", "effective number of draws that carry the evidence")
    reference: Array = count("", "row of the hypothesis that factors refer to: the one-way chain")
    factor: Array = quantity("1", "hypothesis", "ln of the Bayes factor against the reference")
    factor_error: Array = quantity("1", "hypothesis", "its standard error")
    flexible: Array = quantity("1", "", "ln of the Bayes factor of all hypotheses with a flexible disc against all with a rigid one")
    flexible_error: Array = quantity("1", "", "its standard error")
    column: Array = text("column", "what is drawn")
    value: Array = quantity("1", "hypothesis draw column", "drawn values; 0 where a hypothesis draws none")
    weight: Array = quantity("1", "hypothesis draw", "share of each draw in the evidence of its hypothesis")
    line_growth: Array = quantity("1/s", "hypothesis draw line", "largest growth rate of a mode in the tests with lines, within the error of each line; minus its angular frequency where none grows or nearly does")
    tone: Array = quantity("Hz", "tone", "predicted tones of all draws in the tests with lines")
    tone_hypothesis: Array = count("tone", "hypothesis of each tone")
    tone_draw: Array = count("tone", "draw of each tone")
    near: Array = quantity("1", "hypothesis target", "share of draws with a tone within the error of each line, and of all at once")
    target_shift: Array = quantity("1", "hypothesis target column", "median of a value in those draws, in standard deviations of its ranks from that of all; 0 for fewer than 5 draws")
    target_quantile: Array = quantity("1", "hypothesis target column three", "10, 50 and 90 % quantile in those draws; 0 for fewer than 5")
    all_quantile: Array = quantity("1", "hypothesis column three", "the same of all draws")
    confusion: Array = quantity("1", "truth choice", "share of lists simulated by each hypothesis for which each is named (ten times the evidence of every other); last: none")
    simulated: Array = quantity("1", "truth list", "ln of the Bayes factor, flexible against rigid disc, of the simulated lists")
    cycle_time: Array = quantity("s", "phase", "instants of the cycle of pressure; none where no cycle is asked for")
    cycle_pressure: Array = quantity("Pa", "phase", "pressure at each")
    cycle_speed: Array = quantity("rad/s", "phase", "speed of the drive at each")
    cycle_audible: Array = quantity("1", "", "ln of the rise of a vibration from noise to audible squeal")
    cycle_hypothesis: Array = count("cycle", "hypothesis whose values the cycle is run with")
    cycle_draw: Array = count("cycle", "its draw of the largest evidence; -1: nominal values")
    cycle_temperature: Array = quantity("K", "cycle", "temperature")
    cycle_friction: Array = quantity("1", "cycle", "friction at it over that of the friction map")
    cycle_root: Array = quantity("1/s", "cycle_root", "roots that grow in the cycle", complex)
    cycle_root_cycle: Array = count("cycle_root", "cycle of each root")
    cycle_root_phase: Array = count("cycle_root", "phase of each root")
    still_pressure: Array = quantity("Pa", "still", "pressures of the silent test at constant load")
    still_root: Array = quantity("1/s", "still_root", "roots that grow there", complex)
    still_root_cycle: Array = count("still_root", "cycle whose values and temperature they have")
    still_root_pressure: Array = count("still_root", "pressure of each root, row of still_pressure")
    swell_cycle: Array = count("swell", "cycle in which a mode grows without break")
    swell_frequency: Array = quantity("Hz", "swell", "its mean frequency")
    swell_growth: Array = quantity("1/s", "swell", "its largest growth rate")
    swell_phase: Array = count("swell", "first phase")
    swell_phases: Array = count("swell", "number of phases")
    swell: Array = quantity("1", "swell", "ln of the rise of its amplitude meanwhile")
