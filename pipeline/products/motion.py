"""Motion of a sliding model: complex modes, rigid sub-discs, time histories."""

import numpy as np

from pipeline.contract import Array, count, product, quantity, text


@product(version=5)
class ComplexModes:
    """Complex modes of the sliding system over friction, and at each operating point of the map."""

    settings: Array = text("", "the section of the case that describes it, as JSON")
    pressure: Array = quantity("Pa", "pressure", "nominal pressure of the state")
    friction: Array = quantity("1", "friction", "friction coefficient of the sweep")
    root: Array = quantity("1/s", "pressure friction branch", "s = sigma + i omega, followed over friction", complex)
    real_frequency: Array = quantity("Hz", "pressure branch", "frequencies without friction and damping")
    operating_pressure: Array = quantity("Pa", "operating", "pressure of the operating point")
    operating_speed: Array = quantity("rad/s", "operating", "speed of the drive at the operating point")
    operating_friction: Array = quantity("1", "operating", "friction coefficient, mean weighted by normal force")
    operating_force: Array = quantity("N", "operating contact", "normal contact force in steady sliding, 0 when open")
    operating_open: Array = count("operating", "contacts that steady sliding leaves open")
    operating_root: Array = quantity("1/s", "operating branch", "roots at the operating point", complex)
    unstable_operating: Array = count("unstable", "operating point of the unstable mode")
    unstable_root: Array = quantity("1/s", "unstable", "roots with positive real part, strongest first", complex)
    unstable_shape: Array = quantity("1", "unstable visible xyz", "their shapes on the surface nodes, largest = 1", complex)
    unstable_diameters: Array = count("unstable", "nodal diameters of the disc in it; -1 in a system without a disc")
    body_name: Array = text("body", "bodies in order")
    unstable_share: Array = quantity("1", "unstable body", "share of each body in its kinetic energy")
    growth_term: Array = text("term", "what feeds or dissipates energy: friction at a body, contact damping, ...; their sum is the growth rate")
    unstable_growth: Array = quantity("1/s", "unstable term", "part of each term in the growth rate")
    corrections: Array = count("", "correction vectors for friction and damping added to the real modes")


@product(version=1)
class Convergence:
    """Unstable modes of one operating point beside those of refined models."""

    pressure: Array = quantity("Pa", "", "nominal pressure of the operating point")
    speed: Array = quantity("rad/s", "", "speed of the drive")
    refinement: Array = text("refinement", "what is refined: contact, pad_mesh, disc_mesh or bases")
    root: Array = quantity("1/s", "unstable", "unstable roots of the case, strongest first", complex)
    refined_root: Array = quantity("1/s", "refinement unstable", "the same in the refined models; that of the case where not found", complex)
    found: Array = count("refinement unstable", "1 where the refined model has a root within 2 % of the frequency")
    held: Array = count("refinement unstable", "1 where it moved by no more than the tolerances")
    added: Array = count("refinement", "unstable modes that only the refined model has, beyond neutral ones")
    contacts: Array = count("", "contact points of the case")
    refined_contacts: Array = count("refinement", "contact points of the refined model")
    frequency_change: Array = quantity("1", "", "largest change of a frequency, as a share of it")
    growth_change: Array = quantity("1/s", "", "largest change of a growth rate")
    growth_share: Array = quantity("1", "", "largest change of a growth rate, as a share of it")
    frequency_tolerance: Array = quantity("1", "", "largest change of a frequency that counts as converged")
    growth_tolerance: Array = quantity("1", "", "largest change of a growth rate that does, as a share of it")
    neutral: Array = quantity("1/s", "", "change of a growth rate that always does")
    converged: Array = count("", "1 if all unstable modes are those of all refined models within the tolerances")


@product(version=1)
class Probability:
    """Unstable modes over the scatter of a brake: seeded draws, and what they say of each operating point."""

    source: Array = text("source", "what scatters")
    origin: Array = text("source", "law of its scatter: distribution and width")
    value: Array = quantity("1", "draw source", "drawn factor on the nominal value; of friction the change of mu, or of its slope over a logarithm")
    pressure: Array = quantity("Pa", "operating", "pressure of the operating point")
    speed: Array = quantity("rad/s", "operating", "speed of the drive at the operating point")
    growth: Array = quantity("1/s", "draw operating", "largest growth rate below the frequency limit")
    root_draw: Array = count("root", "draw of each unstable root")
    root_operating: Array = count("root", "operating point of each unstable root")
    root: Array = quantity("1/s", "root", "unstable roots of all draws", complex)
    probability: Array = quantity("1", "operating", "share of the draws with an unstable mode")
    interval: Array = quantity("1", "operating end", "95 % Wilson interval of it")
    overall: Array = quantity("1", "", "share of the draws with an unstable mode at any operating point")
    overall_interval: Array = quantity("1", "end", "95 % Wilson interval of it")
    band: Array = quantity("Hz", "band", "middles of the 1/3 octave bands, IEC 61260")
    band_probability: Array = quantity("1", "band operating", "share of the draws with an unstable mode in the band")
    band_any: Array = quantity("1", "band", "the same at any operating point")
    band_interval: Array = quantity("1", "band end", "95 % Wilson interval of it")
    sensitivity: Array = quantity("1", "source", "first-order Sobol index of the largest growth rate over all operating points")
    sensitivity_error: Array = quantity("1", "source", "its standard error, by bootstrap")
    trend: Array = quantity("1", "source", "rank correlation of the source and that growth rate: above 0, more of it means less stable")
    checked_root: Array = quantity("1/s", "checked", "roots of some draws on the common bases", complex)
    whole_root: Array = quantity("1/s", "checked", "the same roots in the whole reduced model", complex)
    checked_draws: Array = count("", "draws and operating points of this comparison")
    missed: Array = count("", "unstable roots there that only one of both has")
    neutral: Array = quantity("1/s", "", "growth rate up to which a mode counts as stable")


