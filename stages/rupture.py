"""Stage rupture: dynamic rupture of the interface between two dissimilar plates."""

from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.closed_form.slip_pulse import intersonic_pulse_speeds
from pipeline.physics.closed_form.wave_speeds import Solid, generalised_rayleigh_speed, rayleigh_speed
from pipeline.physics.rupture import fronts
from pipeline.physics.rupture.dynamics import OPEN
from pipeline.physics.rupture.history import run
from pipeline.physics.rupture.mach_fronts import View, front_angle
from pipeline.products import Rupture
from pipeline.systems.bimaterial_rupture import Parameters, build, refuse

SIDES = {"left": fronts.LEFT, "right": fronts.RIGHT}
#: depth in m of the strips in which Mach fronts are looked for
_STRIP = 1e-3
#: distances in m from the centre between which the slip of the right pulse is compared (Figure 9 of the paper)
_GROWTH = 0.8e-3, 1.4e-3


class Material(Section):
    """One solid."""

    youngs_modulus: Quantity("Pa", gt=0) = option(..., "Young's modulus")
    poisson_ratio: float = option(0.25, "Poisson ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("1246 kg/m^3", "density")


class Friction(Section):
    """Law of the interface."""

    static: float = option(1.0, "friction coefficient before slip", gt=0)
    dynamic: float | None = option(None, "friction coefficient after the weakening slip; none = static (Coulomb)", ge=0)
    weakening_slip: Quantity("m", gt=0) = option("1 um", "slip over which friction falls from static to dynamic")
    memory_time: Quantity("s", ge=0) = option("0 s", "Prakash-Clifton memory of the pressure in time; 0 = none")
    memory_slip: Quantity("m", ge=0) = option("0 m", "Prakash-Clifton memory of the pressure in slip; 0 = none")


class Studies(Section):
    """Variations of the main run; an empty list omits a study."""

    spacings: Quantities("m", gt=0) | None = option(("50 um", "25 um", "12.5 um"),
                                                     "mesh study, with and without memory")
    memory_time: Quantity("s", gt=0) = option("20 ns", "memory of the regularised runs of the mesh study")
    stress_ratios: tuple[float, ...] = option(
        (0.7, 0.8, 0.85, 0.88, 0.9, 0.92, 0.93, 0.94, 0.95, 0.96, 0.97, 0.98, 0.99), "shear over pressure, phases")
    damping_shares: tuple[float, ...] = option((0.025, 0.05, 0.1, 0.2, 0.4), "stiffness damping, its study")
    poisson_ratios: tuple[float, ...] = option((0.25, 0.28, 0.31), "Poisson ratio of both solids")
    mesh_poisson: float | None = option(None, "Poisson ratio at which the mesh study is repeated; none = not", lt=0.5)


class Settings(Section):
    """The two plates, their interface, the static state and what is recorded."""

    upper: Material = option(Material(youngs_modulus="5.3 GPa"), "solid 1, held at its far edge")
    lower: Material = option(Material(youngs_modulus="3.392 GPa"), "solid 2, shifted at its far edge")
    length: Quantity("m", gt=0) = option("20 mm", "length of both plates")
    height: Quantity("m", gt=0) = option("5 mm", "height of each plate")
    plane: Literal["strain", "stress"] = option("strain", "plane strain or plane stress")
    spacing: Quantity("m", gt=0) = option("25 um", "edge of the square elements")
    lower_spacing: Quantity("m", gt=0) | None = option(None, "edge of the lower plate's elements; none = the same."
                                                       " Unlike meshes need the uniform preload")
    damping_share: float = option(0.1, "stiffness damping beta over spacing / cP", ge=0)
    step_share: float = option(0.9, "time step over the stability limit", gt=0, le=1)
    side_edges: Literal["reflecting", "absorbing"] = option("reflecting", "side edges: free or absorbing")
    far_edges: Literal["reflecting", "absorbing"] = option("reflecting", "far edges: held or absorbing")
    friction: Friction = option(Friction(), "law of the interface")
    pressure: Quantity("Pa", gt=0) = option("1 MPa", "mean static pressure; scales stresses and particle speeds alone")
    stress_ratio: float = option(0.94, "static shear over pressure, while every node sticks", ge=0)
    ratio_of: Literal["middle", "forces"] = option(
        "middle", "the ratio is that at the middle of the interface, or that of both forces: the middle has more")
    preload: Literal["solved", "uniform"] = option("solved", "solved: shifts u0, v0 with free side edges;"
                                                   " uniform: the same traction everywhere")
    nucleation_length: Quantity("m", gt=0) = option("0.125 mm", "middle of the interface, where friction vanishes")
    duration: Quantity("s", gt=0) = option("2.02 us", "time computed")
    profile_step: Quantity("s", gt=0) = option("0.2 us", "time between slip profiles; the last one is at the end")
    frames: int = option(40, "pictures of the velocity field", ge=2, le=400)
    field_spacing: Quantity("m", gt=0) = option("50 um", "node distance of the stored velocity fields")
    run_in: Quantity("m", gt=0) = option("0.25 mm", "distance from the centre left out of the front speeds")
    speed_window: Quantity("m", gt=0) = option("0.2 mm", "window of the speed over x")
    studies: Studies = option(Studies(), "variations of the main run")


def _check(sections):
    """Refuse inconsistent settings before anything is computed."""
    settings = sections["rupture"]
    base = _parameters(settings, "superlu")
    refuse(base)
    if settings.run_in >= 0.5 * settings.length:
        raise ConfigError("rupture.run_in", f"less than half the length, {0.5 * settings.length:g} m",
                          f"{settings.run_in:g} m", "beyond it no front has a speed")
    build(replace(base, solved_preload=False))
    for each in _variations(settings):
        try:
            build(replace(base, solved_preload=False, **each["changes"]))
        except ConfigError as error:
            raise ConfigError(f"rupture.studies, {each['study']} study: {error}") from None
    for spacing in (base.lower_spacing, base.upper_spacing):
        _stride(settings, spacing)


@stage(check=_check)
def rupture(settings: Settings, context: Context) -> Rupture:
    """Simulate dynamic rupture between two dissimilar plates, and the sensitivity of its fronts.

    Method:
    Two plates of square bilinear elements ({spacing}, plane {plane}) with lumped mass, central differences, stiffness
    damping of {damping_share} spacing / cP and forward-increment Lagrange multipliers are in frictional contact.
    A {preload} static state with a shear-to-pressure ratio of {stress_ratio} is perturbed by removing friction over
    {nucleation_length}. Stress ratio, mesh and damping are tuned: the paper gives none of them. A pulse arrives when
    the slip rate rises to half of its peak, which excludes the P precursor. Coulomb friction between dissimilar solids
    is ill-posed (Renardy 1992; Adams 1995; Ranjith and Rice 2001): pulses narrow with the mesh without converging;
    Prakash-Clifton regularisation restores convergence. Mesh, stress, damping and Poisson ratio were varied.
    """
    base = _parameters(settings, context.solver)
    system = build(base)
    stride = [_stride(settings, s) for s in (base.lower_spacing, base.upper_spacing)]
    history = run(system.lower, system.upper, system.interface, settings.duration, settings.step_share,
                  settings.frames, stride, [int(_STRIP / s) + 1 for s in (base.lower_spacing, base.upper_spacing)])
    observed = _observed(history.record, system, settings)
    varied = context.map(partial(_vary, base=base, settings=settings), _variations(settings), "other ruptures")
    return Rupture(**_static(system), **_fronts(history, system, settings, observed), **_waves(settings, base),
                   **_angles(history, system, base, settings, observed), **_fields(history, system, stride),
                   **_study(varied), **_account(history, system, settings))


def _parameters(settings, solver):
    solids = [Solid(m.youngs_modulus, m.poisson_ratio, m.density, settings.plane == "stress")
              for m in (settings.upper, settings.lower)]
    law = settings.friction
    return Parameters(
        *solids, settings.length, settings.height, settings.spacing, settings.lower_spacing or settings.spacing,
        settings.damping_share, settings.side_edges == "absorbing", settings.far_edges == "absorbing", law.static,
        law.static if law.dynamic is None else law.dynamic, law.weakening_slip, law.memory_time, law.memory_slip,
        settings.nucleation_length, settings.pressure, settings.stress_ratio, settings.preload == "solved",
        settings.ratio_of == "forces", solver)


def _variations(settings):
    """One dict per run of the studies: study and changes of the Parameters."""
    studies, variations = settings.studies, []
    solids = (settings.upper, settings.lower)

    def poisson(ratio):
        return {name: Solid(m.youngs_modulus, ratio, m.density, settings.plane == "stress")
                for name, m in zip(("upper", "lower"), solids, strict=True)}

    for spacing in studies.spacings or ():
        for memory in (0.0, studies.memory_time):
            mesh = {"upper_spacing": spacing, "lower_spacing": spacing, "memory_time": memory}
            variations.append({"study": "mesh", "changes": mesh})
            if studies.mesh_poisson is not None:
                variations.append({"study": "mesh", "changes": {**mesh, **poisson(studies.mesh_poisson)}})
    variations += [{"study": "stress", "changes": {"ratio": ratio}} for ratio in studies.stress_ratios]
    variations += [{"study": "damping", "changes": {"damping_share": share}} for share in studies.damping_shares]
    return variations + [{"study": "poisson", "changes": poisson(ratio)} for ratio in studies.poisson_ratios]


def _vary(variation, base, settings):
    """One row of the studies; the preload is uniform there."""
    parameters = replace(base, solved_preload=False, **variation["changes"])
    system = build(parameters)
    history = run(system.lower, system.upper, system.interface, settings.duration, settings.step_share)
    _, left, right, phrase = _observed(history.record, system, settings)
    both = (left, right)
    return {"study": variation["study"], "study_spacing": parameters.upper_spacing,
            "study_memory": parameters.memory_time, "study_ratio": parameters.ratio,
            "study_damping": parameters.damping_share, "study_poisson": parameters.upper.poisson_ratio,
            "study_stop": [f.stop for f in both], "study_speed": [f.speed for f in both],
            "study_width": [f.speed * f.healing_time for f in both], "study_outcome": [f.outcome for f in both],
            "study_kind": [f.kind for f in both], "study_growth": _growth(history, system, right),
            "study_phrase": phrase}


def _study(rows):
    names = [field for field in Rupture.__dataclass_fields__ if field.startswith("study")]
    columns = {name: [row[name] for row in rows] for name in names}
    for name in ("study_stop", "study_speed", "study_width", "study_outcome", "study_kind"):
        columns[name] = np.reshape(columns[name], (-1, 2))
    return columns


def _observed(record, system, settings):
    """(Arrival, left Front, right Front, phrase)."""
    geometry = system.x, system.centre, system.half_width
    arrival = fronts.arrivals(record, *geometry)
    left, right = (fronts.front(record, arrival, *geometry, settings.run_in, side) for side in SIDES.values())
    return arrival, left, right, fronts.named(left, right, bool((record.state == OPEN).any()))


def _growth(history, system, right):
    """Slip at the end at the far of the places ``_GROWTH`` over that at the near one; 0 where the front is between."""
    near, far = np.interp(system.centre + np.array(_GROWTH), system.x, history.motion.slip)
    return far / near if right.stop >= system.centre + _GROWTH[1] and near > 0.0 else 0.0


def _static(system):
    known = system.preload
    return {"x": system.x, "static_pressure": system.interface.pressure, "static_shear": system.interface.shear,
            "static_slip": np.zeros(system.x.size) if known is None else known.slip,
            "shift": [0.0, 0.0] if known is None else [known.shift_x, known.shift_y]}


def _fronts(history, system, settings, observed):
    arrival, left, right, phrase = observed
    record = history.record
    times = np.append(np.arange(settings.profile_step, settings.duration * (1.0 - 1e-9), settings.profile_step),
                      settings.duration)
    same = ("stop", "outcome", "speed", "speed_error", "kind", "healing_time", "precursor_lead", "precursor_reach")
    return {"side": list(SIDES), **{name: [getattr(f, name) for f in (left, right)] for name in same},
            "reached": arrival.reached, "arrival": arrival.arrival, "first_slip": arrival.first_slip,
            "healed": arrival.healed, "front_speed": fronts.local_speed(arrival, system.x, settings.speed_window),
            "slip_growth": _growth(history, system, right),
            "peak_slip_rate": np.abs(record.slip_rate).max(axis=0).astype(float), "profile_time": times,
            "slip": fronts.slip_profiles(record, history.step, times), "phrase": phrase}


def _waves(settings, base):
    solids = base.upper, base.lower
    interface_wave = generalised_rayleigh_speed(*solids)
    pulse = intersonic_pulse_speeds(*solids, settings.friction.static)
    return {"solid": ["upper", "lower"], "dilatational_speed": [s.dilatational_speed for s in solids],
            "shear_speed": [s.shear_speed for s in solids], "rayleigh_speed": [rayleigh_speed(s) for s in solids],
            "interface_wave": int(interface_wave is not None), "generalised_rayleigh_speed": interface_wave or 0.0,
            "pulse_exists": int(pulse is not None), "pulse_speed": pulse or (0.0, 0.0)}


def _angles(history, system, base, settings, observed):
    """Mach angles on both sides of both plates; the lower one is seen upside down."""
    views = [View(history.frame_time, tuple(pair[1] for pair in history.strips), system.upper.spacing,
                  base.upper.shear_speed),
             View(history.frame_time, tuple(pair[0][:, ::-1] * [[[1.0]], [[-1.0]]] for pair in history.strips),
                  system.lower.spacing, base.lower.shear_speed)]
    angles = np.array([[front_angle(view, observed[0], system.x, system.centre, settings.run_in, side)
                        for view in views] for side in SIDES.values()])
    return {"mach_known": np.isfinite(angles[..., 0]).astype(int), "mach_angle": np.nan_to_num(angles[..., 0]),
            "mach_expected": np.nan_to_num(angles[..., 1])}


def _stride(settings, spacing):
    stride = round(settings.field_spacing / spacing)
    fits = all(round(side / spacing) % max(stride, 1) == 0 for side in (settings.length, settings.height))
    if stride < 1 or abs(stride * spacing - settings.field_spacing) > 1e-6 * settings.field_spacing or not fits:
        raise ConfigError("rupture.field_spacing", f"a multiple of the spacing {spacing:g} m that divides both sides",
                          f"{settings.field_spacing:g} m")
    return stride


def _fields(history, system, stride):
    lower, upper = system.lower, system.upper
    below, above = (np.arange(0, grid.rows, by) * grid.spacing for grid, by in ((lower, stride[0]), (upper, stride[1])))
    shown = [np.concatenate([np.hypot(*velocity) for velocity in pair]) for pair in history.frames]
    rows = np.searchsorted(history.record.time, history.frame_time * (1.0 - 1e-9))
    return {"frame_time": history.frame_time, "frame_state": history.record.state[rows].astype(np.int64),
            "field_x": np.arange(0, upper.columns, stride[1]) * upper.spacing,
            "field_y": np.concatenate([below - below[-1], above]), "speed_field": np.array(shown)}


def _account(history, system, settings):
    energy = history.energy
    nodes = sum(grid.rows * grid.columns for grid in (system.lower, system.upper))
    return {"energy_name": [*energy._fields, "taken"], "energy": [*energy, energy.taken], "step": history.step,
            "duration": settings.duration, "node_updates": nodes * history.record.time.size,
            "opened": int((history.record.state == OPEN).sum())}
