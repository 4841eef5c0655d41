"""The catalogue of physics that a model may lack: one file, one effect, one line here."""

from importlib import import_module

_FILES = (
    "joint.coulomb",
    "joint.joint_damping",
    "joint.viscous",
    "friction.falling_friction",
    "friction.asymmetric_friction",
    "joint.cubic_stiffness",
    "joint.quadratic_stiffness",
    "joint.quadratic_damping",
    "joint.hysteretic_joint",
    "joint.micro_slip",
    "contact.contact_stiffness_law",
    "joint.clearance",
    "joint.backlash",
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
)
CATALOGUE = tuple(import_module(f"pipeline.effects.{name}").EFFECT for name in _FILES)


def named(name):
    """The effect of this name; KeyError where there is none."""
    return {e.name: e for e in CATALOGUE}[name]
