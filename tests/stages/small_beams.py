"""The beam on beam with rigid supports, in Timoshenko beams: quick."""

from functools import cache

from stages.beam_on_beam import Contact, Material, ReadingPoint, Settings, Slider, Track, beam_on_beam
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model

SETTINGS = Settings(
    element="timoshenko", slider=Slider(length="100.5 mm", thickness="5.69 mm", width="19.1 mm"),
    track=Track(length="377.4 mm", thickness="19.28 mm", width="10 mm"), contact=Contact(offset=0.34),
    sensor=ReadingPoint(height="50 mm"), material=Material(mass_damping="100 1/s", stiffness_damping="50 ns"))


@cache
def beams():
    """Product BeamOnBeam."""
    return beam_on_beam(settings=SETTINGS)


@cache
def model():
    """Its ReducedModel."""
    return reduced_model(beams(), settings=Reduction())
