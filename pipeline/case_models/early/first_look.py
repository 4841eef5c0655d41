"""A first look at a brake: its case on coarse grids and meshes at the highest load alone, before all else is computed.

It takes a small part of the time of the case, whose results replace it.
"""

import math

from pipeline.case_models.operating_points import MODES_ALONE, middle_speed

#: stages of a brake whose friction is computed
_STAGES = "surface", "micro_friction", "friction_map", "structure", "reduced_model", "complex_modes"
#: elements of a disc below which the case itself answers as soon as a look at it would
_SMALL = 600
#: nodes per shortest wavelength of the rough surfaces, and pairs of them: two tell what friction scatters by
_NODES, _PAIRS = 4, 2
#: a disc that is not compared with its free modes: the limit of those
_RIGID = "100 Hz"
#: numbers of elements that are halved, of each body
_CELLS = {"disc": ("web_cells", "ring_cells", "angular_cells"), "pad": ("cells_per_patch", "lining_layers"),
          "caliper": ("radial_cells", "angular_cells", "housing_cells", "bridge_cells")}
#: share of the orders of load patterns that stays
_PATTERNS = 0.6


def coarse(sections):
    """{'stage.key': value} that make a first look of a case with these filled ``sections``; {} where none is made.

    None is made of systems other than brakes, of bodies from mesh files, which cannot be coarsened here, of linings
    with particles, whose contacts take long on any grid, and of cases that are coarse themselves.
    """
    if not set(_STAGES) <= set(sections):
        return {}
    brake = sections["structure"]
    bodies = (brake.disc, brake.pad, brake.caliper, brake.bracket, brake.piston)
    if any(getattr(body, "mesh_file", None) for body in bodies) or sections["micro_friction"].pad.inclusions:
        return {}
    if brake.disc.angular_cells * (brake.disc.web_cells + brake.disc.ring_cells) < _SMALL:
        return {}
    return {**_surfaces(sections), **_meshes(brake), **_bases(sections), **_point(sections), **MODES_ALONE}


def _surfaces(sections):
    surface = sections["surface"]
    nodes = math.ceil(_NODES * surface.patch_length / surface.shortest_wavelength / 2) * 2
    return {"surface.nodes": min(nodes, surface.nodes), "surface.pairs": min(_PAIRS, surface.pairs),
            "micro_friction.refinement": [1]}


def _meshes(brake):
    """Elements about twice as long."""
    changes = {f"structure.{body}.{name}": _half(getattr(getattr(brake, body), name))
               for body, names in _CELLS.items() for name in names}
    changes["structure.disc.angular_cells"] = max(8, changes["structure.disc.angular_cells"])
    changes["structure.disc.web_cells"] = max(2, changes["structure.disc.web_cells"])
    changes["structure.caliper.angular_cells"] = max(2, changes["structure.caliper.angular_cells"])
    for name in ("bracket", "piston"):
        if getattr(brake, name).kind == "body":
            changes[f"structure.{name}.element_size"] = f"{2 * getattr(brake, name).element_size!r} m"
    if brake.bracket.kind == "body":
        changes["structure.bracket.corner_cells"] = 0
    if brake.piston.kind == "body":
        changes["structure.piston.angular_cells"] = max(8, 4 * math.ceil(brake.piston.angular_cells / 8))
    return changes


def _half(count):
    return math.ceil(count / 2)


def _bases(sections):
    """Modes of the bodies up to those that are sought, and fewer patterns of load."""
    sought, reduction = sections["complex_modes"].frequency_max, sections["reduced_model"]
    changes = {"structure.frequency_max": f"{sought!r} Hz", "reduced_model.fixed_below": f"{sought!r} Hz",
               "structure.free_frequency_max": _RIGID}
    if reduction.load_patterns is not None:
        changes["reduced_model.load_patterns"] = [math.ceil(_PATTERNS * order) for order in reduction.load_patterns]
    return changes


def _point(sections):
    """The highest load, at the middle speed."""
    speed = middle_speed(sections["complex_modes"].speeds)
    return {"structure.pressures": [f"{max(sections['structure'].pressures)!r} Pa"],
            "complex_modes.speeds": [f"{speed!r} rad/s"]}
