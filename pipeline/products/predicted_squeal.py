"""Predicted squeal: motion from onset to limit cycle, and how likely a schedule of stops squeals."""

import numpy as np

from pipeline.contract import Array, count, parts, product, quantity, text
from pipeline.products.sound import Excerpt


@product(version=2)
class LimitCycle:
    """What unstable modes grow into: motion about steady sliding with opening, stiffening and sticking contacts.

    Operating points are those with unstable modes; all other motion decays.
    """

    pressure: Array = quantity("Pa", "operating", "nominal pressure")
    speed: Array = quantity("rad/s", "operating", "speed of the drive")
    onset_operating: Array = count("onset", "row of the operating point of an unstable mode")
    onset_root: Array = quantity("1/s", "onset", "root of the mode in complex modes", complex)
    onset_simulated: Array = quantity("1/s", "onset", "growth rate and angular frequency of the mode while the simulated motion is small", complex)
    sensor_name: Array = text("sensor", "sensor names")
    window: Array = quantity("s", "", "length of the windows of the levels")
    level: Array = quantity("m/s", "operating sensor stretch", "root mean square velocity in successive windows")
    open_share: Array = quantity("1", "operating stretch", "share of the contacts that are open, mean over the window")
    stick_share: Array = quantity("1", "operating stretch", "share of the contact patches that stick, mean over the window")
    settled: Array = count("operating", "1 where the level changes by less than settled_within over the last two windows")
    settled_within: Array = quantity("1", "", "largest change of the level, in dB")
    imbalance: Array = quantity("1", "operating", "largest error of the energy balance in the last window over the energy exchanged")
    added_loss: Array = quantity("1", "operating", "share of the energy lost that goes to the damping added above the modes of interest")
    time: Array = quantity("s", "time", "time in the recorded end of the motion")
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors at the end of the motion", np.float32)
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    spectrum: Array = quantity("m/s", "operating sensor frequency", "amplitude spectrum of the end of the motion, Hann window")
    cycle_frequency: Array = quantity("Hz", "operating", "frequency of the strongest line over the sensors")
    harmonic_amplitude: Array = quantity("m/s", "operating sensor harmonic", "amplitude at 1, 2, ... times that frequency")
    patches: Array = count("", "contact patches")
    modes: Array = count("", "modes that move, damped ones above the modes of interest included")
    step: Array = quantity("s", "", "time step")
    check: Array = text("check", "what was changed to see how far the result holds, at the strongest operating point")
    check_level: Array = quantity("1", "check", "change of the level by it in dB, all sensors together")
    check_frequency: Array = quantity("1", "check", "change of the frequency of the strongest line by it, as a share of it")
    listen: dict[str, Excerpt] = parts("squeal: the loudest limit cycle, to listen to; nothing where all motion decays", empty=True)


@product(version=1)
class Sensitivities:
    """What moves the growth rate of each unstable mode: its derivatives to the values of the case.

    Roots are those of the reduced model with loss factors as imaginary stiffness. Names of values are those of settings
    where one setting is meant, units SI.
    """

    mode: Array = count("mode", "index of the unstable mode in complex_modes; of those of one frequency the strongest")
    pressure: Array = quantity("Pa", "mode", "pressure of its operating point")
    speed: Array = quantity("rad/s", "mode", "speed of the drive there")
    friction: Array = quantity("1", "mode", "friction coefficient there, mean weighted by normal force")
    mode_root: Array = quantity("1/s", "mode", "its root in complex_modes, that of the finite elements if it was solved for there", complex)
    root: Array = quantity("1/s", "mode", "the root that is derived", complex)
    parameter: Array = text("parameter", "values that are varied")
    unit: Array = text("parameter", "SI unit of the value")
    method: Array = text("parameter", "analytic: by left and right vectors; differences: the case computed again")
    source: Array = text("parameter", "source of scatter in probability that it belongs to; empty without one")
    value: Array = quantity("1", "mode parameter", "the value, in its unit")
    derivative: Array = quantity("1/s", "mode parameter", "change of the root per unit of the value; in the real part the growth rate", complex)
    error: Array = quantity("1/s", "mode parameter", "uncertainty of the real part: what doubling the distance changes over which contact law and friction map are smoothed, or half the second difference")
    known: Array = count("mode parameter", "0 where the mode was not found again in a case with another value")
    scatter: Array = quantity("1", "mode parameter", "standard deviation of the value, in its unit")
    declared: Array = count("parameter", "1 where the case declares that scatter, 0 where it is unstated_scatter of the value")
    unstated_scatter: Array = quantity("1", "", "standard deviation over the value where the case declares none")
    change: Array = quantity("1/s", "mode parameter", "change of the growth rate by one standard deviation more, to first order")
    rank: Array = count("mode parameter", "rank by the magnitude of that change, from 1; 0 where not known")
    remedy_mode: Array = count("remedy", "mode (row of 'mode') that another value makes stable or less unstable")
    remedy_parameter: Array = count("remedy", "that value, as row of 'parameter'")
    remedy_value: Array = quantity("1", "remedy", "what it is then, in its unit")
    remedy_root: Array = quantity("1/s", "remedy", "root of the mode then, computed anew in the reduced model", complex)
    left_out: Array = text("left_out", "values without a derivative")
    left_out_reason: Array = text("left_out", "why, and where their influence shows")