@product(version=2)
class Multibody:
    """Motion of the flexible pads on four rigid sub-discs of friction patches, per operating point."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    time: Array = quantity("s", "time", "time after the static start")
    pad_name: Array = text("pad", "pads: outer, inner")
    pad_motion: Array = quantity("m", "operating pad xyz time", "displacement of the centres of gravity; x along sliding, y axial, z radial")
    patch_force: Array = quantity("N", "operating pad sub_disc time", "normal force of each sub-disc on each pad")
    normal_force: Array = quantity("N", "operating contact time", "normal force at each contact point", np.float32)
    friction_force: Array = quantity("N", "operating contact time", "friction force on the pad along sliding", np.float32)
    mean_friction: Array = quantity("1", "operating", "friction over normal force, mean after settling")
    growth_rate: Array = quantity("1/s", "operating", "growth rate of the pad oscillation, fitted to thirds of its envelope")
    growth_rate_std: Array = quantity("1/s", "operating", "standard error of the growth rate over these thirds")
    growth_decided: Array = count("operating", "1 where the growth rate exceeds two standard errors: its sign is decided")
    oscillation_frequency: Array = quantity("Hz", "operating", "dominant frequency of the pad oscillation along sliding")
    separated_share: Array = quantity("1", "operating", "fraction of contact samples without contact")
    outside_map_share: Array = quantity("1", "operating", "fraction of friction evaluations outside the computed map")
    caliper_factor: Array = quantity("1", "caliper_factor", "factor on the caliper stiffness, stability map")
    abutment_factor: Array = quantity("1", "abutment_factor", "factor on the abutment stiffness, stability map")
    stability: Array = quantity("1/s", "operating caliper_factor abutment_factor", "largest growth rate of the linearised system")
    stability_root: Array = quantity("Hz", "operating caliper_factor abutment_factor", "frequency of that root")


@product(version=1)
class Transient:
    """Motion with unilateral contact and dry friction, and its limit cycle, per operating point."""

    pressure: Array = quantity("Pa", "operating", "nominal pressure")
    speed: Array = quantity("rad/s", "operating", "speed of the drive")
    time: Array = quantity("s", "time", "time after the start")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    displacement: Array = quantity("m", "operating sensor time", "displacement at the sensors less that at time 0", np.float32)
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors", np.float32)
    gap: Array = quantity("m", "operating contact time", "gap, negative where the contact is compressed", np.float32)
    normal_force: Array = quantity("N", "operating contact time", "normal force, mean since the previous sample", np.float32)
    friction_force: Array = quantity("N", "operating contact time", "friction force along sliding, mean since the previous sample", np.float32)
    slip: Array = quantity("m/s", "operating contact time", "slip velocity, drive less body", np.float32)
    status: Array = count("operating contact time", "0 open, 1 sticking, 2 sliding")
    status_share: Array = quantity("1", "operating contact kind", "fraction of the steps open, sticking, sliding")
    stored_energy: Array = quantity("J", "operating time", "kinetic and strain energy of bodies and joints")
    input_work: Array = quantity("J", "operating time", "work of the inputs since time 0")
    damping_loss: Array = quantity("J", "operating time", "loss in dampers since time 0")
    normal_work: Array = quantity("J", "operating time", "work of the normal forces on the bodies since time 0")
    friction_work: Array = quantity("J", "operating time", "work of the friction forces on the bodies since time 0")
    sliding_loss: Array = quantity("J", "operating time", "work of the friction forces on the slip since time 0")
    imbalance: Array = quantity("1", "operating", "largest error of the energy balance over the largest energy exchanged")
    step: Array = quantity("s", "", "time step")
    window: Array = quantity("s", "", "end of the motion from which spectra and cycles are taken")
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    velocity_spectrum: Array = quantity("m^2/s^2/Hz", "operating sensor frequency", "one-sided power spectral density in the window")
    cycle_frequency: Array = quantity("Hz", "operating sensor", "dominant frequency in the window, 0 at rest")
    cycle_amplitude: Array = quantity("m/s", "operating sensor", "velocity amplitude in the window")
    cycle_drift: Array = quantity("1", "operating sensor", "range of the amplitude over quarters of the window, over its mean")
    settled: Array = count("operating sensor", "1 where the cycle has settled in the window")
    growth_rate: Array = quantity("1/s", "operating sensor", "growth rate of the initial small motion, 0 if none was observed")
    growth_rate_std: Array = quantity("1/s", "operating sensor", "standard error of the growth rate")
    grew: Array = count("operating sensor", "1 if the motion grew from small to its limit cycle")
    harmonic_amplitude: Array = quantity("m/s", "operating sensor harmonic", "velocity amplitude at 1, 2, ... times the dominant frequency")
