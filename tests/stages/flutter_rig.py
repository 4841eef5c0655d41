"""A lumped brake whose squeal is known in closed form: two modes at 5 kHz that couple by friction, in one direction."""

from pipeline.contract.settings import fill
from pipeline.physics.closed_form.two_mode_flutter import onset_friction
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.lumped import Settings, lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model

HALF = 0.7071067811865476
#: stiffnesses in N/m of 1 g: along the belt, onto it with the contact, between the two, of the contact
ONSET = onset_friction(1.1e9, 1.2e9, 1e8, 4e8)
#: a direction in which friction couples them
FORWARD = "forward"


def flutter_rig(friction=0.4):
    """(ReducedModel, ComplexModes) at the coefficient of friction."""
    block = {
        "masses": {"block": {"mass": "1 g", "moves": ["x", "y"]}},
        "springs": {"along_belt": {"between": ["block.x", "ground"], "stiffness": "1 N/um"},
                    "onto_belt": {"between": ["block.y", "ground"], "stiffness": "0.7 N/um"},
                    "inclined": {"along": {"block.x": HALF, "block.y": -HALF}, "stiffness": "0.2 N/um"}},
        "contacts": {"belt": {"tangent": {"block.x": 1}, "normal": {"block.y": 1}, "stiffness": "0.4 N/um"}},
        "inputs": {"press": {"along": {"block.y": -1}, "force": "100 N"}},
        "sensors": {"along": {"along": {"block.x": 1}}}, "load_factors": ["1 Pa", "2 Pa"]}
    model = reduced_model(lumped(settings=fill(Settings, block, "rig")), settings=Reduction())
    modes = complex_modes(model, settings=Modes(
        speeds=("3 rad/s",), friction=friction, friction_steps=2, friction_max=0.5, damping_speed="1e9 m/s",
        friction_damping=False, frequency_max="20 kHz"))
    return model, modes
