"""What the chain leaves out, as far as its products took part in the case."""

from pipeline.views.figures.number_format import number, percent, quantity


def _bulk(micro):
    kept = [f"{number(1e12 / micro.normal_stiffness[p, 0, -1], 3)} µm/MPa at {quantity(micro.pressure[p], 'Pa')}"
            for p in (0, -1)]
    removed = number(1e12 * micro.block_compliance, 3)
    return ("Depth of the rough pair: its moduli are effective values of the asperities, which the real contact area"
            f" asks for, not those of the bulk. The uniform compliance of its blocks, {removed} µm/MPa, is"
            f" therefore left out of the interface, which keeps {' and '.join(kept)} after wear; pads and disc of the"
            " brake model deform with their own moduli instead.")


def _grid(micro):
    area = micro.refinement_area
    if len(area) < 2:
        return "Grid of the rough pair: this case did not refine it, so the error of friction by the grid is unknown."
    change = area[-1] / area[-2] - 1.0
    return (f"Grid of the rough pair: its last refinement {'lowers' if change < 0 else 'raises'} the real contact area"
            f" by {percent(abs(change), 2)}, and friction, which is proportional to the area, by as much; the standard"
            " error, from positions of the patches alone, does not hold it.")


#: (products that must be there, sentence or the function of these products that writes it)
LIMITS = (
    (("micro_friction",), "Third body: one shear limit stands for the film between pad and disc. Its growth and"
     " transfer of material between the bodies are there only as effects (third_body_film, material_transfer) that the"
     " case states; wear debris is left out."),
    (("micro_friction",), "Plastic flow of the asperities, adhesion, and stiff particles inside the pad: both solids"
     " are elastic and homogeneous beneath their rough surface."),
    (("micro_friction",), "Heat: the flash temperature of the spots may lower the shear limit, but disc and pad do not"
     " warm up, and no material constant changes with temperature or moisture."),
    (("micro_friction",), _bulk),
    (("micro_friction",), _grid),
    (("structure",), "The real geometry: the paper prints no drawing. Shapes and stiffnesses are inferred or tuned as"
     " their origin says; bolts, bushings, shims, hydraulics, suspension and test bench are springs or left out."),
    (("complex_modes",), "Complex modes are linear: no limit cycle, no amplitude, no dependence on the angle of the"
     " drive."),
    (("multibody",), "In the pad motion the disc is rigid and its speed constant, as in the paper: disc modes cannot"
     " feed on friction there."),
    (("response",), "One-way coupling: the contact forces excite the elastic brake, whose vibration does not change"
     " them. Self-excited growth therefore shows in the complex modes, not in the spectra."),
    (("rupture",), "Rupture: two dimensions, elastic plates, one law of friction along the whole interface; no"
     " plasticity, no heat, no roughness. Stress ratio, mesh and damping are inferred: the paper prints none of them."),
    (("rupture",), "Rupture with Coulomb friction between unlike solids is ill-posed: its numbers belong to their mesh"
     " and damping. The memory of the pressure that makes it well-posed is not identified by the paper."),
    (("squeal",), "Sound: levels are velocity levels at sensors, not sound pressure in dB(A); radiation, room and"
     " microphone are left out."),
)


def limits(products):
    """Sentences for the products (name -> product or None) that are there."""
    present = ((needed, text) for needed, text in LIMITS if all(products.get(name) is not None for name in needed))
    return tuple(text if isinstance(text, str) else text(*(products[name] for name in needed))
                 for needed, text in present)
