"""The reduced model that a workshop has of the practice brake: everything as drawn, in fewer modes of a coarser disc.

Its disc is a thin plate of four cells along the radius (``annulus.thin``). It keeps one mode of every wave up to order
8 and those with a nodal circle up to order 4; a lining touches at twelve points. Values on the bench are others, and
what the model leaves out moves its poles by less than RESOLUTION once they are fitted.
"""

import numpy as np

from pipeline.blind_trial.generators.brake import brake, brake_parts
from pipeline.blind_trial.generators.brake.annulus import Disc, thin

#: names of the waves by order: those within the band, those above it that make the disc yield, and with a nodal circle
SEEN, STIFF, REST = ("zero", "one", "two", "three", "four", "five"), ("six", "seven"), ("eight",)
WORDS, CIRCLES = (*SEEN, *STIFF, *REST), (*SEEN[:5],)
#: standard deviations of the logarithm of values about the drawing: those of the truth, and of the waves that they make
SPREAD = {"young": 0.12, "density": 0.08, "contact": 0.2, "shear": 0.2, "friction": 0.15, "abutment_outer": 0.2,
          "abutment_inner": 0.2, "fingers": 0.2, "loss": 0.3}
WAVE_SPREAD = {"frequency": 0.09, "modal_mass": 0.12, "damping": SPREAD["loss"]}
#: band of the poles in Hz, and their least standard deviation as a share of their frequency
BAND, RESOLUTION = (350.0, 3600.0), 2.5e-4
JOINTS = ("abutment_outer", "abutment_inner", "fingers")
#: points that are seen, in the order of the rows of ``brake_parts``; what each channel shows
POINTS = ("disc_a", "disc_b", "disc_c", "outer", "inner")
SOURCES = (*POINTS[:4], "outer", "inner")
#: orders whose doublets may be split
SPLIT = (2, 3, 4)
#: nodes of one weight on -1 to 1, exact to degree 7 (P. Chebyshev 1874); points of a lining
_NODES = (-0.866247, -0.422519, -0.266635, 0.266635, 0.422519, 0.866247)
_TOUCHING = 2 * len(_NODES)


def drawn(shape):
    """Disc of the drawing of a shape."""
    return Disc(*shape, brake_parts.NOMINAL["young"], brake_parts.POISSON, brake_parts.NOMINAL["density"])


def nominal(shape):
    """The case of the workshop about a brake of one of ``brake_parts.SHAPES``, as ``nominal.yaml`` says it."""
    waves, value = _waves(shape), brake_parts.NOMINAL
    sources = dict(zip(brake.CHANNELS, SOURCES, strict=True))
    return {
        "chain": "lumped_bench", "title": "Disc brake",
        "description": "Modes of the disc by finite elements of its drawing; tapped lifted, pressed and sliding.",
        "lumped": {"masses": masses(waves), "springs": springs(waves, value),
                   "contacts": contacts(waves, shape, _points(shape)),
                   "inputs": {"press": {"along": {"pad_inner.z": -1, "caliper.z": -1},
                                        "force": f"{brake.REFERENCE:g} N"}},
                   "sensors": _sensors(waves, shape)},
        "recording": {"files": [{"kind": "hdf5", "file": "recordings.h5"}]},
        "bench": {"step": "20 us", "contact": "penalty", "contact_stiffness": _share_of(value["contact"]),
                  "friction": value["friction"], "description": "elastic",
                  "tangential_stiffness": _share_of(value["shear"]),
                  "poles": {"low": f"{BAND[0]:g} Hz", "high": f"{BAND[1]:g} Hz", "resolution": RESOLUTION},
                  "channels": {name: {"quantity": quantity, "source": sources[name]}
                               for name, quantity in brake.CHANNELS.items()}},
        "diagnosis": {"forward": "poles", "solver": False, "kept": 2, "parameters": _beliefs(),
                      "effects": [*brake.HIDDEN, *brake.DECOYS],
                      "places": ["contact", *JOINTS[:2], *(f"{WORDS[n]} 1" for n in SPLIT), *POINTS[:3],
                                 "laser_outer", "accelerometer"]}}


def _beliefs():
    """Section diagnosis.parameters."""
    spreads = {f"bodies.{word}.{what}": spread for what, spread in WAVE_SPREAD.items() for word in SEEN}
    spreads |= {f"bodies.{word}.frequency": WAVE_SPREAD["frequency"]
              for word in (*STIFF, *(f"{circle}_circle" for circle in CIRCLES))}
    spreads |= {f"joints.{name}.stiffness": SPREAD[name] for name in JOINTS}
    spreads |= {"contact.stiffness": SPREAD["contact"], "friction.stiffness": SPREAD["shear"],
              "friction": SPREAD["friction"]}
    return {name: {"spread": spread} for name, spread in spreads.items()}


