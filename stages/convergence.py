"""Stage convergence: the same brake with finer contact, meshes and bases, and what becomes of its unstable modes.

Each refinement is a variant of the case, computed to its complex modes at one operating point.
"""

import math
from typing import Literal

import numpy as np

from pipeline.case_models.operating_points import MODES_ALONE, middle_speed
from pipeline.contract import ConfigError, Context, Quantity, Section, Variants, option, stage
from pipeline.physics.stability.refinement import moved_roots
from pipeline.products import ComplexModes, Convergence

CONTACT, PAD_MESH, DISC_MESH, BASES = REFINEMENTS = "contact", "pad_mesh", "disc_mesh", "bases"

#: the free disc is not compared: its rigid motions alone
_RIGID = "100 Hz"


class Settings(Section):
    """What is refined, where, and how far an unstable mode may move by it."""

    refinements: tuple[Literal[REFINEMENTS], ...] = option(
        REFINEMENTS, "what is refined in turn: contact points, meshes of pads and disc, bases of the reduced model",
        min_length=1)
    pressure: Quantity("Pa", gt=0) | None = option(None, "pressure of the comparison; none = the highest")
    speed: Quantity("rad/s", gt=0) | None = option(None, "speed of the drive; none = the middle one")
    contact_points: int | None = option(
        None, "refined contact points per direction on an element face; none = one more", ge=1)
    bases: float = option(
        1.35, "factor on the frequency limit of the bases, and on the orders of the load patterns", gt=1)
    frequency_tolerance: float = option(0.005, "largest change of a frequency, as a share of it", gt=0)
    growth_tolerance: float = option(0.1, "largest change of a growth rate, as a share of it", gt=0)
    neutral: Quantity("1/s", gt=0) = option("10 1/s", "a growth rate that changes by less, or is less, may")


def _variants(sections):
    """The refined cases, each at one operating point, without a friction sweep, in the reduced model alone.

    Meshes of disc and pads from files cannot be refined here.
    """
    settings, brake, modes = sections["convergence"], sections["structure"], sections["complex_modes"]
    pressure, speed = operating_point(settings, brake.pressures, modes.speeds)
    once = {"structure.pressures": [f"{pressure!r} Pa"], "complex_modes.speeds": [f"{speed!r} rad/s"],
            "structure.free_frequency_max": _RIGID, **MODES_ALONE}
    changes = {CONTACT: _finer_contact(brake.pad, settings), PAD_MESH: _finer_pads(brake.pad),
               DISC_MESH: _finer_disc(brake.disc), BASES: _larger_bases(brake, sections["reduced_model"], settings)}
    of_files = {name for name, part in ((DISC_MESH, brake.disc), (PAD_MESH, brake.pad)) if part.mesh_file}
    names = [name for name in settings.refinements if name not in of_files]
    if not names:
        raise ConfigError("convergence.refinements", "more than meshes that come from files",
                          ", ".join(settings.refinements))
    return {name: {**once, **changes[name]} for name in names}


def operating_point(settings, pressures, speeds):
    """(pressure Pa, speed rad/s) that is refined, of those of the case."""
    pressure = max(pressures) if settings.pressure is None else settings.pressure
    return pressure, middle_speed(speeds) if settings.speed is None else settings.speed


def _finer_contact(pad, settings):
    if pad.contact_points is not None:
        return {"structure.pad.contact_points": settings.contact_points or pad.contact_points + 1}
    return {"structure.pad.patches_angular": 2 * pad.patches_angular,
            "structure.pad.patches_radial": 2 * pad.patches_radial,
            "structure.pad.cells_per_patch": math.ceil(pad.cells_per_patch / 2)}


def _finer_pads(pad):
    """Twice the elements or more, by the root of two in every direction; contact points per face as they are."""
    return {"structure.pad.cells_per_patch": _root_two(pad.cells_per_patch),
            "structure.pad.lining_layers": _root_two(pad.lining_layers)}


def _finer_disc(disc):
    """Twice the elements: by the root of two around and across."""
    return {f"structure.disc.{name}": _root_two(getattr(disc, name))
            for name in ("web_cells", "ring_cells", "angular_cells")}


def _root_two(count):
    return math.ceil(math.sqrt(2) * count)


def _larger_bases(brake, reduction, settings):
    changes = {"structure.frequency_max": f"{settings.bases * brake.frequency_max!r} Hz",
               "reduced_model.fixed_below": f"{settings.bases * reduction.fixed_below!r} Hz"}
    if reduction.load_patterns is not None:
        orders = [math.ceil(settings.bases * order) for order in reduction.load_patterns]
        changes["reduced_model.load_patterns"] = orders
    return changes


@stage(variants=_variants)
def convergence(modes: ComplexModes, refined: Variants[ComplexModes], settings: Settings,
                context: Context) -> Convergence:
    """Compare unstable modes with those of finer contact, meshes and bases.

    A mode that is unstable in one model only counts as a difference unless it grows by no more than 'neutral'. The
    modes are those of steady sliding at one operating point, their changes those of the reduced model; what is not
    refined here, such as the friction map or the law of the interface, is not judged.

    Method:
    Contact points, meshes of pads and disc, and bases of the reduced model ({refinements}) were refined in turn, and
    the complex modes at one operating point computed anew. The result counts as converged if every unstable mode is
    unstable in all models, its frequency within {frequency_tolerance} and its growth rate within {growth_tolerance} of
    it or within {neutral}.
    """
    pressure, speed = operating_point(settings, modes.operating_pressure, modes.operating_speed)
    here = _nearest(modes, pressure, speed)
    unstable, reduced = _unstable(modes, here)
    found = [moved_roots(reduced, each.operating_root[0], settings.neutral) for each in refined.values()]
    root = np.array([each.root for each in found]).reshape(len(found), len(unstable))
    there = np.isfinite(root)
    root = np.where(there, root + (unstable - reduced), unstable)
    frequency = np.where(there, root.imag / unstable.imag - 1, 0.0)
    growth = root.real - unstable.real
    allowed = np.maximum(settings.growth_tolerance * unstable.real, settings.neutral)
    held = there & (abs(frequency) <= settings.frequency_tolerance) & (abs(growth) <= allowed)
    added = np.array([len(each.added) for each in found])
    return Convergence(
        pressure=modes.operating_pressure[here], speed=modes.operating_speed[here], refinement=list(refined),
        root=unstable, refined_root=root, found=there.astype(int), held=held.astype(int), added=added,
        contacts=np.count_nonzero(modes.operating_force[here] >= 0),
        refined_contacts=[each.operating_force.shape[1] for each in refined.values()],
        frequency_change=abs(frequency).max(initial=0.0), growth_change=abs(growth).max(initial=0.0),
        growth_share=(abs(growth) / unstable.real).max(initial=0.0),
        frequency_tolerance=settings.frequency_tolerance, growth_tolerance=settings.growth_tolerance,
        neutral=settings.neutral, converged=int(held.all() and not added.any()))


def _nearest(modes, pressure, speed):
    """Index of the operating point."""
    far = abs(modes.operating_pressure / pressure - 1) + abs(modes.operating_speed / speed - 1)
    return int(np.argmin(far))


def _unstable(modes, operating):
    """Unstable roots (g,) at one operating point, strongest first, and the same in the reduced model."""
    here = np.flatnonzero(modes.unstable_operating == operating)
    here = here[np.argsort(-modes.unstable_root[here].real, kind="stable")]
    return modes.unstable_root[here], modes.unstable_reduced[here]
