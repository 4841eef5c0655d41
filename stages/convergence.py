"""Stage convergence: the same brake with finer meshes and contact, all at once, and what becomes of its unstable modes.

The finer model is one of finite elements alone: it slides steadily as it does by itself, and each mode that grows, or
nearly does, is followed into it from its shape.
"""

from typing import Literal

import numpy as np

from pipeline.case_models.effect_block import physics_terms
from pipeline.case_models.operating_points import StabilitySettings, middle_speed
from pipeline.case_models.refinement.comparison import Comparison, Stated, Tolerances, causes, error_factor
from pipeline.case_models.refinement.element_modes import OperatingPoint, brake_of, element_modes
from pipeline.case_models.refinement.finer_settings import BASES, REFINEMENTS, finer, left_out, refined
from pipeline.case_models.refinement.reduced_starts import Starts, reduced_starts
from pipeline.case_models.refinement.unreduced_brake import BodyMatrices, freedoms
from pipeline.contract import ConfigError, Context, Quantity, Section, Sections, option, stage
from pipeline.products import ComplexModes, Convergence, Effects, FrictionMap, ReducedModel

#: residual of a mode on finite elements where complex modes state none
_RESIDUAL = 1e-6


class Settings(Section):
    """What is refined, where, and how far an unstable mode may move by it."""

    refinements: tuple[Literal[REFINEMENTS], ...] = option(
        REFINEMENTS, "what is refined, all at once: contact points, meshes of the bodies; bases: the modes without any"
        " reduction", min_length=1)
    pressure: Quantity("Pa", gt=0) | None = option(None, "pressure of the comparison; none = the highest")
    speed: Quantity("rad/s", gt=0) | None = option(None, "speed of the drive; none = the middle one")
    contact_points: int | None = option(
        None, "refined contact points per direction on an element face, where the mesh of the pads stays; none = one"
        " more", ge=1)
    meshes: float = option(1.3, "factor on the number of elements in each direction; ASME V&V 20 asks for 1.3 at least",
                           ge=1.1)
    bases: float = option(1.35, "without effect: the finer model has no bases", gt=1)
    frequency_tolerance: float = option(0.005, "largest estimated error of a frequency, as a share of it", gt=0)
    growth_tolerance: float = option(0.1, "largest estimated error of a growth rate, as a share of it", gt=0)
    neutral: Quantity("1/s", gt=0) = option("10 1/s", "an error of a growth rate that always counts as converged, and a"
                                            " growth rate that does")


def _check(sections):
    """Refuse refinements of nothing but meshes from files before anything is computed."""
    settings = sections["convergence"]
    if "structure" in sections and not refined(sections["structure"], settings.refinements):
        raise ConfigError("convergence.refinements", "more than meshes that come from files, or bodies that are none",
                          ", ".join(settings.refinements))


@stage(check=_check, built_from=("structure",), alone=True)
def convergence(modes: ComplexModes, model: ReducedModel, friction_map: FrictionMap, effects: Effects | None,
                sections: Sections, settings: Settings, context: Context) -> Convergence:
    """Compare unstable modes with those of a finer model of finite elements.

    All meshes and the contact are refined at once; what moves a mode beyond the tolerances is then sought by refining
    one part at a time. The modes are those of steady sliding at one operating point. Meshes from files, elements
    through the thickness of disc and backplates, the friction map and the law of the interface stay as they are.

    Method:
    Contact and meshes ({refinements}) were refined at once, with {meshes} times the elements in every direction. On
    these finite elements, without modes or reduction, steady sliding was solved for by Newton's method, and each mode
    that grows or nearly does in the reduced model was followed by nonlinear Arnoldi iteration from the motion of its
    contacts. The error of the case is estimated from each change by Richardson's extrapolation at second order. The
    result counts as converged if every unstable mode is unstable in both models, the error of its frequency within
    {frequency_tolerance}, that of its growth rate within {growth_tolerance} of it or within {neutral}, and no other
    mode is unstable.
    """
    pressure, speed = operating_point(settings, modes.operating_pressure, modes.operating_speed)
    here = _nearest(modes, pressure, speed)
    linear, point = StabilitySettings.of(modes), (float(modes.operating_pressure[here]),
                                                float(modes.operating_speed[here]))
    state = int(np.argmin(abs(model.pressure - point[0])))
    starts = reduced_starts(model, friction_map, modes.operating_root[here], state, point[1], linear)
    root, reduced, exact = _unstable(modes, here)
    stated = Stated.of(root, reduced, starts.root, exact and not physics_terms(effects))
    case = OperatingPoint(*point, float(friction_map.bulk_temperature), linear)
    models = _Models(sections["structure"], case, starts, settings, context)
    return Convergence(
        pressure=point[0], speed=point[1], **_compared(models, stated, settings),
        contacts=np.count_nonzero(modes.operating_force[here] >= 0), frequency_tolerance=settings.frequency_tolerance,
        growth_tolerance=settings.growth_tolerance, neutral=settings.neutral)


