"""Every product that crosses a stage boundary. This page is the file-format reference.

Conventions: SI units; cylindrical axes of the disc, z along its axis; the disc turns about +z.
Side 'outer' (fingers) is z > 0, side 'inner' (piston) is z < 0. At a contact the normal points from
the disc into the pad, the tangent along the sliding velocity of the disc, the lateral direction
radially outwards. A relative displacement is pad minus disc: positive normal opens the contact.
"""

import numpy as np

from pipeline.contract import Array, count, part, parts, product, quantity, text


@product(version=1)
class Surface:
    """Two rough surfaces on one periodic lateral grid, with the depth grading of their solids."""

    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    disc_height: Array = quantity("m", "y x", "disc surface height, outwards of the solid, zero mean")
    pad_height: Array = quantity("m", "y x", "pad surface height, outwards of the solid, zero mean")
    disc_depth: Array = quantity("m", "disc_layer", "depth of the FE layer boundaries of the disc block, from 0")
    pad_depth: Array = quantity("m", "pad_layer", "depth of the FE layer boundaries of the pad block, from 0")
    body: Array = text("body", "body the statistics belong to")
    source: Array = text("body", "file or generator of the height map")
    rms_height: Array = quantity("m", "body", "Sq, root mean square height")
    mean_height: Array = quantity("m", "body", "Sa, arithmetic mean deviation")
    peak_to_valley: Array = quantity("m", "body", "Sz, highest peak to deepest valley")
    skewness: Array = quantity("1", "body", "Ssk, skewness of heights")
    kurtosis: Array = quantity("1", "body", "Sku, kurtosis of heights (3 = Gaussian)")
    rms_slope: Array = quantity("1", "body", "Sdq, root mean square slope")
    outlier_share: Array = quantity("1", "body", "share of samples removed as outliers")
    filled_share: Array = quantity("1", "body", "share of samples filled")
    shortest_wavelength: Array = quantity("m", "body", "shortest wavelength kept")
    nodes_per_wavelength: Array = quantity("1", "body", "grid nodes on the shortest wavelength")
    wavenumber: Array = quantity("rad/m", "wavenumber", "radial wavenumber of the power spectrum")
    power_spectrum: Array = quantity("m^4", "body wavenumber", "isotropic (radially averaged) power spectrum")


@product(version=2)
class MicroFriction:
    """Friction, real contact area and wear of the rough pair over pressure, speed and sliding distance."""

    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure")
    speed: Array = quantity("m/s", "speed", "sliding speed")
    disc_speed: Array = quantity("rad/s", "speed", "speed of the disc that slides so at the effective radius")
    distance: Array = quantity("m", "distance", "sliding distance")
    friction: Array = quantity("1", "pressure speed distance", "coefficient of friction, shear over normal force")
    friction_std: Array = quantity("1", "pressure speed distance", "standard error of the friction coefficient")
    real_area: Array = quantity("1", "pressure speed distance", "real contact area share, perimeter-corrected")
    wear_depth: Array = quantity("m", "pressure speed distance", "approach of both mean planes by wear, at equal load")
    largest_wear: Array = quantity("m", "pressure speed distance", "largest wear of one surface node")
    normal_stiffness: Array = quantity("Pa/m", "pressure speed distance", "interface stiffness dp/d(approach) without the"
                                       " uniform compliance of the blocks")
    block_compliance: Array = quantity("m/Pa", "", "uniform compliance of both blocks, which the stiffness leaves out")
    flash_temperature: Array = quantity("K", "pressure speed distance", "mean flash temperature rise of the contact spots")
    full_slip_distance: Array = quantity("m", "pressure speed distance", "displacement at which every contact node slips")
    shear_limit: Array = quantity("Pa", "", "shear limit at reference speed and temperature")
    limit_at_speed: Array = quantity("Pa", "pressure speed distance", "shear limit at speed and flash temperature")
    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    contact_pressure_new: Array = quantity("Pa", "y x", "contact pressure, first cycle, middle pressure and speed")
    contact_pressure_worn: Array = quantity("Pa", "y x", "contact pressure, last cycle, middle pressure and speed")
    pad_wear: Array = quantity("m", "y x", "wear of the pad nodes after the last cycle, middle pressure and speed")
    disc_wear: Array = quantity("m", "y x", "wear of the disc nodes after the last cycle, middle pressure and speed")
    refinement: Array = quantity("1", "refinement", "nodes per shortest wavelength of the convergence study")
    refinement_area: Array = quantity("1", "refinement", "perimeter-corrected real area share at middle pressure")


@product(version=1)
class FrictionMap:
    """mu(pressure, speed, distance) of the interface and its normal stiffness."""

    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure")
    speed: Array = quantity("m/s", "speed", "sliding speed")
    distance: Array = quantity("m", "distance", "sliding distance")
    friction: Array = quantity("1", "pressure speed distance", "coefficient of friction")
    friction_std: Array = quantity("1", "pressure speed distance", "standard error of the coefficient of friction")
    normal_stiffness: Array = quantity("Pa/m", "pressure distance", "interface stiffness, mean over speed")
    computed_pressure: Array = quantity("Pa", "computed_pressure", "pressures at which micro_friction ran")
    computed_speed: Array = quantity("m/s", "computed_speed", "speeds at which micro_friction ran")


