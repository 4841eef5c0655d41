"""Stage multibody: flexible pads and caliper on a rigid disc of four sub-discs, friction from the map."""

from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Literal

import numpy as np

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.pads import braked, kept, refuse_idle, with_terms
from pipeline.contract import ConfigError, Context, Quantities, Quantity, Section, option, stage
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads import exudyn_model, newmark
from pipeline.physics.pads.contact_history import contact_history
from pipeline.physics.pads.energy_balance import energy_balance
from pipeline.physics.pads.memory import remembers
from pipeline.physics.pads.pad_motion import gravity_rows, sliding_axes
from pipeline.physics.pads.pad_system import pad_system
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import static_start
from pipeline.physics.pads.stability_map import stability_map
from pipeline.physics.signals.oscillation import FEWEST_PERIODS, dominant_frequency, growth_rate, sign_is_decided
from pipeline.products import Effects, FrictionMap, Multibody, ReducedModel

DISC = "disc"
#: joints that carry the caliper and those that guide the pads, by a part of their names
CALIPER, ABUTMENT = ("guide_pin", "bolt", "finger", "piston"), ("abutment",)
#: largest angle in rad that a kept mode turns per step: the trapezoidal rule then lowers its frequency by 1.3 %
LARGEST_ANGLE = 0.4
INTEGRATORS = {"exudyn": exudyn_model.integrate, "newmark": newmark.integrate}


class Settings(Section):
    """Operating points, the tessellated disc, time stepping and the stability map."""

    pressures: Quantities("Pa", gt=0) = option(("1 MPa", "2 MPa", "3 MPa"), "nominal pad pressures")
    speeds: Quantities("rad/s", gt=0) = option(("8.5 rad/s", "10.25 rad/s", "12 rad/s"), "disc speeds")
    coupling: Literal["one_way"] = option(
        "one_way", "one_way: the disc is rigid here, and its modes answer to the forces afterwards, as in the paper")
    sectors: int = option(16, "sectors per revolution, dealt to the four sub-discs in turn; a multiple of 4", ge=4)
    bedding: Quantities("m", ge=0) = option(
        ("2 mm", "4 mm", "6 mm", "8 mm"), "distance that each sub-disc has slid on the friction map at the start")
    bedding_share: float = option(0.01, "part of the distance slid that counts on the friction map", ge=0)
    stick_speed: Quantity("m/s", gt=0) = option("1 mm/s", "slip below which friction is regularised")
    damping_speed: Quantity("m/s", gt=0) = option(
        "1 m/s", "closing speed that doubles the contact pressure: damping of the normal contact")
    ramp: Quantity("s", ge=0) = option("2 ms", "time in which friction rises after the static, friction-free start")
    settling: Quantity("s", ge=0) = option("20 ms", "begin of the motion whose oscillation and friction are evaluated")
    duration: Quantity("s", gt=0) = option("0.3 s", "simulated time of each operating point")
    step: Quantity("s", gt=0) = option(
        "5 us", f"time step; the highest mode may turn by {LARGEST_ANGLE:g} rad in it")
    record_every: int = option(2, "every so many steps one sample is kept", ge=1)
    integrator: Literal["exudyn", "newmark"] = option(
        "exudyn", "exudyn's trapezoidal rule, or the same rule compiled, in a third of the time: for sweeps and draws")
    highest_frequency: Quantity("Hz", gt=0) = option(
        "12 kHz", "highest mode of the preloaded pads and caliper; above it they answer statically to contact forces")
    correction_damping: float = option(0.3, "damping ratio of these static answers", gt=0)
    lowest_frequency: Quantity("Hz", gt=0) = option(
        "200 Hz", "lowest frequency that counts as oscillation, above the passing of the sub-discs")
    caliper_factors: Quantities("1", gt=0) = option((0.25, 0.5, 1.0, 2.0, 4.0), "stability map: caliper stiffness")
    abutment_factors: Quantities("1", gt=0) = option((0.25, 0.5, 1.0, 2.0, 4.0), "stability map: abutment stiffness")
    stability_frequency: Quantity("Hz", gt=0) = option("10 kHz", "highest mode of the stability map")
    without: tuple[str, ...] = option((), "effects of the case that this stage leaves out, as it cannot have them")


@dataclass(frozen=True)
class _Run:
    """Result of one operating point: fields of the product without their first dimension."""

    time: np.ndarray
    fields: dict


