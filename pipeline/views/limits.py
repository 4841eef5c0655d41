"""What the chain leaves out, as far as its products took part in the case."""

#: (products that must be there, sentence)
LIMITS = (
    (("micro_friction",), "Third body: one shear limit stands for the film between pad and disc. Its growth,"
     " transfer of material between the bodies and wear debris are left out."),
    (("micro_friction",), "Plastic flow of the asperities, adhesion, and stiff particles inside the pad: both solids"
     " are elastic and homogeneous beneath their rough surface."),
    (("micro_friction",), "Heat: the flash temperature of the spots may lower the shear limit, but disc and pad do not"
     " warm up, and no material constant changes with temperature or moisture."),
    (("structure",), "The real geometry: the paper prints no drawing. Shapes and stiffnesses are inferred or tuned as"
     " their origin says; bolts, bushings, shims, hydraulics, suspension and test bench are springs or left out."),
    (("complex_modes",), "Complex modes are linear: no limit cycle, no amplitude, no dependence on the angle of the"
     " disc."),
    (("multibody",), "In the pad motion the disc is rigid and its speed constant, as in the paper: disc modes cannot"
     " feed on friction there."),
    (("response",), "One-way coupling: the contact forces excite the elastic brake, whose vibration does not change"
     " them. Self-excited growth therefore shows in the complex modes, not in the spectra."),
    (("squeal",), "Sound: levels are velocity levels at sensors, not sound pressure in dB(A); radiation, room and"
     " microphone are left out."),
)


def limits(products):
    """Sentences for the products (name -> product or None) that are there."""
    return tuple(text for needed, text in LIMITS if all(products.get(name) is not None for name in needed))
