"""Effects on the pads of a disc brake: from a bench to the PadSystem of the multibody model."""

from difflib import get_close_matches

import numpy as np

from pipeline.case_models.virtual_rig import groups
from pipeline.contract import ConfigError
from pipeline.effects import CATALOGUE
from pipeline.effects.effect import compose
from pipeline.physics.contact.groups import parts
from pipeline.physics.friction.dry_friction import Friction, under
from pipeline.physics.friction.state_kernels import DISTANCE, SCATTER
from pipeline.physics.friction.state_variables import Scatter, state_kernel
from pipeline.physics.pads.pad_system import on_springs, pad_elements, pad_friction
from pipeline.physics.sliding.doublets import doublets
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.time_stepping.elements import ENCLOSED, Turning, wave_table
from pipeline.physics.time_stepping.normal_laws import normal_kernel
from pipeline.physics.time_stepping.simulate import Table
from pipeline.physics.virtual_rig.response import Bench

#: states of friction that pads have otherwise: by the distance of the sub-discs, and around the disc
_BY_THE_SUB_DISCS = (DISTANCE, SCATTER)


def braked(model, friction, speed, settings):
    """Bench of a product ReducedModel at a disc speed (rad/s), with a FrictionLaw, under the section ``multibody``."""
    sliding = sliding_model(model, 0, speed)
    law = Table(model.law_closure, model.law_pressure, settings.damping_speed, model.contact_gap)
    return Bench(sliding, law, Friction(friction), settings.step, (), groups(model), doublets=doublets(sliding))


def with_terms(bench, terms, conditions):
    """(SlidingModel, dress): the model of a Bench with Terms on it, and what puts their laws, friction, surfaces and
    elements on a PadSystem; ``conditions`` {name: value} are those that friction depends on."""
    whole = compose(bench, terms)
    friction = under(whole.friction, conditions, "effects")
    return whole.model, lambda system, model: _dressed(system, model, whole, friction) if terms else system


def _dressed(system, model, bench, friction):
    """A PadSystem with the law of contact of a Bench, and the surfaces and elements of its SlidingModel."""
    count = len(model.contacts.area)
    states = state_kernel(friction, model.contacts.area)
    acting = ~np.isin(states.kind, _BY_THE_SUB_DISCS)
    contact = system.contact._replace(
        law=normal_kernel(bench.law, model.contacts), dry=pad_friction(friction, count),
        waviness=wave_table(model.contacts.waviness), scatter=_scatter(friction, count),
        states=states._replace(kind=states.kind[acting], contact=states.contact[acting],
                               parameter=states.parameter[acting], begin=0 * states.begin),
        wear=np.array(np.broadcast_to(model.contacts.wear, count), float))
    _refuse_laws(model.elements)
    elements = on_springs(model.elements, system.mass, bench.step)
    return system._replace(contact=contact, elements=pad_elements(elements, model.size))


def _scatter(friction, count):
    rows = [(i, state.amplitude, state.order, np.broadcast_to(state.phase, count)[i])
            for law, members in parts(friction, count) for state in law.states if isinstance(state, Scatter)
            for i in members]
    return np.array(rows, float).reshape(-1, 4)


def _refuse_laws(elements):
    for element in elements:
        if isinstance(element.law, Turning):
            raise refused(element.name.split()[0], "turns friction that turns anyway")
        if isinstance(element.law, ENCLOSED):
            raise refused(element.name.split()[0], "jumps where the motion turns, which its Newton iterations do not"
                                                   " follow")


def kept(terms, without):
    """The Terms whose effects are not named in ``without``; ConfigError for names that no effect has."""
    names = [effect.name for effect in CATALOGUE]
    for name in without:
        if name not in names:
            near = get_close_matches(name, names, 1)
            raise ConfigError("multibody.without", "names of effects", repr(name),
                              f"did you mean '{near[0]}'?" if near else None)
    return tuple(term for term in terms if term.effect.name not in without)


def refused(name, why):
    """ConfigError for an effect that does not act in the stage multibody."""
    return ConfigError(f"effects.{name}", "an effect that acts in the stage multibody", f"one that {why}",
                       f"leave it out there, by multibody.without: [{name}]")


def refuse_idle(terms, build):
    """Refuse Terms that leave the PadSystem of ``build(terms)`` as it is: no stage ignores an effect silently."""
    plain = build(())
    for term in terms:
        if _alike(build((term,)), plain):
            raise refused(term.effect.name, f"changes nothing at {term.location}: pads, caliper and their contacts on a"
                                            " rigid disc have no such physics here")


def _alike(first, other):
    if isinstance(first, tuple):
        return all(map(_alike, first, other))
    return np.array_equal(first, other)