@product(version=1)
class NoiseMatrix:
    """A schedule of brake applications: how likely each squeals over the scatter of the brake, beside the bench.

    An application is noisy if a mode within the limits is unstable. Draws are those of brakes, each with some stops; a
    condition is a kind of application at a pressure and a speed, and at a temperature where that acts.
    """

    title: Array = text("", "title of the schedule")
    published_sections: Array = count("", "sections of the published procedure; 0 = not known")
    published_applications: Array = count("", "its brake applications; 0 = not known")
    published_source: Array = text("", "where that is stated")
    not_available: Array = text("", "what of the procedure was not available")
    origin_module: Array = text("origin", "module of a value of the schedule")
    origin_setting: Array = text("origin", "the setting")
    origin_value: Array = text("origin", "its value")
    origin: Array = text("origin", "where it comes from: stated, inferred, assumed, ...")
    origin_source: Array = text("origin", "its source")
    module: Array = text("module", "modules of the schedule")
    applications: Array = count("module condition", "applications of each condition in a module")
    kind: Array = text("condition", "drag, or stop")
    pressure: Array = quantity("Pa", "condition", "pressure in the brake line")
    pad_pressure: Array = quantity("Pa", "condition", "nominal pad pressure")
    speed: Array = quantity("m/s", "condition", "speed of the vehicle at the begin, negative in reverse")
    end: Array = quantity("m/s", "condition", "speed at the end")
    temperature: Array = quantity("K", "condition", "temperature of the disc; 0 where it does not act")
    outside: Array = count("condition", "1 where pressure or speed lie beyond the range of the friction map, in part or throughout")
    wheel_radius: Array = quantity("m", "", "speed of the vehicle per speed of the disc")
    limits: Array = quantity("Hz", "limit", "frequencies between which an unstable mode counts")
    source: Array = text("source", "what scatters")
    source_law: Array = text("source", "law of its scatter")
    source_varies: Array = count("source", "1 where it changes from stop to stop of a brake, 0 where it belongs to the brake")
    value: Array = quantity("1", "draw source", "drawn values, as of Probability; the draws of a brake follow one another")
    repeats: Array = count("", "draws of each brake")
    noisy: Array = count("draw condition", "1 where the draw is noisy")
    probability: Array = quantity("1", "condition", "share of the draws that are noisy")
    interval: Array = quantity("1", "condition bound", "95 % interval of it by the number of draws")
    correlation: Array = quantity("1", "condition", "correlation of two stops of one brake")
    band: Array = quantity("Hz", "band", "middles of the 1/3 octave bands")
    band_probability: Array = quantity("1", "condition band", "share of the draws that are noisy in the band")
    band_occurrence: Array = quantity("1", "band", "share of the applications of the schedule that are noisy in it")
    module_occurrence: Array = quantity("1", "module", "share of the applications of a module that are noisy")
    module_interval: Array = quantity("1", "module bound", "95 % interval of it by the number of draws")
    occurrence: Array = quantity("1", "", "share of the applications of the schedule that are noisy")
    occurrence_interval: Array = quantity("1", "bound", "95 % interval of it by the number of draws")
    brake_occurrence: Array = quantity("1", "brake", "the same share of each brake, by its drawn stops")
    refined_stops: Array = count("", "stops that were also solved at twice as many speeds")
    refined_changed: Array = count("", "of these, stops that were noisy at one number of speeds and not at the other")
    checked_root: Array = quantity("1/s", "checked", "roots of some draws on the common bases", complex)
    whole_root: Array = quantity("1/s", "checked", "the same roots in the whole reduced model", complex)
    checked_draws: Array = count("", "draws and operating points of this comparison")
    missed: Array = count("", "unstable roots there that only one of both has")
    run: Array = text("run", "recorded stops")
    run_condition: Array = count("run", "condition of each, -1 where the schedule has none near it")
    run_reason: Array = text("run", "why not")
    run_noisy: Array = count("run", "1 where it squeals within the limits")
    level: Array = quantity("1", "", "family-wise level below which a difference counts")
    tests: Array = count("", "tests of the family: conditions with recorded stops, bands, all together")
    condition_stops: Array = count("condition", "recorded stops")
    condition_noisy: Array = count("condition", "of them with squeal")
    condition_expected: Array = quantity("1", "condition", "number of these that is predicted")
    condition_p_value: Array = quantity("1", "condition", "family-wise p-value of the difference; 1 where nothing was recorded")
    condition_least_p: Array = quantity("1", "condition", "smallest one that so many stops can have")
    condition_difference: Array = count("condition", "1 where the model squeals too much, -1 too little, 0 no difference beyond chance")
    band_noisy: Array = count("band", "recorded stops that squeal in the band")
    band_expected: Array = quantity("1", "band", "number of these that is predicted")
    band_p_value: Array = quantity("1", "band", "as of the conditions")
    band_least_p: Array = quantity("1", "band", "as of the conditions")
    band_difference: Array = count("band", "as of the conditions")
    all_expected: Array = quantity("1", "", "noisy ones predicted among all recorded stops")
    all_p_value: Array = quantity("1", "", "as of the conditions")
    all_least_p: Array = quantity("1", "", "as of the conditions")
    all_difference: Array = count("", "as of the conditions")


