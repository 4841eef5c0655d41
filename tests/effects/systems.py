"""The smallest case of every system that effects can be added to, each as a YAML case would run it."""

from dataclasses import dataclass
from functools import cache

import yaml

from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, with_effects
from pipeline.case_models.virtual_rig import about, groups
from pipeline.contract import Context
from pipeline.contract.settings import fill
from pipeline.effects.typical import Typical
from pipeline.physics.sliding.doublets import doublets
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.virtual_rig.response import Bench
from stages.complex_modes import Settings as ModeSettings
from stages.complex_modes import complex_modes
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.multibody import Settings as MultibodySettings
from stages.multibody import multibody
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from stages.transient import Settings as TransientSettings
from stages.transient import transient
from tests.stages.small_beams import model as beams
from tests.stages.small_brake import small_brake, small_map
from tests.stages.small_pin import small_system

RIG = yaml.safe_load("""
masses:
  block: {mass: 1 kg, inertia: 10 g m^2, moves: [x, y, z, rotation]}
  ring: {mass: 2 kg, moves: [x, y]}
springs:
  tie: {between: [block.x, ground], stiffness: 4 kN/m, damping: 6 N s/m}
  onto: {between: [block.y, ground], stiffness: 2 kN/m, damping: 5 N s/m}
  aside: {between: [block.z, block.x], stiffness: 3 kN/m, damping: 4 N s/m}
  turn: {along: {block.rotation: 100 mm, block.y: 0.3}, stiffness: 30 kN/m, damping: 9 N s/m}
  link_x: {between: [ring.x, block.x], stiffness: 1 kN/m, damping: 2 N s/m}
  link_y: {between: [ring.y, block.y], stiffness: 1 kN/m, damping: 2 N s/m}
contacts:
  front: {tangent: {block.x: 1, block.rotation: 10 mm}, normal: {block.x: 0.1, block.y: 1, block.rotation: 30 mm},
          lateral: {block.z: 1}, stiffness: 20 kN/m, area: 10 cm^2, lever: 0.1 m, angle: 20 deg}
  rear: {tangent: {block.x: 1, block.rotation: 10 mm}, normal: {block.x: 0.1, block.y: 1, block.rotation: -30 mm},
         lateral: {block.z: 1}, stiffness: 20 kN/m, area: 10 cm^2, lever: 0.1 m, angle: -20 deg}
inputs:
  press: {along: {block.y: -1}, force: 40 N}
sensors:
  along: {along: {block.x: 1}}
  away: {along: {block.y: 1}}
  ring: {along: {ring.x: 1}}
""")


class Telling(Context):
    """A Context that keeps what is told."""

    lines = ()

    def log(self, message):
        object.__setattr__(self, "lines", (*self.lines, message))


@dataclass(frozen=True)
class System:
    """A ReducedModel, the stage that moves it with its section, typical sizes, and what else the stage takes."""

    model: object
    stage: object
    settings: object
    typical: Typical
    before: tuple = ()

    def run(self, block, context=None, **changed):
        """Product of the stage with the YAML ``block`` of effects, its section ``changed``."""
        effects = product(fill(EffectSettings, block, "effects"))
        settings = self.settings.model_copy(update=changed)
        return self.stage(self.model, *self.before, effects, settings=settings, context=context or Context())

    def location(self, effect):
        """First location of an effect, None where it has none."""
        sliding = sliding_model(self.model, 0, 1.0)
        bench = Bench(sliding, None, None, 1.0, (), groups(self.model), doublets=doublets(sliding))
        return next(iter(effect.locations(bench)), None)

    def block(self, effect, values, location=None):
        """YAML block of an effect at its location; ``values(parameters)`` as numbers in SI units."""
        parameters = effect.parameters(self.typical)
        units = {p.name: p.unit for p in parameters}
        told = {name: value if units[name] == "1" else f"{float(value)!r} {units[name]}"
                for name, value in values(parameters).items()}
        return {effect.name: {location or self.location(effect): told}, "conditions": {"humidity": 0.8}}


@cache
def rig():
    """ReducedModel of the lumped RIG."""
    return reduced_model(lumped(settings=fill(LumpedSettings, RIG, "lumped")), settings=ReductionSettings())


def _moving(model, typical, **settings):
    window = {"window": settings["duration"], "record_every": 1}
    return System(model, transient, TransientSettings(**window, **settings), typical)


def _linearised(model, typical, speed, before=None, **settings):
    chosen = ModeSettings(friction_steps=2, friction_max=0.5, speeds=[speed], friction_damping=False, **settings)
    return System(model, complex_modes, chosen, typical, (before,))


SIZES = {"rig": Typical(4e3, 6.0, 1.0, 5e-3, 2.0, 20.0, 2e4, 0.04, 2e-4, 20.0),
         "stiff": Typical(1e7, 100.0, 0.1, 1e-6, 0.1, 15.0, 1e5, 1e-4, 5e-7, 0.5),
         "brake": Typical(3e6, 10.0, 0.3, 1e-3, 1.0, 900.0, 1e6, 2e-2, 1e-5, 8.5)}
#: name -> how it is made: the system and what moves it
SYSTEMS = {
    "lumped transient": lambda: _moving(rig(), SIZES["rig"], contact="table", friction=0.3, speeds=["20 rad/s"],
                                        step="0.2 ms", duration="40 ms", lowest_frequency="50 Hz", kick="10 mm/s"),
    "lumped modes": lambda: _linearised(rig(), SIZES["rig"], "20 rad/s", friction=0.3, damping_speed="10 m/s"),
    "pin transient": lambda: _moving(small_system()[1], SIZES["stiff"], contact="table", friction=0.3,
                                     speeds=["0.5 rad/s"], step="0.5 us", duration="0.1 ms", kick="1 mm/s"),
    "pin modes": lambda: _linearised(small_system()[1], SIZES["stiff"], "0.5 rad/s", frequency_max="4.5 kHz"),
    "beam transient": lambda: _moving(beams(), SIZES["stiff"], friction=0.3, speeds=["1 rad/s"], step="2 us",
                                      duration="0.4 ms", kick="1 mm/s"),
    "beam modes": lambda: _linearised(beams(), SIZES["stiff"], "1 rad/s", friction=0.3)}
SYSTEMS["brake multibody"] = lambda: System(small_brake(), multibody, MultibodySettings(
    pressures=["1 MPa"], speeds=["8.5 rad/s"], duration="11 ms", settling="2 ms", lowest_frequency="700 Hz",
    caliper_factors=(1.0,), abutment_factors=(1.0,), integrator="newmark"), SIZES["brake"], (small_map(),))
MODES = tuple(name for name in SYSTEMS if name.endswith("modes"))


@cache
def system(name):
    """The System of this name."""
    return SYSTEMS[name]()


def lumped_bench(block, damping_speed="10 m/s"):
    """The Bench of the rig as complex modes see it, with the YAML ``block`` of effects."""
    laws = TransientSettings(contact="table", damping_speed=damping_speed, friction=0.3)
    bench = about(rig(), laws, "rig", 0, 20.0, 1e-4)
    return with_effects(bench, product(fill(EffectSettings, block, "effects")), channels=False)