@product(version=1)
class Body:
    """One elastic body: FE mesh, materials and real modes on its supports."""

    node: Array = quantity("m", "nodes xyz", "node positions")
    element: Array = count("elements vertex", "node numbers of each element, order of meshio")
    kind: Array = text("", "meshio cell type of the elements: hexahedron20 or hexahedron27")
    element_material: Array = count("elements", "row of the material table")
    material_name: Array = text("material", "material names")
    density: Array = quantity("kg/m^3", "material", "density")
    elasticity: Array = quantity("Pa", "material voigt strain", "elastic constants, order xx yy zz yz xz xy")
    damping_ratio: Array = quantity("1", "", "damping ratio of the elastic modes of the body")
    frequency: Array = quantity("Hz", "mode", "natural frequencies of the body on its supports alone")
    shape: Array = quantity("1/kg^0.5", "mode nodes xyz", "mass-normalised mode shapes")
    supported: Array = count("support", "nodes held in all directions (rigid supports; none = empty)")


@product(version=1)
class Incidence:
    """Sparse rows: displacement of row i = sum of weight * u[body][node, axis]."""

    rows: Array = count("", "number of rows")
    row: Array = count("entry", "row of the entry")
    body: Array = count("entry", "body of the entry, index into Structure.body_name")
    node: Array = count("entry", "node of the entry")
    axis: Array = count("entry", "axis of the entry: 0, 1, 2 = x, y, z")
    weight: Array = quantity("1", "entry", "weight")


@product(version=2)
class Structure:
    """FE bodies of the brake, their joints, contacts and sensors, and the solved preload."""

    body_name: Array = text("body", "bodies in order: disc, pad_outer, pad_inner, caliper")
    disc: Body = part("brake disc on its mount")
    pad_outer: Body = part("pad with backplate on the finger side, z > 0")
    pad_inner: Body = part("pad with backplate on the piston side, z < 0")
    caliper: Body = part("caliper with fingers and cylinder")
    free_frequency: Array = quantity("Hz", "free_mode", "natural frequencies of the free disc, rigid motions left out")
    free_diameters: Array = count("free_mode", "nodal diameters of the free-disc modes")
    free_out_of_plane: Array = quantity("1", "free_mode", "share of modal mass that moves along the axis")
    joint_name: Array = text("joint", "joint names, e.g. abutment_outer_leading")
    joint_rows: Incidence = part("joint elongation rows (both ends included; a joint to ground has one end)")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness, linearised about the preload")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping")
    contact_body: Array = count("contact", "body that slides on the disc at the contact, index into body_name")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch on the disc face")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_normal: Incidence = part("normal relative displacement, pad minus disc, positive opens")
    contact_tangent: Incidence = part("relative displacement pad minus disc along sliding")
    contact_lateral: Incidence = part("relative displacement pad minus disc radially outwards")
    pressure: Array = quantity("Pa", "pressure", "nominal pad pressures at which the preload was solved")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload, 0 when open")
    closed: Array = count("pressure contact", "1 where the contact is closed")
    law_closure: Array = quantity("m", "closure", "closure (minus gap) axis of the normal contact law, from 0")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions, unit vectors")
    sensor_rows: Incidence = part("sensor displacement rows")
    piston_rows: Incidence = part("piston row: opening force pair between cylinder and inner backplate")
    piston_area: Array = quantity("m^2", "", "pad area on which the nominal pressure acts; piston force = pressure * area")


@product(version=1)
class BeamOnBeam:
    """Two beams on their supports, by their modes: the slider touches the track, which a drive pulls along x.

    Relative displacement is slider minus track; the normal points out of the rubbed face. In steady sliding each
    frequency is a mode at one friction coefficient (the curve); at its maxima modes coalesce and flutter begins.
    """

    body_name: Array = text("body", "bodies in order: slider, track")
    element: Array = text("", "finite elements of the beams: plane or timoshenko")
    mode_body: Array = count("mode", "body of the mode, index into body_name")
    mode_frequency: Array = quantity("Hz", "mode", "modes and residual shapes of each beam apart; 0 where it moves freely")
    mode_damping: Array = quantity("1/s", "mode", "damping of the mass-normalised mode (Rayleigh)")
    contact_normal: Array = quantity("1/kg^0.5", "contact mode", "normal relative displacement, slider minus track, positive opens")
    contact_tangent: Array = quantity("1/kg^0.5", "contact mode", "tangential relative displacement along x, slider minus track")
    contact_position: Array = quantity("m", "contact xyz", "point of contact")
    contact_area: Array = quantity("m^2", "contact", "section of the slider")
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
    onset_friction: Array = quantity("1", "onset", "friction at which they do, without damping")
    end_frequency: Array = quantity("Hz", "flutter_end", "frequencies at which they part again")
    end_friction: Array = quantity("1", "flutter_end", "friction at which they do")
    check_frequency: Array = quantity("Hz", "check_mode", "modes without friction by the other kind of element")
    check_onset_frequency: Array = quantity("Hz", "check_onset", "coalescences by the other kind of element")
    check_onset_friction: Array = quantity("1", "check_onset", "their friction")
    finding: Array = text("finding", "questions to the search for the geometry")
    finding_text: Array = text("finding", "what it found")