def operating_point(settings, pressures, speeds):
    """(pressure Pa, speed rad/s) that is refined, of those of the case."""
    pressure = max(pressures) if settings.pressure is None else settings.pressure
    return pressure, middle_speed(speeds) if settings.speed is None else settings.speed


def _nearest(modes, pressure, speed):
    """Index of the operating point."""
    far = abs(modes.operating_pressure / pressure - 1) + abs(modes.operating_speed / speed - 1)
    return int(np.argmin(far))


def _unstable(modes, operating):
    """Unstable roots (u,) at one operating point, strongest first, the same in the reduced model, and whether the
    former are those of finite elements."""
    here = np.flatnonzero(modes.unstable_operating == operating)
    here = here[np.argsort(-modes.unstable_root[here].real, kind="stable")]
    return modes.unstable_root[here], modes.unstable_reduced[here], bool((modes.unstable_residual[here] >= 0).all())


class _Models:
    """Finite-element models of a brake, some of its parts refined; bodies that two of them share are assembled once."""

    def __init__(self, section, point, starts, settings, context):
        self.section, self.starts, self._point, self._settings = section, starts, point, settings
        self.refined = refined(section, settings.refinements)
        self.meshes = tuple(name for name in self.refined if name != BASES)
        self._matrices, self._log = BodyMatrices(context.solver), context.log

    @property
    def freedoms(self):
        """Degrees of freedom of the case itself."""
        return freedoms(brake_of(self.section, self._point))

    def modes(self, names, chosen=None):
        """ElementModes of the starts (g,), or those ``chosen`` alone, with parts ``names`` refined."""
        starts = self.starts if chosen is None else _of(self.starts, chosen)
        section = finer(self.section, names, self._settings.meshes, self._settings.contact_points)
        tolerance = self._point.settings.residual_tolerance or _RESIDUAL
        made = element_modes(section, self._point, starts, self._matrices, tolerance)
        self._log(f"{', '.join(names) or 'no mesh'} refined: {made.freedoms} degrees of freedom, {made.contacts}"
                  f" contacts, {len(made.root)} modes followed")
        return made

    def roots(self, names, chosen):
        return self.modes(names, chosen).root


def _of(starts, chosen):
    """Starts of the modes ``chosen`` (m,), by rising frequency."""
    return Starts(starts.root[chosen], starts.motion[..., chosen], starts.position, starts.body, starts.closure,
                  starts.law, starts.friction)


def _compared(models, stated, settings):
    """Fields of Convergence on the finer model, and on what moved its modes."""
    names, starts, none = models.refined, models.starts.root, np.zeros(len(stated.root), complex)
    judged, times = stated.exact or not len(stated.root), error_factor(settings.meshes)
    base = None if judged else models.modes(()).root
    fine = models.modes(models.meshes) if models.meshes else None
    of_bases = (stated.root - stated.reduced if base is None else stated.moved(base, None)) if BASES in names else none
    compared = Comparison(stated, none if fine is None else stated.moved(fine.root, base), of_bases,
                          starts if fine is None else fine.root, Tolerances.of(settings), times)
    left = left_out(models.section, settings.refinements)
    alone = stated.alone(len(starts))
    fields = compared.fields() | {
        "refinement": list(names), "left_out": list(left), "left_out_reason": list(left.values()),
        "near_root": starts[alone],
        "near_refined": np.where(np.isfinite(compared.finer), compared.finer, starts)[alone],
        **_caused(models, compared), "error_factor": times, "freedoms": models.freedoms,
        "refined_freedoms": models.freedoms if fine is None else fine.freedoms,
        "refined_contacts": len(models.starts.body) if fine is None else fine.contacts}
    return fields | {"converged": int(compared.held.all() and not fields["added"] and not left)}


def _caused(models, compared):
    """Fields of Convergence on what moved modes beyond the tolerances, where several parts were refined."""
    moved = compared.moved
    root, names, change = compared.stated.of_starts(models.starts.root)[moved], (), np.empty((0, len(moved)), complex)
    if len(moved) and len(models.meshes) > 1:
        names, change = causes(models.meshes, models.roots, root, moved)
    return {"moved_root": root, "cause": list(names), "cause_change": change}