@stage
def multibody(model: ReducedModel, friction_map: FrictionMap, effects: Effects | None, settings: Settings,
              context: Context) -> Multibody:
    """Simulate flexible pads on four rigid sub-discs with friction from the map.

    The coupling is one-way, as in the paper: the disc is rigid here, and the contact forces excite its
    modes in the stage 'response'.

    The trapezoidal rule lowers a frequency by the fraction phi^2 / 12, phi being its phase angle per step
    (7.2 kHz: 0.4 % at 5 us, 1.7 % at 10 us). A step with phi above 0.4 rad at 'highest_frequency' is
    refused. Opening contacts require 5 us in any case.

    Effects act on friction and contact laws of the patches, on the disc surface, and on pads, caliper and
    joints. Memory of friction, wear and hysteresis goes on once per accepted step; the stability map reads
    friction as it stands without memory, and elements as loaded for the first time. Friction over distance
    uses the distance on the friction map. Refused, unless 'without' names them: effects of the flexible
    disc, which is rigid here, and friction-induced damping, which friction in two directions already has.

    Method:
    Reduced pads and caliper were coupled to a rigid disc ({coupling} coupling) whose {sectors} sectors belong
    alternately to four jointed sub-discs. Each contact patch reads its friction from the friction map at its pressure,
    slip speed and the distance of its sub-disc (initially {bedding}, increasing by {bedding_share} of the distance
    slid). After a frictionless static start, friction was ramped up in {ramp}; the implicit trapezoidal rule
    ({integrator}) integrated over {duration} in steps of {step}, with preloaded modes up to {highest_frequency} and
    static corrections for the contact forces. The stability map holds the largest growth rate, of eigenvalues below
    {stability_frequency}, of the linearised system with scaled joint stiffnesses. The growth rate of the transient is
    the mean over thirds of its envelope; within two standard errors of zero its sign is undecided. The energy balance
    integrates the power of all forces over the recorded samples.
    """
    _check_times(settings)
    if DISC not in model.body_name:
        raise ConfigError("multibody: reduced model", f"a body called '{DISC}'", ", ".join(model.body_name))
    points = list(product(settings.pressures, settings.speeds))
    law = FrictionLaw.of(friction_map)
    terms = kept(physics_terms(effects), settings.without)
    posed = partial(_posed, model=model, law=law, run_conditions=conditions(effects), settings=settings)
    refuse_idle(terms, lambda those: posed(points[0], terms=those)(1.0, 1.0))
    runs = context.map(partial(_operate, posed=partial(posed, terms=terms), model=model, settings=settings), points,
                       "operating points")
    fields = {name: np.array([run.fields[name] for run in runs]) for name in runs[0].fields}
    pressure, speed = np.array(points).T
    return Multibody(pressure=pressure, speed=speed, time=runs[0].time, pad_name=_pads(model)[1],
                     caliper_factor=settings.caliper_factors, abutment_factor=settings.abutment_factors, **fields)


def _check_times(settings):
    shortest = settings.settling + FEWEST_PERIODS / settings.lowest_frequency
    if settings.duration < shortest:
        raise ConfigError("multibody.duration", f"at least {shortest:.3g} s: settling and {FEWEST_PERIODS} periods of"
                          " the lowest frequency", f"{settings.duration:g} s")
    longest = LARGEST_ANGLE / (2 * np.pi * settings.highest_frequency)
    if settings.step > longest:
        raise ConfigError("multibody.step", f"at most {longest:.3g} s, in which the highest frequency turns by"
                          f" {LARGEST_ANGLE:g} rad", f"{settings.step:.3g} s",
                          "shorten the step, or lower multibody.highest_frequency")


def _posed(point, model, law, run_conditions, settings, terms):
    """Function of the factors on caliper and abutment that gives the PadSystem of one operating point."""
    sliding, dress = with_terms(braked(model, law, point[1], settings), terms, run_conditions)
    normal_law = model.law_closure, model.law_pressure
    return partial(_system, sliding.held(DISC), dress, point[0] * model.input_area, normal_law, law, settings)


