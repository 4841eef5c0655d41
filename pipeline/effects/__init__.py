"""The catalogue of physics that a model may lack: one file, one effect, one line here."""

from importlib import import_module

_FILES = (
    "joint.coulomb",
    "joint.joint_damping",
    "joint.viscous",
    "friction.falling_friction",
    "friction.velocity_strengthening",
    "friction.asymmetric_friction",
    "joint.cubic_stiffness",
    "joint.quadratic_stiffness",
    "joint.quadratic_damping",
    "joint.hysteretic_joint",
    "joint.bouc_wen",
    "joint.micro_slip",
    "contact.contact_stiffness_law",
    "joint.clearance",
    "joint.backlash",
    "joint.cogging",
    "contact.contact_damping",
    "structure.attached_mass",
    "structure.added_stiffness",
    "structure.compliant_arm",
    "excitation.moving_base",
    "excitation.base_shake",
    "excitation.runout",
    "excitation.thickness_variation",
    "contact.thermal_softening",
    "sensor.sensor_gain",
    "sensor.sensor_delay",
    "sensor.sensor_offset_drift",
    "sensor.clipping",
    "friction.pressure_dependent_friction",
    "friction.contact_memory",
    "friction.contact_ageing",
    "friction.friction_over_distance",
    "friction.thermal_fade",
    "friction.moisture",
    "friction.third_body_film",
    "friction.plateau_dynamics",
    "friction.friction_scatter",
    "friction.friction_induced_damping",
    "friction.directional_friction",
    "structure.viscoelastic_pad",
    "structure.shim_damping",
    "structure.doublet_split",
    "structure.gyroscopic",
    "excitation.pressure_ripple",
    "excitation.hydraulic_compliance",
    "contact.wear",
    "contact.taper_wear",
    "contact.hot_spots",
    "contact.thermal_coning",
    "contact.material_transfer",
    "contact.wear_law",
    "contact.shear_limit",
    "joint_friction.logarithmic_friction",
    "structure.tuned_absorber",
    "joint_friction.rate_state_ageing",
    "structure.second_mode",
    "joint_friction.rate_state_slip",
    "structure.parametric_stiffness",
    "joint_friction.dahl",
    "joint_friction.jenkins",
    "joint_friction.lugre",
    "joint_friction.series_stiffness",
    "joint_friction.stribeck_joint",
    "structure.impact",
    "joint_friction.position_friction",
    "sensor.reversed_channel",
    "sensor.swapped_channels",
    "sensor.unit_factor",
)
CATALOGUE = tuple(import_module(f"pipeline.effects.{name}").EFFECT for name in _FILES)


def family(names, places):
    """What effects of these ``names`` at these ``places`` are called together; '' of one, of several families, and of
    several places."""
    families = {e.name: e.family for e in CATALOGUE}
    shared = {families.get(name, "") for name in names}
    return shared.pop() if len(names) > 1 and len(shared) == len(set(places)) == 1 else ""


def named(name):
    """The effect of this name; KeyError where there is none."""
    return {e.name: e for e in CATALOGUE}[name]
