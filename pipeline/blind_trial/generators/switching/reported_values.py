"""Values of what a switching rig hides, in the words of others: {parameter: SI value}, {} where there are none."""

import numpy as np


def of_law(form, spot, size):
    """Values of the law of this form at a Spot."""
    tell = _LAWS.get(form)
    return {} if tell is None else {name: float(value) for name, value in tell(spot, size).items()}


def of_change(form, rig, index, size):
    """Values of a change of a Rig at the spring or body of this number."""
    value = {"joint_damping": lambda: ("damping", size * rig.damping[index]),
             "compliant_arm": lambda: ("compliance", size / rig.stiffness[index]),
             "attached_mass": lambda: ("mass", size * rig.mass[index]),
             "added_stiffness": lambda: ("stiffness", size * max(rig.stiffness))}[form]()
    return dict([value])


_LAWS = {
    "coulomb": lambda s, size: {"force": size * s.force},
    "cubic_stiffness": lambda s, size: {"coefficient": size * s.force / s.length**3},
    "quadratic_stiffness": lambda s, size: {"coefficient": size * s.force / s.length**2},
    "quadratic_damping": lambda s, size: {"coefficient": size * s.force / s.speed**2},
    "backlash": lambda s, size: {"gap": size * s.length},
    "viscoelastic_pad": lambda s, size: {"share": size, "time": s.between(0, 0.5, 2.0) / s.angular},
    "moving_base": lambda s, size: {"compliance": size / s.stiffness,
                                    "frequency": s.angular * s.between(0, 1.3, 2.2) / (2 * np.pi)},
    "base_shake": lambda s, size: {"amplitude": size * s.length,
                                   "frequency": s.angular * s.between(0, 0.45, 0.8) / (2 * np.pi)},
}
