"""The catalogue of physics that a model may lack: one file, one effect, one line here."""

from importlib import import_module

_FILES = (
    "coulomb",
    "joint_damping",
    "viscous",
    "falling_friction",
    "asymmetric_friction",
    "cubic_stiffness",
    "quadratic_stiffness",
    "quadratic_damping",
    "hysteretic_joint",
    "micro_slip",
    "contact_stiffness_law",
    "clearance",
    "backlash",
    "contact_damping",
    "attached_mass",
    "added_stiffness",
    "compliant_arm",
    "moving_base",
    "base_shake",
    "runout",
    "thickness_variation",
    "thermal_softening",
    "sensor_gain",
    "sensor_delay",
    "sensor_offset_drift",
    "clipping",
    "pressure_dependent_friction",
    "contact_memory",
    "contact_ageing",
    "friction_over_distance",
    "thermal_fade",
    "moisture",
    "third_body_film",
    "plateau_dynamics",
    "friction_scatter",
    "friction_induced_damping",
    "directional_friction",
    "viscoelastic_pad",
    "shim_damping",
    "doublet_split",
    "gyroscopic",
    "pressure_ripple",
    "hydraulic_compliance",
    "wear",
    "taper_wear",
    "hot_spots",
    "thermal_coning",
    "material_transfer",
    "wear_law",
    "shear_limit",
)
CATALOGUE = tuple(import_module(f"pipeline.effects.{name}").EFFECT for name in _FILES)


def named(name):
    """The effect of this name; KeyError where there is none."""
    return {e.name: e for e in CATALOGUE}[name]