@product(version=1)
class Countermeasures:
    """Variants of a brake beside it: every unstable mode before and after, how likely squeal is, and what each costs.

    Modes of one operating point are matched by the MAC on surface nodes that both models have.
    """

    variant: Array = text("variant", "names of the variants")
    change: Array = text("variant", "settings that each changes")
    note: Array = text("variant", "what each is, as stated")
    cost_name: Array = text("column", "columns of costs, as stated")
    cost_unit: Array = text("column", "their units, empty without one")
    cost: Array = quantity("1", "variant column", "cost in that unit; 0 where none is stated")
    cost_known: Array = count("variant column", "1 where it is stated")
    pressure: Array = quantity("Pa", "operating", "pressure of the operating point")
    speed: Array = quantity("rad/s", "operating", "speed of the drive at the operating point")
    mode_variant: Array = count("mode", "variant that the row of a mode compares with the case")
    mode_operating: Array = count("mode", "its operating point")
    before: Array = quantity("1/s", "mode", "root in the case; 0 where no counterpart is known", complex)
    before_known: Array = count("mode", "1 where it is known")
    after: Array = quantity("1/s", "mode", "root in the variant, by the reduced model; 0 where no counterpart is known", complex)
    after_known: Array = count("mode", "1 where it is known")
    mac: Array = quantity("1", "mode", "MAC of the two; 0 without a counterpart")
    rival_mac: Array = quantity("1", "mode", "largest MAC with another mode that it may be as well; 0 without one")
    clear: Array = count("mode", "1 where the match is beyond doubt")
    state: Array = text("mode", "gone, weaker, stronger, new, unchanged (within the error), or ambiguous")
    error: Array = quantity("1/s", "mode", "by how much refined models move the growth rate")
    sampled_pressure: Array = quantity("Pa", "sampled", "pressure of the operating points of the probabilities; none without draws")
    sampled_speed: Array = quantity("rad/s", "sampled", "their speed of the drive")
    draws: Array = count("", "draws of the case")
    variant_draws: Array = count("variant", "draws of each variant")
    paired: Array = count("variant", "1 where these are the draws of the case")
    probability: Array = quantity("1", "sampled", "share of the draws of the case that squeal")
    interval: Array = quantity("1", "sampled end", "95 % Wilson interval of it")
    variant_probability: Array = quantity("1", "variant sampled", "the same in each variant")
    variant_interval: Array = quantity("1", "variant sampled end", "95 % Wilson interval of it")
    probability_change: Array = quantity("1", "variant sampled", "the latter less the former")
    change_interval: Array = quantity("1", "variant sampled end", "95 % interval of the change, by pairs of draws where they are paired")
    overall: Array = quantity("1", "", "share of the draws of the case that squeal at any operating point")
    overall_interval: Array = quantity("1", "end", "95 % Wilson interval of it")
    variant_overall: Array = quantity("1", "variant", "the same in each variant")
    variant_overall_interval: Array = quantity("1", "variant end", "95 % Wilson interval of it")
    overall_change: Array = quantity("1", "variant", "the latter less the former")
    overall_change_interval: Array = quantity("1", "variant end", "95 % interval of the change")
    band: Array = quantity("Hz", "band", "middles of the 1/3 octave bands; none without draws")
    band_probability: Array = quantity("1", "band", "share of the draws of the case with an unstable mode in the band at any operating point")
    variant_band_probability: Array = quantity("1", "variant band", "the same in each variant")
    band_change_interval: Array = quantity("1", "variant band end", "95 % interval of the change, of each band by itself")
    squeal_from: Array = quantity("Hz", "", "frequency from which an unstable mode is squeal")