@product(version=1)
class Lumped:
    """Masses on springs and dampers, their contacts, inputs and sensors: a sliding model without finite elements.

    Coordinates are named as mass.motion (block.x); a rotation counts as the way in m at a radius of 1 m.
    """

    body_name: Array = text("body", "masses in order")
    coordinate_name: Array = text("coordinate", "coordinates in order, e.g. block.x")
    coordinate_body: Array = count("coordinate", "mass of each coordinate, index into body_name")
    mass: Array = quantity("kg", "coordinate column", "mass matrix")
    gyroscopic: Array = quantity("N s^2/m", "coordinate column", "gyroscopic matrix per rad/s of drive speed")
    joint_name: Array = text("joint", "springs and dampers")
    joint_rows: Array = quantity("1", "joint coordinate", "elongation rows")
    joint_stiffness: Array = quantity("N/m", "joint", "stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "damping")
    contact_name: Array = text("contact", "contacts and friction joints")
    contact_body: Array = count("contact", "mass that the friction force acts on")
    contact_area: Array = quantity("m^2", "contact", "contact area")
    contact_lever: Array = quantity("m", "contact", "sliding speed per speed of the drive")
    contact_gap: Array = quantity("m", "contact", "gap where nothing is loaded, negative where parts are set to press")
    contact_normal: Array = quantity("1", "contact coordinate", "normal rows, positive opens; zero: a friction joint")
    contact_tangent: Array = quantity("1", "contact coordinate", "tangent rows along sliding")
    contact_lateral: Array = quantity("1", "contact coordinate", "lateral rows")
    pressure: Array = quantity("Pa", "pressure", "load factors in Pa: 1 Pa stands for the loads as given")
    preload: Array = quantity("N", "pressure contact", "static normal force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness, 0 where hard or open")
    law_closure: Array = quantity("m", "closure", "closure axis of the normal contact law, empty where hard")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    input_name: Array = text("input", "inputs")
    input_rows: Array = quantity("1", "input coordinate", "generalised force per unit input force")
    input_area: Array = quantity("m^2", "input", "constant input force per Pa of the load factor")
    history_interval: Array = quantity("s", "", "time between the samples of the histories")
    input_history: Array = quantity("N", "sample input", "input forces over time, added to the constant ones")
    drive_history: Array = quantity("1", "drive_sample", "speed of the drive over time, per nominal speed")
    sensor_name: Array = text("sensor", "sensors")
    sensor_rows: Array = quantity("1", "sensor coordinate", "displacement rows")
    sensor_quantity: Array = text("sensor", "what it measures: displacement, velocity or acceleration")
    sensor_unit: Array = text("sensor", "unit of its reading")
    sensor_gain: Array = quantity("1", "sensor", "its reading in that unit per SI unit of its quantity")


@product(version=4)
class ReducedModel:
    """The reduced sliding model: everything that a solver or an effect needs of a sliding system.

    Equation of motion, s = sliding, q = reduced coordinates:
        M q'' + (C + speed G + sum_j c_j b_j b_j^T) q'
              + (K + speed^2 Kc + sum_j k_j b_j b_j^T) q = sum_i (n_i N_i + t_i T_i) + inputs,
    N_i >= 0 the contact force on the pad along its normal row n_i, T_i = mu N_i along its tangent row t_i. A contact
    whose normal row is zero is a friction joint: nothing presses it but its preload. Without a normal contact law
    (size 0) contacts stay as their preload state says; those with a contact_stiffness of 0 as well are hard.
    """

    body_name: Array = text("body", "bodies in order")
    coordinate_body: Array = count("coordinate", "body of each reduced coordinate, index into body_name")
    mass: Array = quantity("kg", "coordinate column", "reduced mass")
    damping: Array = quantity("N s/m", "coordinate column", "reduced damping of the bodies")
    gyroscopic: Array = quantity("N s^2/m", "coordinate column", "gyroscopic matrix per rad/s of disc speed")
    stiffness: Array = quantity("N/m", "coordinate column", "reduced stiffness of the bodies, without joints and contacts")
    centrifugal: Array = quantity("kg", "coordinate column", "stiffness per squared disc speed")
    joint_name: Array = text("joint", "joint names")
    joint_rows: Array = quantity("1", "joint coordinate", "joint elongation rows")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping")
    contact_body: Array = count("contact", "body that slides on the drive at the contact")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_lever: Array = quantity("m", "contact", "sliding speed per speed of the drive: the radius on a disc, 1 m on a belt")
    contact_gap: Array = quantity("m", "contact", "gap where nothing is loaded, negative where parts are set to press")
    contact_normal: Array = quantity("1", "contact coordinate", "normal rows, pad minus disc, positive opens")
    contact_tangent: Array = quantity("1", "contact coordinate", "tangent rows, pad minus disc, along sliding")
    contact_lateral: Array = quantity("1", "contact coordinate", "lateral rows, pad minus disc, radial")
    pressure: Array = quantity("Pa", "pressure", "nominal pad pressures of the preload states")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload")
    law_closure: Array = quantity("m", "closure", "closure axis of the normal contact law")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    shear_pressure: Array = quantity("Pa", "shear", "nominal pressures of the tangential contact law; none = no such law")
    shear_friction: Array = quantity("1", "shear", "coefficient of friction at each of them")
    shear_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness at rest per area, evolution rule")
    shear_elastic_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness per area of the elastic stick")
    shear_exponent: Array = quantity("1", "shear", "exponent of the evolution rule")
    input_name: Array = text("input", "inputs, e.g. piston")
    input_rows: Array = quantity("1", "input coordinate", "input rows: generalised force per unit input force")
    input_area: Array = quantity("m^2", "input", "input force per nominal pad pressure")
    history_interval: Array = quantity("s", "", "time between the samples of the histories, which begin at time 0")
    input_history: Array = quantity("N", "sample input", "input forces over time, added to the former; none = constant")
    drive_history: Array = quantity("1", "drive_sample", "speed of the drive over time, per nominal speed; none = 1")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions")
    sensor_rows: Array = quantity("1", "sensor coordinate", "sensor displacement rows")
    sensor_quantity: Array = text("sensor", "what it measures: displacement, velocity or acceleration")
    sensor_unit: Array = text("sensor", "unit of its reading")
    sensor_gain: Array = quantity("1", "sensor", "its reading in that unit per SI unit of its quantity")
    visible_position: Array = quantity("m", "visible xyz", "surface nodes kept for pictures")
    visible_body: Array = count("visible", "body of the surface nodes")
    visible_face: Array = count("face corner", "quadrilaterals of the surface, row numbers of visible_position")
    recovery: Array = quantity("1", "visible xyz coordinate", "displacement of the surface nodes per coordinate", np.float32)


@product(version=3)
class ComplexModes:
    """Complex modes of the sliding system over friction, and at each operating point of the map."""

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
    corrections: Array = count("", "correction vectors for friction and damping added to the real modes")


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
    separated_share: Array = quantity("1", "operating", "share of contact samples without contact")
    outside_map_share: Array = quantity("1", "operating", "share of friction evaluations outside the computed map")
    caliper_factor: Array = quantity("1", "caliper_factor", "factor on the caliper stiffness, stability map")
    abutment_factor: Array = quantity("1", "abutment_factor", "factor on the abutment stiffness, stability map")
    stability: Array = quantity("1/s", "operating caliper_factor abutment_factor", "largest growth rate of the linearised system")
    stability_root: Array = quantity("Hz", "operating caliper_factor abutment_factor", "frequency of the root that grows so")


@product(version=1)
class Response:
    """Vibration of the elastic brake at the sensors, excited by the contact forces."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    time: Array = quantity("s", "time", "time after the static start")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors", np.float32)
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    velocity_spectrum: Array = quantity("m^2/s^2/Hz", "operating sensor frequency", "one-sided power spectral density (Welch)")
    mode_operating: Array = count("mode", "operating point of the superposed mode")
    mode_frequency: Array = quantity("Hz", "mode", "its natural frequency")
    mode_damping: Array = quantity("1", "mode", "its damping ratio, 0 for a rigid motion")
    coupling: Array = text("", "how forces enter: assembly or disc")


@product(version=3)
class Squeal:
    """Squeal events at the sensors, and levels per band."""

    pressure: Array = quantity("Pa", "operating", "nominal pad pressure")
    speed: Array = quantity("rad/s", "operating", "disc speed")
    sensor_name: Array = text("sensor", "sensor names")
    coupling: Array = text("", "how forces entered the response: assembly or disc")
    reference: Array = quantity("m/s", "", "reference velocity of the level")
    threshold: Array = quantity("1", "", "level above which a peak is a squeal event, dB")
    peak_level: Array = quantity("1", "operating sensor", "highest level in the squeal band, dB")
    peak_frequency: Array = quantity("Hz", "operating sensor", "its frequency")
    band: Array = quantity("Hz", "band", "centre of the third-octave bands")
    band_level: Array = quantity("1", "operating sensor band", "velocity level per band, dB")
    event_operating: Array = count("event", "operating point of the event")
    event_sensor: Array = count("event", "sensor of the event")
    event_frequency: Array = quantity("Hz", "event", "frequency")
    event_level: Array = quantity("1", "event", "largest level, dB")
    event_start: Array = quantity("s", "event", "begin")
    event_duration: Array = quantity("s", "event", "duration")
    event_fundamental: Array = quantity("Hz", "event", "tone whose whole multiple the event is; its own frequency if of none")
    event_order: Array = count("event", "the multiple: 1 = a tone of its own, 2 and more = a harmonic")


@product(version=1)
class Transient:
    """Motion with unilateral contact and dry friction, and the cycle that it ends in, per operating point."""

    pressure: Array = quantity("Pa", "operating", "nominal pressure")
    speed: Array = quantity("rad/s", "operating", "speed of the drive")
    time: Array = quantity("s", "time", "time after the start")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    displacement: Array = quantity("m", "operating sensor time", "displacement at the sensors less that at time 0", np.float32)
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors", np.float32)
    gap: Array = quantity("m", "operating contact time", "gap, negative where the contact is pressed in", np.float32)
    normal_force: Array = quantity("N", "operating contact time", "normal force, mean since the sample before", np.float32)
    friction_force: Array = quantity("N", "operating contact time", "friction force along sliding, mean since the sample before", np.float32)
    slip: Array = quantity("m/s", "operating contact time", "slip velocity, drive less body", np.float32)
    status: Array = count("operating contact time", "0 open, 1 sticking, 2 sliding")
    status_share: Array = quantity("1", "operating contact kind", "share of the steps open, sticking, sliding")
    stored_energy: Array = quantity("J", "operating time", "kinetic and strain energy of bodies and joints")
    input_work: Array = quantity("J", "operating time", "work of the inputs since time 0")
    damping_loss: Array = quantity("J", "operating time", "loss in dampers since time 0")
    normal_work: Array = quantity("J", "operating time", "work of the normal forces on the bodies since time 0")
    friction_work: Array = quantity("J", "operating time", "work of the friction forces on the bodies since time 0")
    sliding_loss: Array = quantity("J", "operating time", "work of the friction forces on the slip since time 0")
    imbalance: Array = quantity("1", "operating", "largest error of the energy balance over the largest energy that passed")
    step: Array = quantity("s", "", "time step")
    window: Array = quantity("s", "", "end of the motion from which spectra and cycles are taken")
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    velocity_spectrum: Array = quantity("m^2/s^2/Hz", "operating sensor frequency", "one-sided power spectral density in the window")
    cycle_frequency: Array = quantity("Hz", "operating sensor", "dominant frequency in the window, 0 at rest")
    cycle_amplitude: Array = quantity("m/s", "operating sensor", "velocity amplitude in the window")
    cycle_drift: Array = quantity("1", "operating sensor", "spread of the amplitude over quarters of the window")
    settled: Array = count("operating sensor", "1 where the cycle has settled in the window")
    growth_rate: Array = quantity("1/s", "operating sensor", "growth rate of the small motion before, 0 where none was seen")
    growth_rate_std: Array = quantity("1/s", "operating sensor", "standard error of the growth rate")
    grew: Array = count("operating sensor", "1 where the motion grew from small to its cycle")
    harmonic_amplitude: Array = quantity("m/s", "operating sensor harmonic", "velocity amplitude at 1, 2, ... times the dominant frequency")


@product(version=1)
class MotionScatter:
    """One motion in several formulations, steps and seeds: what a chaotic motion keeps. First sensor, first contact."""

    formulation: Array = text("run", "contact formulation: hard, forward or lagrange")
    step: Array = quantity("s", "run", "time step")
    seed: Array = count("run", "seed of the start velocity")
    duration: Array = quantity("s", "", "length that is judged")
    friction: Array = quantity("1", "", "coefficient of friction")
    speed: Array = quantity("rad/s", "", "speed of the drive")
    fundamental: Array = quantity("Hz", "run", "strongest line of the velocity")
    harmonic_level: Array = quantity("1", "run order", "level of 1, 2, ... times that frequency re the strongest line, dB")
    harmonic_height: Array = quantity("1", "run order", "height of these lines above the spectrum beside them, dB")
    low_level: Array = quantity("1", "run", "highest line in the low band re the strongest line, dB")
    peak_force: Array = quantity("N", "run", "largest normal force")
    peak_slip: Array = quantity("m/s", "run", "largest slip velocity")
    peak_velocity: Array = quantity("m/s", "run", "largest velocity at the sensor")
    status_share: Array = quantity("1", "run kind", "share of the time open, sticking, sliding")
    vibrating_share: Array = quantity("1", "run", "share of the time that vibrates, T_vib / (T_vib + T_st)")
    burst_length: Array = quantity("s", "run", "mean length of a burst, T_vib")
    pause_length: Array = quantity("s", "run", "mean length of a pause, T_st")
    imbalance: Array = quantity("1", "run", "largest error of the energy balance over the largest energy that passed")


@product(version=1)
class BeamGeometry:
    """One geometry of the beam on beam that meets what the paper prints, what it costs, and what the data leave open."""

    parameter: Array = text("parameter", "parameters of the joint search")
    best: Array = quantity("1", "parameter", "the best geometry, in the unit that the name tells (lengths in mm, else SI)")
    cost: Array = quantity("1", "", "its cost: linear facts and motion")
    linear_cost: Array = quantity("1", "", "its cost, linear facts alone")
    rigid_tilt: Array = quantity("rad", "rigid_search", "tilt of the searches with rigid supports")
    rigid_cost: Array = quantity("1", "rigid_search", "lowest linear cost with rigid supports")
    rigid_best: Array = quantity("1", "rigid_search rigid_parameter", "the geometry with that cost")
    rigid_parameter: Array = text("rigid_parameter", "its parameters")
    yielding_cost: Array = quantity("1", "", "lowest linear cost with supports that yield")
    sampled_parameter: Array = text("sampled_parameter", "parameters that the linear facts depend on")
    lower_bound: Array = quantity("1", "sampled_parameter", "lower bound of the search")
    upper_bound: Array = quantity("1", "sampled_parameter", "upper bound of the search")
    samples: Array = quantity("1", "sample sampled_parameter", "geometries that the linear facts allow")
    onset_frequency: Array = quantity("Hz", "onset", "coalescences of the best geometry")
    onset_friction: Array = quantity("1", "onset", "their friction")
    closed_frequency: Array = quantity("Hz", "closed_mode", "its modes without friction")
    quantity_name: Array = text("quantity", "what is judged of the motion")
    lower: Array = quantity("1", "quantity", "lower end of the band in which it costs nothing (SI; -1e9 = none)")
    upper: Array = quantity("1", "quantity", "upper end of that band (SI; 1e9 = none)")
    motion: Array = quantity("1", "run quantity", "its values in each motion of the best geometry (SI)")
    damping: Array = quantity("1/s", "damping", "damping per mass")
    low_growth: Array = quantity("1/s", "damping", "growth rate of the mode near 400 Hz")
    middle_growth: Array = quantity("1/s", "damping", "growth rate of the mode near 2800 Hz")
    damping_low_level: Array = quantity("1", "damping", "highest line between 250 and 650 Hz re the strongest line, dB")
    damping_fundamental: Array = quantity("Hz", "damping", "strongest line")
    damping_vibrating: Array = quantity("1", "damping", "share of the time that vibrates")
    evaluations: Array = count("", "geometries evaluated")


@product(version=1)
class Comparison:
    """Published values beside ours, row by row."""

    row: Array = text("row", "name of the quantity")
    section: Array = text("row", "part of the source, as its reference file calls it")
    unit: Array = text("row", "unit in which the row is shown")
    published: Array = quantity("1", "row", "published value in that unit (0 where none)")
    published_known: Array = count("row", "1 where the paper gives a value")
    ours: Array = quantity("1", "row", "our value in that unit (0 where none)")
    ours_known: Array = count("row", "1 where the chain computes the quantity")
    tolerance: Array = quantity("1", "row", "tolerance in that unit (0 where the row is not compared by a tolerance)")
    verdict: Array = text("row", "within, outside, or not comparable")
    tuned: Array = text("row", "what was tuned to reach the row, empty where nothing")
    source: Array = text("row", "where the paper says so")
    doubt: Array = text("row", "doubt about the published value, empty where none")
    note: Array = text("row", "how our value was formed")


@product(version=1)
class Report:
    """The report page of a case."""

    html: Array = text("", "self-contained page")


@product(version=1)
class Channel:
    """One sampled signal of a run."""

    samples: Array = quantity("1", "sample", "samples in the unit that `unit` names; 0 where missing")
    missing: Array = count("sample_gap bound", "first sample of each stretch without data, and the first after it")
    unit: Array = text("", "coherent SI unit of the samples")
    measures: Array = text("", "what is measured: displacement, velocity, acceleration, force, pressure, voltage, ...")
    rate: Array = quantity("Hz", "", "sampling rate")
    begin: Array = quantity("s", "", "time of the first sample")
    place: Array = text("", "named point or joint; empty where nothing is said")
    position: Array = quantity("m", "xyz", "position of the point; size 0 where nothing is said")
    direction: Array = quantity("1", "axis", "direction, unit vector; size 0 where nothing is said")
    role: Array = text("", "response or excitation")


@product(version=1)
class Condition:
    """A condition of a run: one value, or a series over time."""

    value: Array = quantity("1", "moment", "value in the unit that `unit` names")
    time: Array = quantity("s", "moment", "time of each value; 0 for a condition that does not change")
    unit: Array = text("", "coherent SI unit of the values")


@product(version=1)
class FrequencyResponse:
    """A measured frequency response function."""

    frequency: Array = quantity("Hz", "frequency", "frequency axis")
    response: Array = quantity("1", "frequency", "response per reference, in the unit that `unit` names", complex)
    unit: Array = text("", "unit of the function, e.g. m/s^2/N")
    place: Array = text("", "place and direction of the response")
    reference: Array = text("", "place and direction of the reference")


@product(version=1)
class MeasuredModes:
    """Identified modes with their standard deviations."""

    frequency: Array = quantity("Hz", "mode", "natural frequencies")
    frequency_std: Array = quantity("Hz", "mode", "their standard deviations")
    damping_ratio: Array = quantity("1", "mode", "damping ratios; 0 where not measured")
    damping_ratio_std: Array = quantity("1", "mode", "their standard deviations; 0 where not measured")
    place: Array = text("place", "places and directions of the shapes")
    shape: Array = quantity("1", "mode place", "mode shapes", complex)


@product(version=1)
class Lines:
    """A published list of peaks, where no raw signal exists."""

    frequency: Array = quantity("Hz", "line", "frequencies")
    frequency_tolerance: Array = quantity("Hz", "line", "how far off they may be read")
    level: Array = quantity("1", "line", "levels in dB re the strongest line; 0 where none is given")
    level_known: Array = count("line", "1 where a level is given")
    place: Array = text("", "where the spectrum was taken")


@product(version=1)
class Topography:
    """A measured height map."""

    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    height: Array = quantity("m", "y x", "heights, outwards of the solid")
    body: Array = text("", "body, e.g. disc or pad")
    state: Array = text("", "new or worn")


@product(version=1)
class MeasuredFriction:
    """Measured coefficients of friction with their conditions."""

    friction: Array = quantity("1", "sample", "coefficient of friction")
    friction_std: Array = quantity("1", "sample", "its standard error")
    pressure: Array = quantity("Pa", "sample", "nominal contact pressure")
    speed: Array = quantity("m/s", "sample", "sliding speed")
    distance: Array = quantity("m", "sample", "sliding distance")
    temperature: Array = quantity("K", "sample", "temperature")


@product(version=1)
class Run:
    """One run on a test bench, or a declared stretch of a long record."""

    description: Array = text("", "what was done")
    repeat_of: Array = text("", "name of the run that this one repeats; empty for none")
    conditions: dict[str, Condition] = parts("conditions by name: pressure, speed, normal_load, temperature, ...")
    channels: dict[str, Channel] = parts("sampled signals by name")
    frf: dict[str, FrequencyResponse] = parts("frequency response functions by name")
    modes: dict[str, MeasuredModes] = parts("identified modes by name")
    lines: dict[str, Lines] = parts("published peak lists by name")
    topography: dict[str, Topography] = parts("height maps by name")
    friction: dict[str, MeasuredFriction] = parts("measured friction by name")


@product(version=1)
class Recording:
    """What a bench wrote, in one form; simulations embed the same runs in their products."""

    source: Array = text("source", "files it was read from, with SHA-256")
    runs: dict[str, Run] = parts("runs by name")


@product(version=1)
class Rupture:
    """Dynamic rupture of the interface of two plates: fronts, slip, velocity field, and studies of what they rest on.

    x along the interface from the left edge, y upwards from the interface; slip = lower minus upper along x. Where a
    count field says 0 (not reached, unknown), the quantity beside it is 0 and means nothing.
    """

    x: Array = quantity("m", "x", "interface nodes")
    static_pressure: Array = quantity("Pa", "x", "pressure before the rupture")
    static_shear: Array = quantity("Pa", "x", "shear before the rupture, friction on the upper plate along x")
    static_slip: Array = quantity("m", "x", "slip of the static preload, where it exceeded the limit")
    shift: Array = quantity("m", "xy", "u0 and v0, shifts of the lower far edge; 0 where the preload is uniform")
    reached: Array = count("x", "1 where the pulse or the nucleation has passed")
    arrival: Array = quantity("s", "x", "arrival of the pulse: half of the peak slip rate on its rise")
    first_slip: Array = quantity("s", "x", "first slip of any size; earlier than the arrival in the P precursor")
    healed: Array = quantity("s", "x", "end of the slip episode of the pulse")
    front_speed: Array = quantity("m/s", "x", "speed of the front, lines through the arrivals within a window")
    peak_slip_rate: Array = quantity("m/s", "x", "largest slip rate")
    profile_time: Array = quantity("s", "profile", "times of the slip profiles")
    slip: Array = quantity("m", "profile x", "slip")
    slip_growth: Array = quantity("1", "", "slip of the right pulse 1.4 mm from the centre over 0.8 mm; 0 where not there")
    side: Array = text("side", "side of the nucleation: left, right")
    stop: Array = quantity("m", "side", "outermost node that the pulse reached")
    outcome: Array = text("side", "died (within the run-in), stopped, running (at the end of the time) or edge")
    speed: Array = quantity("m/s", "side", "speed beyond the run-in")
    speed_error: Array = quantity("m/s", "side", "its standard error")
    kind: Array = text("side", "pulse (the interface heals behind the front), crack or none")
    healing_time: Array = quantity("s", "side", "median duration of the slip episode of the pulse")
    precursor_lead: Array = quantity("s", "side", "largest lead of the first slip over the pulse")
    precursor_reach: Array = quantity("m", "side", "outermost slip of any size, from the centre")
    mach_known: Array = count("side solid", "1 where the velocity field shows a ridge behind a front faster than shear")
    mach_angle: Array = quantity("rad", "side solid", "angle of the shear Mach front to the interface, from the field")
    mach_expected: Array = quantity("rad", "side solid", "angle whose sine is shear speed over front speed until then")
    phrase: Array = text("", "outcome of both fronts in words")
    opened: Array = count("", "interface nodes times steps without contact")
    solid: Array = text("solid", "upper (solid 1), lower (solid 2)")
    dilatational_speed: Array = quantity("m/s", "solid", "cP")
    shear_speed: Array = quantity("m/s", "solid", "cS")
    rayleigh_speed: Array = quantity("m/s", "solid", "cR")
    interface_wave: Array = count("", "1 where the generalised Rayleigh wave exists")
    generalised_rayleigh_speed: Array = quantity("m/s", "", "its speed")
    pulse_exists: Array = count("", "1 where Adams' intersonic pulse exists")
    pulse_speed: Array = quantity("m/s", "bound", "lowest and highest speed of Adams' intersonic pulse, which runs to the left")
    energy_name: Array = text("energy", "released, heat, kinetic, strain, taken (damping and edges)")
    energy: Array = quantity("J/m", "energy", "energy at the end, per depth")
    step: Array = quantity("s", "", "time step")
    duration: Array = quantity("s", "", "time computed")
    node_updates: Array = count("", "nodes times steps of the main run")
    frame_time: Array = quantity("s", "frame", "times of the velocity fields")
    frame_state: Array = count("frame x", "interface: 0 stick, 1 slip, 2 open")
    field_x: Array = quantity("m", "column", "columns of the velocity fields")
    field_y: Array = quantity("m", "row", "rows of the velocity fields; the interface stands twice, lower plate first")
    speed_field: Array = quantity("m/s", "frame row column", "magnitude of the velocity", np.float32)
    study: Array = text("run", "study that the run belongs to: mesh, stress, damping, poisson")
    study_spacing: Array = quantity("m", "run", "spacing")
    study_memory: Array = quantity("s", "run", "memory time of the friction, 0 = Coulomb")
    study_ratio: Array = quantity("1", "run", "shear over pressure")
    study_damping: Array = quantity("1", "run", "stiffness damping over spacing / cP")
    study_poisson: Array = quantity("1", "run", "Poisson ratio of both solids")
    study_stop: Array = quantity("m", "run side", "outermost node that the pulse reached")
    study_speed: Array = quantity("m/s", "run side", "speed beyond the run-in")
    study_width: Array = quantity("m", "run side", "speed times healing time: width of the pulse")
    study_outcome: Array = text("run side", "outcome of the side")
    study_kind: Array = text("run side", "pulse, crack or none")
    study_growth: Array = quantity("1", "run", "slip_growth of the run")
    study_phrase: Array = text("run", "outcome of both fronts in words")


@product(version=1)
class InterfaceLaw:
    """Normal and tangential law of a rough interface from its summits, and the three descriptions of its friction."""

    source: Array = text("", "where the summits come from")
    summit_density: Array = quantity("1/m^2", "", "summits per area")
    summit_mean: Array = quantity("m", "", "mean height of the summits above the mean plane")
    summit_spread: Array = quantity("m", "", "standard deviation of their heights, Gaussian")
    summit_curvature: Array = quantity("1/m", "", "median of their curvatures")
    curvature_spread: Array = quantity("1", "", "standard deviation of the logarithm of the curvatures")
    curvature_correlation: Array = quantity("1", "", "correlation of that logarithm and the height")
    shear_limit: Array = quantity("Pa", "", "yield stress in shear of the contact spots")
    gap: Array = quantity("m", "gap", "distance of the mean planes, falling")
    gap_pressure: Array = quantity("Pa", "gap", "nominal contact pressure at the gap")
    real_area: Array = quantity("1", "gap", "real contact area share at the gap")
    normal_stiffness: Array = quantity("Pa/m", "gap", "interface stiffness at the gap")
    pressure: Array = quantity("Pa", "pressure", "nominal contact pressures of the shear law")
    displacement: Array = quantity("m", "displacement", "tangential displacement from rest")
    shear: Array = quantity("Pa", "pressure displacement", "shear stress of the summits")
    evolution_shear: Array = quantity("Pa", "pressure displacement", "shear stress of the fitted evolution rule")
    elastic_shear: Array = quantity("Pa", "pressure displacement", "shear stress of the fitted elastic stick")
    tangential_stiffness: Array = quantity("Pa/m", "pressure", "tangential stiffness at rest, c_t")
    limit: Array = quantity("Pa", "pressure", "shear stress in full slip, tau_max")
    exponent: Array = quantity("1", "pressure", "exponent m of dtau/dv = c_t (1 - tau / tau_max)^m")
    elastic_stiffness: Array = quantity("Pa/m", "pressure", "stiffness of the elastic stick of the same energy")
    friction: Array = quantity("1", "pressure", "coefficient of friction, tau_max over pressure")


@product(version=2)
class PinOnDisc:
    """Pin and disc as FE bodies with hub, clamp and guide, their contact and sensors, and the load states.

    The names of Structure, where the thing is the same; the rubbed body is the pin.
    """

    body_name: Array = text("body", "bodies in order: disc, pin")
    disc: Body = part("disc on hub, collar and shaft")
    pin: Body = part("pin with accelerometer and clamp block")
    joint_name: Array = text("joint", "joint names, e.g. guide")
    joint_rows: Incidence = part("joint elongation rows; all joints of the clamp end on the ground")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping")
    contact_body: Array = count("contact", "body that slides on the disc at the contact, index into body_name")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch on the disc face")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_normal: Incidence = part("normal relative displacement, pin minus disc, positive opens")
    contact_tangent: Incidence = part("relative displacement pin minus disc along sliding")
    contact_lateral: Incidence = part("relative displacement pin minus disc radially outwards")
    load: Array = quantity("kg", "pressure", "weights on the pin")
    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure of each weight")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload")
    closed: Array = count("pressure contact", "1 where the contact is closed")
    law_closure: Array = quantity("m", "closure", "closure (minus gap) axis of the normal contact law; none = hard contact")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    shear_pressure: Array = quantity("Pa", "shear", "nominal pressures of the tangential contact law")
    shear_friction: Array = quantity("1", "shear", "coefficient of friction at each of them")
    shear_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness at rest per area, evolution rule")
    shear_elastic_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness per area of the elastic stick")
    shear_exponent: Array = quantity("1", "shear", "exponent of the evolution rule")
    friction: Array = quantity("1", "pressure", "coefficient of friction of that law at each weight")
    disc_frequency: Array = quantity("Hz", "disc_mode", "natural frequencies of the disc on its shaft")
    disc_diameters: Array = count("disc_mode", "nodal diameters of the modes of the disc")
    disc_out_of_plane: Array = quantity("1", "disc_mode", "share of modal mass that moves along the axis")
    pin_length: Array = quantity("m", "pin_length", "free lengths of the pin: that of the case, then those compared")
    pin_frequency: Array = quantity("Hz", "pin_length pin_mode", "natural frequencies of the pin, rigidly clamped, not touching")
    tilt: Array = quantity("rad", "", "tilt of the pin; positive: clamp upstream")
    contact_offset: Array = quantity("m", "", "contact off the middle of the tip, along sliding")
    base_mass: Array = quantity("kg", "", "mass that moves with the clamp")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions, unit vectors")
    sensor_rows: Incidence = part("sensor displacement rows")
    load_rows: Incidence = part("row of the weight: it presses the clamp towards the disc")
    load_area: Array = quantity("m^2", "", "contact area on which the nominal pressure acts; load = pressure * area")


@product(version=2)
class LockIn:
    """Complex modes and settled motion of the pin on disc over its length, load, speed and angle, one row a point."""

    scan: Array = text("point", "what is varied: length, load, speed or tilt; case = the points compared with the paper")
    length: Array = quantity("m", "point", "free length of the pin")
    load: Array = quantity("kg", "point", "weight on the pin")
    speed: Array = quantity("rad/s", "point", "speed of the disc")
    tilt: Array = quantity("rad", "point", "tilt of the pin; positive: clamp upstream")
    base_mass: Array = quantity("kg", "point", "mass that moves with the clamp")
    friction: Array = quantity("1", "point", "coefficient of friction")
    root: Array = quantity("1/s", "point", "root of the fastest growing mode, sigma + i omega; 0 where none grows", complex)
    disc_mode: Array = quantity("Hz", "point", "own frequency of the disc nearest the base or root, 0 where neither is")
    pin_mode: Array = quantity("Hz", "point", "own frequency of the pin nearest the base or root, 0 where neither is")
    kind: Array = text("point", "none, classical, intermediate, multiple, dual base or other")
    base: Array = quantity("Hz", "point", "base frequency of the settled motion of the disc, 0 = none")
    second: Array = quantity("Hz", "point", "second base or distance of side bands, 0 = none")
    settled: Array = count("point", "1 where the amplitudes of disc and pin no longer change in the window, or nothing grows")
    amplitude: Array = quantity("m/s", "point body", "effective velocity along the disc's axis: disc, pin")
    harmonics: Array = count("point body", "base and multiples without a gap in the spectrum of disc, pin")
    levels: Array = quantity("1", "point body multiple", "level in dB of multiples re the base: disc, pin; -200 = no line")
    open_share: Array = quantity("1", "point", "share of time without contact")
    trace_time: Array = quantity("s", "sample", "time of the last milliseconds of the motion")
    trace: Array = quantity("m/s", "case body sample", "velocity along the disc's axis at the cases: disc, pin", np.float32)
    frequency: Array = quantity("Hz", "line", "lines of the spectra")
    spectrum: Array = quantity("1", "case body line", "level in dB re the highest line, of that velocity in the window",
                               np.float32)


@product(version=1)
class FrictionDescriptions:
    """The three descriptions of friction in an implicit setting: what each costs, and what they agree on."""

    description: Array = text("description", "evolution, elastic, rigid")
    modulation: Array = quantity("1", "modulation", "amplitude of the pulsating load over its mean; above 1 contact is lost")
    iterations: Array = quantity("1", "tangent modulation description", "Newton iterations per step, mean; first without the unsymmetric term, then with it")
    worst: Array = count("tangent modulation description", "largest number of iterations of one step")
    halvings: Array = count("tangent modulation description", "steps that did not converge and were halved")
    converged: Array = count("tangent modulation description", "1 where no step had to be given up")
    cost: Array = quantity("1", "tangent modulation description", "work of the factorisations over that of the cheapest")
    sliding_share: Array = quantity("1", "tangent modulation description", "share of contacts that slide, mean over the steps")
    mean_shift: Array = quantity("m", "tangent modulation description", "mean displacement of the block along sliding, second half")
    curve_error: Array = quantity("1", "description", "deviation from the curve of one Hertz contact over its limit, root mean square")
    step: Array = quantity("s", "", "time step")
