"""How much work the stages of a case are, beside each other case: measures that their time is proportional to.

They follow from the settings alone: sizes of grids, numbers of elements, modes, points, steps and draws.
"""

from pipeline.case_models.bodies.mesh_files import freedoms_of_files
from pipeline.case_models.operating_points import selected_speeds

#: degrees of freedom of an element of the program, about; time of modes over their number
FREEDOMS, _POWER = 21.3, 1.2
#: edge of an element to which sizes are related (m), and elements of a bracket or piston of this edge
_EDGE, _BLOCKS = 0.01, {"bracket": 800.0, "piston": 250.0}
#: elements of a brake whose full matrices take as long at an operating point as its reduced model, and the power of the
#: latter
_WHOLE, _REDUCED = 3000.0, 0.8
#: cycles of wear that take as long as the first contact, and points of the friction sweep as one operating point
_BEGIN, _SWEPT = 100, 5


def work(sections):
    """{stage: measure} of the filled ``sections`` of a case; 1 where nothing in them tells more."""
    measures = dict.fromkeys(sections, 1.0)
    for stage, measure in _MEASURES.items():
        if stage in sections and (stage not in _OF_BRAKES or "structure" in sections):
            measures[stage] = float(measure(sections))
    return measures


def elements(brake):
    """Number of finite elements of a brake, about: of bodies from files by their degrees of freedom."""
    disc, pad, caliper = brake.disc, brake.pad, brake.caliper
    counts = [(disc, disc.angular_cells * (disc.web_cells + disc.ring_cells)),
              (pad, 2 * pad.patches_angular * pad.patches_radial * pad.cells_per_patch ** 2 * (pad.lining_layers + 1)),
              (caliper, caliper.angular_cells * caliper.radial_cells * (caliper.housing_cells + caliper.bridge_cells)),
              *((body, _BLOCKS[name] * (_EDGE / body.element_size) ** 3) for name in _BLOCKS
                if (body := getattr(brake, name)).kind == "body")]
    return sum(count for body, count in counts if not body.mesh_file) + freedoms_of_files(brake) / FREEDOMS


def _bodies(sections):
    brake = sections["structure"]
    return elements(brake) ** _POWER * brake.frequency_max


def _surface(sections):
    return sections["surface"].nodes ** 2 * sections["surface"].pairs


def _micro(sections):
    micro = sections["micro_friction"]
    return _surface(sections) * micro.realisations * len(micro.pressures) * (micro.cycles + _BEGIN)


def _modes(sections):
    modes, brake = sections["complex_modes"], sections["structure"]
    points = len(brake.pressures) * (len(modes.speeds) + modes.friction_steps / _SWEPT)
    size = elements(brake) / _WHOLE
    return points * modes.frequency_max * (size ** _REDUCED + size * (modes.residual_tolerance is not None))


def _points(sections, stage):
    speeds = selected_speeds(sections[stage].speeds, sections["complex_modes"].speeds)
    return len(sections["structure"].pressures) * len(speeds)


def _cycles(sections):
    cycle = sections["limit_cycle"]
    return (_points(sections, "limit_cycle") + len(cycle.checks)) * cycle.duration / cycle.step


def _draws(sections):
    return _points(sections, "probability") * sections["probability"].draws


_OF_BRAKES = {"structure", "reduced_model", "complex_modes", "convergence", "limit_cycle", "probability"}
#: stage -> its measure, from the sections; those of brakes need a structure
_MEASURES = {"surface": _surface, "micro_friction": _micro, "structure": _bodies, "reduced_model": _bodies,
             "complex_modes": _modes, "convergence": _bodies, "limit_cycle": _cycles, "probability": _draws,
             "sensitivities": lambda sections: 1 + len(sections["sensitivities"].differences),
             "countermeasures": lambda sections: 1 + len(sections["countermeasures"].variants)}