def _waves(shape):
    """{body: (order, mass kg, stiffness N/m, at)} of the disc; ``at(r)`` -> (w, p_t) at a radius, w = 1 at the rim."""
    entries, plate = {}, drawn(shape)
    for order, word in enumerate(WORDS):
        waves = thin(plate, order)
        rim = waves.at(shape[2])[0][0]
        for k, name in enumerate((word, f"{word}_circle")[:1 + (word in CIRCLES)]):
            def at(radius, waves=waves, k=k, size=rim[k]):
                return tuple(float(part[0, k] / size) for part in waves.at(radius))

            entries[name] = order, rim[k] ** -2, waves.squared[k] * rim[k] ** -2, at
    return entries


def masses(waves):
    """Section lumped.masses."""
    pad = {"mass": f"{brake_parts.PAD:g} kg", "inertia": f"{brake_parts.PITCH:g} kg m^2", "moves": ["x", "z", "tilt_y"]}
    return {**{name: {"mass": f"{mass:.6g} kg", "moves": ["x", "y"][:1 + (order > 0)]}
               for name, (order, mass, _, _) in waves.items()},
            "pad_outer": pad, "pad_inner": dict(pad),
            "caliper": {"mass": f"{brake_parts.CALIPER:g} kg", "moves": ["z"]}}


def springs(waves, value):
    """Section lumped.springs of the waves and of the joints, with the ``value`` of each joint."""
    made = {}
    for name, (order, mass, stiffness, _) in waves.items():
        for axis in ("x", "y")[:1 + (order > 0)]:
            made[f"{name}_{axis}"] = _spring({f"{name}.{axis}": 1}, stiffness,
                                             2 * brake_parts.LOSS * np.sqrt(mass * stiffness))
    for pad in brake_parts.PADS:
        made[f"abutment_{pad}"] = _spring({f"pad_{pad}.x": 1}, value[f"abutment_{pad}"], brake_parts.ABUTMENT_LOSS)
        made[f"clip_{pad}"] = _spring({f"pad_{pad}.tilt_y": "1 m"}, *brake_parts.CLIP)
    return {**made, "fingers": _spring({"pad_outer.z": 1, "caliper.z": -1}, value["fingers"], brake_parts.FINGER_LOSS),
            "seal": _spring({"pad_inner.z": 1, "caliper.z": 1}, *brake_parts.SEAL),
            "guide": _spring({"caliper.z": 1}, *brake_parts.GUIDE)}


def _spring(along, stiffness, damping):
    return {"along": along, "stiffness": f"{stiffness:.6g} N/m", "damping": f"{damping:.6g} N s/m"}


def _share_of(stiffness):
    """What a point has of the stiffness of a lining."""
    return f"{stiffness / _TOUCHING:g} N/m"


def _points(shape):
    """[(name, angle, radius m, stiffness)] of twelve points of a lining, each for a twelfth of its face: six along
    sliding, two across."""
    outer = shape[2] - brake_parts.INSET
    inner = outer - brake_parts.WIDTH
    middle, reach = (outer**2 + inner**2) / 2, (outer**2 - inner**2) / (2 * 3**0.5)
    share = _share_of(brake_parts.NOMINAL["contact"])
    return [(f"{k}{m}", angle, radius, share) for k, angle in enumerate(brake_parts.HALF_ANGLE * np.array(_NODES))
            for m, radius in enumerate(np.sqrt((middle - reach, middle + reach)))]


def contacts(waves, shape, points):
    """Section lumped.contacts of both linings at ``points`` [(name, angle, radius m, stiffness)] of either."""
    made = {}
    for pad, side in zip(brake_parts.PADS, (1, -1), strict=True):
        for number, angle, radius, stiffness in points:
            normal = {f"pad_{pad}.z": 1, f"pad_{pad}.tilt_y": f"{radius * np.sin(angle):.6g} m"}
            tangent = {f"pad_{pad}.x": 1, f"pad_{pad}.tilt_y": f"{brake_parts.HEIGHT:g} m"}
            for name, (order, _, _, at) in waves.items():
                deflection, turn = at(radius)
                for axis, wave, turned in _around(order, angle):
                    normal[f"{name}.{axis}"] = -side * deflection * wave
                    tangent[f"{name}.{axis}"] = -side * shape[4] / 2 * turn * turned
            made[f"{pad}_{number}"] = {"normal": normal, "tangent": tangent, "lever": f"{radius:.6g} m",
                                       "angle": f"{angle:.6g} rad", "stiffness": stiffness}
    return made


def _around(order, angle):
    """(axis, wave, turned) of the waves of an order at an angle."""
    cosine, sine = float(np.cos(order * angle)), float(np.sin(order * angle))
    return (("x", cosine, sine), ("y", sine, -cosine))[:1 + (order > 0)]


def _sensors(waves, shape):
    radius = shape[2] - brake_parts.LASER_INSET
    sensors = {name: {"along": {f"{word}.{axis}": at(radius)[0] * wave for word, (order, _, _, at) in waves.items()
                              for axis, wave, _ in _around(order, angle)}}
             for name, angle in zip(POINTS, brake_parts.LASERS, strict=False)}
    along, opening, pitch = brake_parts.ON_PAD
    return {**sensors, **{name: {"along": {f"pad_{name}.x": along, f"pad_{name}.z": opening,
                                         f"pad_{name}.tilt_y": f"{pitch:g} m"}} for name in POINTS[3:]}}
