"""What the chain does not model, for the products of the case."""

from pipeline.views.figures.number_format import number, percent, quantity


def _bulk(micro):
    compliances = [f"{number(1e12 / micro.normal_stiffness[p, 0, -1], 3)} µm/MPa at {quantity(micro.pressure[p], 'Pa')}"
                   for p in (0, -1)]
    removed = number(1e12 * micro.block_compliance, 3)
    return ("Depth of the rough pair: its moduli (micro_friction.pad.youngs_modulus) are effective values of the"
            " asperities, fitted to the real contact area, not those of the bulk. The uniform compliance of its blocks,"
            f" {removed} µm/MPa, is therefore excluded from the interface, whose compliance after wear is"
            f" {' and '.join(compliances)}; pads and disc of the brake model deform with their bulk moduli"
            " (structure.pad.lining_young_*) instead.")


def _grid(micro):
    area = micro.refinement_area
    if len(area) < 2:
        return "Grid of the rough pair: not refined in this case, so the discretisation error of friction is unknown."
    change = area[-1] / area[-2] - 1.0
    return (f"Grid of the rough pair: its last refinement {'lowers' if change < 0 else 'raises'} the real contact area"
            f" by {percent(abs(change), 2)}, and friction, which is proportional to the area, by as much; the standard"
            " error covers patch positions only and does not include it.")


#: (required products, sentence or the function of these products that writes it)
LIMITS = (
    (("micro_friction",), "Third body: a single shear limit represents the film between pad and disc. Film growth and"
     " material transfer are included only as effects (third_body_film, material_transfer) stated by the case; wear"
     " debris is not modelled."),
    (("micro_friction",), "Plastic flow of the asperities, adhesion, and hard particles in the pad: both solids are"
     " elastic and homogeneous beneath their rough surface."),
    (("micro_friction",), "Heat: the flash temperature of the contact spots may lower the shear limit, but disc and pad"
     " do not warm up beyond the temperature that the case states, on which friction and the moduli of linings alone"
     " depend; nothing depends on moisture."),
    (("micro_friction",), _bulk),
    (("micro_friction",), _grid),
    (("structure",), "The real geometry: shapes are simplified, and values are what the settings state of their origin;"
     " bolts, bushings, shims, hydraulics, suspension and test bench are springs or"
     " omitted."),
    (("complex_modes",), "Complex modes are linear: no limit cycle, no amplitude, no dependence on the angular position"
     " of the disc."),
    (("convergence",), "No motion over time: whether an unstable mode grows to an audible level, or is limited before,"
     " is not computed in this chain. Modes above complex_modes.frequency_max are not judged."),
    (("multibody",), "In the pad motion the disc is rigid and its speed constant, as in the paper: disc modes cannot"
     " draw energy from friction there."),
    (("response",), "One-way coupling: the contact forces excite the elastic brake, whose vibration does not change"
     " them. Self-excited growth therefore shows in the complex modes, not in the spectra."),
    (("rupture",), "Rupture: two dimensions, elastic plates, one law of friction along the whole interface; no"
     " plasticity, no heat, no roughness. Stress ratio, mesh and damping are inferred: the paper prints none of them."),
    (("rupture",), "Rupture with Coulomb friction between unlike solids is ill-posed: its numbers are specific to mesh"
     " and damping. The memory of the pressure that makes it well-posed is not given in the paper."),
    (("squeal",), "Sound: levels are velocity levels at sensors, not sound pressure in dB(A); radiation, room and"
     " microphone are not modelled."),
)


def limits(products):
    """Sentences for the ``products`` (name -> product or None) of a case."""
    present = ((needed, text) for needed, text in LIMITS if all(products.get(name) is not None for name in needed))
    return tuple(text if isinstance(text, str) else text(*(products[name] for name in needed))
                 for needed, text in present)
