"""Each effect of the catalogue that acts on small motions, at a place of the brake of a few elements."""

from pipeline.effects import CATALOGUE
from pipeline.effects.typical import ASPERITIES, Typical
from pipeline.products import Effects

#: a joint of the brake, and SI values of each effect at its place
GUIDE = "guide_2_z"
VALUES = {
    "joint_damping": (GUIDE, {"damping": 100.0}),
    "viscous": ("contact", {"slope": 0.02}),
    "falling_friction": ("contact", {"rise": 0.1, "decay_speed": 0.5}),
    "velocity_strengthening": ("contact", {"slope": 0.02, "reference_speed": 1.0, "cutoff_speed": 1e-3}),
    "cubic_stiffness": (GUIDE, {"coefficient": 1e17}),
    "quadratic_stiffness": (GUIDE, {"coefficient": 1e11}),
    "contact_stiffness_law": ("pad_inner", {"exponent": 0.3, "pressure": 1e6}),
    "clearance": ("pad_inner", {"gap": 1e-6}),
    "backlash": (GUIDE, {"gap": 1e-6}),
    "cogging": (GUIDE, {"sine": 1.0, "cosine": 2.0, "period": 1e-4}),
    "contact_damping": ("contact", {"loss": 0.5, "length": 1e-6}),
    "attached_mass": ("rim", {"mass": 0.02}),
    "added_stiffness": ("rim", {"stiffness": 1e6}),
    "compliant_arm": (GUIDE, {"compliance": 5e-8, "behind": 0.5}),
    "moving_base": (GUIDE, {"compliance": 5e-8, "frequency": 500.0}),
    "pressure_dependent_friction": ("contact", {"exponent": -0.1, "pressure": 1e6}),
    "contact_memory": ("contact", {"length": 1e-3}),
    "contact_ageing": ("contact", {"share": 0.1, "speed": 0.5, "length": 1e-4}),
    "friction_over_distance": ("contact", {"rise": 0.2, "distance": 1.0}),
    "moisture": ("contact", {"slope": 0.2}),
    "plateau_dynamics": ("contact", {"strength": 0.1, "heat": 1e6, "time": 0.01}),
    "friction_induced_damping": ("contact", {"share": 1.0}),
    "directional_friction": ("contact", {"asymmetry": 0.1}),
    "viscoelastic_pad": (GUIDE, {"share": 0.5, "time": 2e-5}),
    "shim_damping": (GUIDE, {"loss_factor": 0.1, "frequency": 1900.0}),
    "doublet_split": ("disc 1", {"along": 0.05, "across": 0.0}),
    "gyroscopic": ("disc 1", {"order": 2.0}),
    "hydraulic_compliance": ("piston_1", {"stiffness": 1e6, "time": 1e-3}),
    "tuned_absorber": ("rim", {"mass": 0.01, "frequency": 1900.0, "damping_ratio": 0.05}),
    "jenkins": (GUIDE, {"stiffness": 5e6, "limit": 50.0}),
    "series_stiffness": (GUIDE, {"compliance": 5e-8, "friction": 10.0}),
    "stribeck_joint": (GUIDE, {"force": 5.0, "rise": 0.4, "speed": 0.01, "damping": 50.0}),
    "impact": ("rim", {"inverse_gap": 100.0, "restitution": 0.6, "stiffness": 1e6}),
    "second_mode": ("rim", {"share": 0.1, "frequency": 3000.0, "damping_ratio": 0.02}),
}
SMALL = {e.name for e in CATALOGUE if e.kind == "physics" and e.small and e.location != ASPERITIES}


def acting(name, **changed):
    """The product Effects of one of them, some values ``changed``, at 0.8 of each condition."""
    effect, (place, values) = next(e for e in CATALOGUE if e.name == name), VALUES[name]
    values = {**values, **changed}
    units = {p.name: p.unit for p in effect.parameters(Typical())}
    return Effects(effect=[name], place=[place], term=[0] * len(values), parameter=list(values),
                   value=list(values.values()), unit=[units[p] for p in values], condition=list(effect.conditions),
                   condition_value=[0.8] * len(effect.conditions))
