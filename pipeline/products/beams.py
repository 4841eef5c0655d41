"""The beam on beam: its model, the scatter of its motion, the search for its geometry."""

import numpy as np

from pipeline.contract import Array, count, product, quantity, text


@product(version=1)
class BeamOnBeam:
    """Two beams on their supports, by their modes: the slider touches the track, which a drive moves along x.

    Relative displacement is slider minus track; the normal points out of the rubbed face. In steady sliding each
    frequency is a mode at one friction coefficient (the curve); at its maxima modes coalesce and flutter begins.
    """

    body_name: Array = text("body", "bodies in order: slider, track")
    element: Array = text("", "finite elements of the beams: plane or timoshenko")
    mode_body: Array = count("mode", "body of the mode, index into body_name")
    mode_frequency: Array = quantity("Hz", "mode", "modes and residual shapes of each beam alone; 0 for rigid-body motion")
    mode_damping: Array = quantity("1/s", "mode", "damping of the mass-normalised mode (Rayleigh)")
    contact_normal: Array = quantity("1/kg^0.5", "contact mode", "normal relative displacement, slider minus track, positive opens")
    contact_tangent: Array = quantity("1/kg^0.5", "contact mode", "tangential relative displacement along x, slider minus track")
    contact_position: Array = quantity("m", "contact xyz", "point of contact")
    contact_area: Array = quantity("m^2", "contact", "cross-section of the slider")
    force: Array = quantity("N", "", "force that presses the beams together")
    load_row: Array = quantity("1/kg^0.5", "input mode", "motion of the loaded end along the force")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions")
    sensor_rows: Array = quantity("1/kg^0.5", "sensor mode", "displacement at the sensors")
    visible_position: Array = quantity("m", "visible xyz", "points on both faces of the beams")
    visible_body: Array = count("visible", "body of these points")
    visible_face: Array = count("face corner", "quadrilaterals between them, row numbers of visible_position")
    recovery: Array = quantity("1/kg^0.5", "visible xyz mode", "displacement of these points per mode", np.float32)
    curve_frequency: Array = quantity("Hz", "curve", "frequencies of the curve")
    curve_friction: Array = quantity("1", "curve", "friction at which the frequency is a mode of sliding without damping, cut to -1..2")
    closed_frequency: Array = quantity("Hz", "closed_mode", "modes of sliding without friction")
    onset_frequency: Array = quantity("Hz", "onset", "frequencies at which modes coalesce as friction rises")
    onset_friction: Array = quantity("1", "onset", "friction at which they do so, without damping")
    end_frequency: Array = quantity("Hz", "flutter_end", "frequencies at which they separate again")
    end_friction: Array = quantity("1", "flutter_end", "friction at which they do so")
    check_frequency: Array = quantity("Hz", "check_mode", "modes without friction by the other kind of element")
    check_onset_frequency: Array = quantity("Hz", "check_onset", "coalescences by the other kind of element")
    check_onset_friction: Array = quantity("1", "check_onset", "friction at these coalescences")
    finding: Array = text("finding", "questions to the search for the geometry")
    finding_text: Array = text("finding", "answers of the search")


@product(version=1)
class MotionScatter:
    """One motion in several formulations, steps and seeds: statistics of a chaotic motion. First sensor, first contact."""

    formulation: Array = text("run", "contact formulation: hard, forward or lagrange")
    step: Array = quantity("s", "run", "time step")
    seed: Array = count("run", "seed of the start velocity")
    duration: Array = quantity("s", "", "length that is evaluated")
    friction: Array = quantity("1", "", "coefficient of friction")
    speed: Array = quantity("rad/s", "", "speed of the drive")
    fundamental: Array = quantity("Hz", "run", "strongest line of the velocity")
    harmonic_level: Array = quantity("1", "run order", "level of 1, 2, ... times that frequency re the strongest line, dB")
    harmonic_height: Array = quantity("1", "run order", "height of these lines above the spectrum beside them, dB")
    low_level: Array = quantity("1", "run", "highest line in the low band re the strongest line, dB")
    peak_force: Array = quantity("N", "run", "largest normal force")
    peak_slip: Array = quantity("m/s", "run", "largest slip velocity")
    peak_velocity: Array = quantity("m/s", "run", "largest velocity at the sensor")
    status_share: Array = quantity("1", "run kind", "fraction of the time open, sticking, sliding")
    vibrating_share: Array = quantity("1", "run", "fraction of the time that vibrates, T_vib / (T_vib + T_st)")
    burst_length: Array = quantity("s", "run", "mean length of a burst, T_vib")
    pause_length: Array = quantity("s", "run", "mean length of a pause, T_st")
    imbalance: Array = quantity("1", "run", "largest error of the energy balance over the largest energy exchanged")


@product(version=1)
class BeamGeometry:
    """The geometry of the beam on beam that best fits the published facts, its cost, and what the data leave open."""

    parameter: Array = text("parameter", "parameters of the joint search")
    best: Array = quantity("1", "parameter", "the best geometry, in the unit given in the name (lengths in mm, else SI)")
    cost: Array = quantity("1", "", "its cost: linear facts and motion")
    linear_cost: Array = quantity("1", "", "its cost, linear facts only")
    rigid_tilt: Array = quantity("rad", "rigid_search", "tilt of the searches with rigid supports")
    rigid_cost: Array = quantity("1", "rigid_search", "lowest linear cost with rigid supports")
    rigid_best: Array = quantity("1", "rigid_search rigid_parameter", "the geometry with that cost")
    rigid_parameter: Array = text("rigid_parameter", "its parameters")
    yielding_cost: Array = quantity("1", "", "lowest linear cost with elastic supports")
    sampled_parameter: Array = text("sampled_parameter", "parameters that the linear facts depend on")
    lower_bound: Array = quantity("1", "sampled_parameter", "lower bound of the search")
    upper_bound: Array = quantity("1", "sampled_parameter", "upper bound of the search")
    samples: Array = quantity("1", "sample sampled_parameter", "geometries that the linear facts allow")
    onset_frequency: Array = quantity("Hz", "onset", "coalescences of the best geometry")
    onset_friction: Array = quantity("1", "onset", "friction at these coalescences")
    closed_frequency: Array = quantity("Hz", "closed_mode", "its modes without friction")
    quantity_name: Array = text("quantity", "features of the motion that are compared")
    lower: Array = quantity("1", "quantity", "lower end of the band without cost (SI; -1e9 = none)")
    upper: Array = quantity("1", "quantity", "upper end of that band (SI; 1e9 = none)")
    motion: Array = quantity("1", "run quantity", "its values in each motion of the best geometry (SI)")
    damping: Array = quantity("1/s", "damping", "damping per mass")
    low_growth: Array = quantity("1/s", "damping", "growth rate of the mode near 400 Hz")
    middle_growth: Array = quantity("1/s", "damping", "growth rate of the mode near 2800 Hz")
    damping_low_level: Array = quantity("1", "damping", "highest line between 250 and 650 Hz re the strongest line, dB")
    damping_fundamental: Array = quantity("Hz", "damping", "strongest line")
    damping_vibrating: Array = quantity("1", "damping", "fraction of the time that vibrates")
    evaluations: Array = count("", "geometries evaluated")
