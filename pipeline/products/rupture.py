"""Dynamic rupture of the interface of two plates."""

import numpy as np

from pipeline.contract import Array, count, product, quantity, text


@product(version=1)
class Rupture:
    """Dynamic rupture of the interface of two plates: fronts, slip, velocity field, and studies of what they rest on.

    x along the interface from the left edge, y upwards from the interface; slip = lower minus upper along x. Where a
    count field says 0 (not reached, unknown), the quantity beside it is 0 and means nothing.
    """

    x: Array = quantity("m", "x", "interface nodes")
    static_pressure: Array = quantity("Pa", "x", "pressure before the rupture")
    static_shear: Array = quantity("Pa", "x", "shear before the rupture, friction on the upper plate along x")
    static_slip: Array = quantity("m", "x", "slip of the static preload, where it exceeds the limit")
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
    mach_expected: Array = quantity("rad", "side solid", "angle whose sine is shear speed over front speed up to then")
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
    field_y: Array = quantity("m", "row", "rows of the velocity fields; the interface occurs twice, lower plate first")
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