def _operate(point, posed, model, settings):
    """Transient, oscillation and stability map of one operating point (pressure, speed)."""
    build = posed(point)
    system = build(1.0, 1.0)
    start = static_start(system, _where(point))
    modal, modes = preloaded_modes(system, start, settings.highest_frequency, settings.correction_damping)
    every = 1 if remembers(modal) else settings.record_every      # what remembers is followed step by step
    time, displacement, velocity = INTEGRATORS[settings.integrator](
        modal, np.zeros(modes.shape[1]), settings.step, round(settings.duration / settings.step), every,
        scale=np.linalg.norm(modes.T @ system.load))
    pads, names = _pads(model)
    history = contact_history(modal.contact, np.searchsorted(pads, model.contact_body), len(names), time, displacement,
                              velocity)
    energy = energy_balance(system, modal, start, modes, history, time, displacement, velocity)
    kept = slice(None, None, settings.record_every // every)
    time, displacement = time[kept], displacement[kept]
    normal, friction = history.normal[:, kept], history.friction[:, kept]
    rows = _motion_rows(model, pads, len(start))
    motion = (rows @ modes) @ displacement.T + (rows @ start)[:, :, None]
    stability, root = stability_map(build, settings.caliper_factors, settings.abutment_factors,
                                    settings.stability_frequency, settings.correction_damping)
    return _Run(time, {
        "pad_motion": motion, "patch_force": history.patch[..., kept], "normal_force": normal.astype(np.float32),
        "friction_force": friction.astype(np.float32),
        "mean_friction": _mean_friction(normal, friction, time >= settings.settling),
        "separated_share": history.separated, "outside_map_share": history.outside, "stability": stability,
        "stability_root": root, **_oscillation(motion[:, 0], time, settings), **_energies(energy)})


def _system(sliding, dress, input_force, normal_law, friction_law, settings, caliper, abutment):
    scaled = _stiffer(_stiffer(sliding, CALIPER, caliper), ABUTMENT, abutment)
    plain = pad_system(scaled, input_force, *normal_law, friction_law, settings.bedding, settings.bedding_share,
                       settings.sectors, settings.ramp, settings.stick_speed, settings.damping_speed)
    return dress(plain, scaled)


def _stiffer(sliding, groups, factor):
    present = [group for group in groups if any(group in name for name in sliding.joints.name)]
    if not present:
        raise ConfigError("multibody: stability map", f"a joint called {' or '.join(groups)}",
                          ", ".join(sliding.joints.name))
    for group in present:
        sliding = sliding.with_joints_scaled(group, factor)
    return sliding


def _pads(model):
    """(bodies, names without 'pad_') of the pads in contact, in the order of the bodies."""
    bodies = np.unique(model.contact_body)
    return bodies, [str(model.body_name[b]).removeprefix("pad_") for b in bodies]


def _motion_rows(model, pads, size):
    """(pad, 3, ``size``) rows of the centres of gravity in the coordinates of pads and caliper, and of what effects
    add behind them."""
    kept = model.coordinate_body != list(model.body_name).index(DISC)
    rows = np.zeros((len(pads), 3, len(kept)))
    for row, pad in zip(rows, pads, strict=True):
        members = np.flatnonzero(model.coordinate_body == pad)
        recovery = model.recovery[model.visible_body == pad][:, :, members]
        axes = sliding_axes(model.contact_position[model.contact_body == pad])
        row[:, members] = gravity_rows(model.mass[np.ix_(members, members)], recovery, axes)
    added = size - np.count_nonzero(kept)
    return np.pad(rows[:, :, kept], ((0, 0), (0, 0), (0, added))) if added else rows[:, :, kept]


def _energies(energy):
    """Fields of an EnergyBalance: what has passed at the end of the motion, and its largest error."""
    end = energy._replace(**{name: value[-1] for name, value in energy._asdict().items()})
    added = end.added_loss / end.damping_loss if end.damping_loss else 0.0
    return {"stored_energy": end.stored, "input_work": end.input_work, "normal_work": end.normal_work,
            "friction_work": end.friction_work, "element_work": end.element_work, "sliding_loss": end.sliding_loss,
            "damping_loss": end.damping_loss, "added_loss": added, "imbalance": energy.imbalance}


def _mean_friction(normal, friction, settled):
    return friction[:, settled].sum() / normal[:, settled].sum()


def _oscillation(along, time, settings):
    """Frequency and growth rate, with its standard error, of the pad that moves more, once settled."""
    step, settled = time[1] - time[0], time >= settings.settling
    moved = along[np.argmax(np.std(along[:, settled], axis=1)), settled]
    frequency = dominant_frequency(moved, step, settings.lowest_frequency)
    rate, deviation = growth_rate(moved, step, frequency)
    return {"oscillation_frequency": frequency, "growth_rate": rate, "growth_rate_std": deviation,
            "growth_decided": int(sign_is_decided(rate, deviation))}


def _where(point):
    return f"multibody: static start at {point[0] / 1e6:g} MPa"
