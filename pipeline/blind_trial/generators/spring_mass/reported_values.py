"""Values of hidden physics in words that others use: what a score compares with, where one law has one meaning.

    {name of a parameter: value in SI}

Pieces that resemble a law of the catalogue without being it (branches, sliders) have none.
"""

import numpy as np


def parameters(piece, spot, size):
    """{parameter: SI value} of a Hidden at a Spot; {} where its law has no such values."""
    tell = _TOLD.get(piece.name)
    return {} if tell is None else {name: float(value) for name, value in tell(spot, size).items()}


#: forces of a shaker that are those of the wall's link of the mass it pushes
_OF_WALL = {"pressure_ripple": "base_shake", "hydraulic_compliance": "viscoelastic_pad"}


def alike(planted, rig):
    """[{name, place}] of known laws whose force at these places is that of a Planted."""
    walls = [f"link_{k}" for k, link in enumerate(rig.links) if (link.near, link.far) == (rig.pushed, -1)]
    same = [(_OF_WALL[name], wall) for name in (planted.piece.name,) if name in _OF_WALL for wall in walls]
    same += [(name, "shaker") for name, other in _OF_WALL.items() if (other, planted.place) in
             [(planted.piece.name, wall) for wall in walls]]
    return [{"name": name, "place": location} for name, location in same]


def _wave(spot, low, high):
    """Frequency and phase of what turns at an angular frequency drawn between these shares of the typical one."""
    phase = 6 * spot.shape[1]
    return {"frequency": spot.angular * spot.between(0, low, high) / (2 * np.pi),
            "phase": (phase + np.pi) % (2 * np.pi) - np.pi}


_TOLD = {
    "coulomb": lambda s, size: {"force": size * s.force},
    "asymmetric_friction": lambda s, size: {"force": size * s.force},
    "joint_damping": lambda s, size: {"damping": size * s.force / s.speed},
    "cubic_stiffness": lambda s, size: {"coefficient": size * s.force / s.length**3},
    "quadratic_stiffness": lambda s, size: {"coefficient": size * s.force / s.length**2},
    "quadratic_damping": lambda s, size: {"coefficient": size * s.force / s.speed**2},
    "backlash": lambda s, size: {"gap": 0.3 * size * s.length},
    "viscoelastic_pad": lambda s, size: {"share": size, "time": s.between(0, 0.5, 2) / s.angular},
    "thermal_softening": lambda s, size: {"drop": min(size, 0.8), "time": s.time * s.between(0, 0.2, 0.8)},
    "base_shake": lambda s, size: {"amplitude": size * s.length, **_wave(s, 0.5, 0.9)},
    "compliant_arm": lambda s, size: {"compliance": size / s.link.stiffness, "behind": 0.0},
    "moving_base": lambda s, size: {"compliance": size / s.link.stiffness,
                                    "frequency": s.angular * s.between(0, 1.2, 2.0) / (2 * np.pi)},
    "attached_mass": lambda s, size: {"mass": size * s.rig.mass[s.index]},
    "added_stiffness": lambda s, size: {"stiffness": size * s.link.stiffness},
    "pressure_ripple": lambda s, size: {"force": size * s.force, **_wave(s, 0.5, 0.9)},
    "hydraulic_compliance": lambda s, size: {"stiffness": size * s.link.stiffness,
                                             "time": s.between(0, 1, 3) / s.angular},
    "sensor_gain": lambda s, size: {"error": size},
    "sensor_delay": lambda s, size: {"delay": size / s.angular},
    "sensor_offset_drift": lambda s, size: {"offset": size * s.length,
                                            "drift": size * (s.shape[0] - 0.5) * s.length / s.time},
    "clipping": lambda s, size: {"inverse_limit": size / (2 * s.length)},
}
