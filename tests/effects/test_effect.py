"""What every effect of the catalogue owes, and how effects are put together."""

import pickle
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.effects import CATALOGUE, family, named
from pipeline.effects.effect import STAGES, Term, compose, null_values, shaped_values
from pipeline.effects.typical import ASPERITIES, CHANNEL, CHANNEL_PAIR, Typical, typical
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Responder, respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import pressed, rubbing, tabled

BASE, RUN = rubbing(), pressed()
#: all that RUN does, in a fifth of its steps
SHORT = pressed(RUN.duration / 5)
BENCHES = {"penalty": BASE, "table": rubbing(tabled())}
SHORT_ANSWERS = {law: respond(bench, SHORT) for law, bench in BENCHES.items()}
ANSWER = respond(BASE, RUN)
#: effects at the scale of the roughness only have no location on a bench (tests/effects/test_micro_scale.py)
ON_BENCHES = tuple(e for e in CATALOGUE if e.location != ASPERITIES)
UPPER = 0.75        # quartile: in the middle of a prior of either sign lies the null


@cache
def sizes(kind, law, location):
    """Typical quantities, which all effects of a kind of location share, on the bench with this contact law."""
    return typical(kind, BENCHES[law], location, (RUN,))


@cache
def everywhere(effect, law="penalty"):
    """(location, parameters) at each location of the bench with this contact law."""
    return [(location, effect.parameters(sizes(effect.kind_at(location), law, location)))
            for location in effect.locations(BENCHES[law])]


def answered(calculate):
    """What ``calculate`` gives, None where it refuses."""
    try:
        return calculate()
    except ConfigError as error:
        assert error.expected
        return None


def each(test):
    return pytest.mark.parametrize("effect", ON_BENCHES, ids=[e.name for e in ON_BENCHES])(test)


@each
def test_null_is_the_base_bit_for_bit(effect):
    for law, bench in BENCHES.items():
        for location, parameters in everywhere(effect, law):
            assert any(p.null is not None for p in parameters)
            found = respond(effect.on(bench, location, null_values(parameters)), SHORT)
            for name, values in SHORT_ANSWERS[law].items():
                np.testing.assert_array_equal(found[name], values)


@each
def test_linear_forms_know_it_too(effect):
    """Roots and equation residual: at the null those of the base and what relaxes on its own; elsewhere finite."""
    base, left = roots(BASE, RUN), equation_residual(BASE, RUN, ANSWER)
    for location, parameters in everywhere(effect)[:1]:
        null = effect.on(BASE, location, null_values(parameters))
        found = roots(null, RUN)
        assert all(abs(found - root).min() <= 1e-9 * abs(root) for root in base)
        assert np.all(found[~np.isclose(found[:, None], base).any(axis=1)] < 0)
        np.testing.assert_array_equal(equation_residual(null, RUN, ANSWER), left)
        changed = effect.on(BASE, location, shaped_values(parameters, UPPER))
        for form in (lambda b=changed: roots(b, RUN), lambda b=changed: equation_residual(b, RUN, ANSWER)):
            found = answered(form)
            assert found is None or np.isfinite(found).all()


@each
def test_finite_over_the_prior(effect):
    """Or refused, as where a joint softens so far that nothing holds the mass, or hardens beyond the step."""
    assert effect.locations(BASE)
    random, refused, tried = np.random.default_rng(5), 0, 0
    for location, parameters in everywhere(effect)[:2]:
        draws = [shaped_values(parameters, share) for share in (0.03, 0.5, 0.97)]
        draws += [{p.name: float(p.prior.sample(random)) for p in parameters} for _ in range(3)]
        tried += len(draws)
        for values in draws:
            try:
                found = respond(effect.on(BASE, location, values), SHORT)
            except BrakechainError:
                refused += 1
                continue
            assert all(np.isfinite(v).all() for v in found.values()), values
    either_sign = any(p.null is not None and p.sign == 0 for p in parameters)
    assert refused <= (tried // 2 if either_sign else 0)


@each
def test_runs_that_share_a_set_up_leave_no_trace_in_one_another(effect):
    """A run after others of the same bench, on the arrays that they share, has the bits of the run alone."""
    location, parameters = everywhere(effect)[0]
    bench = effect.on(BASE, location, shaped_values(parameters, UPPER))
    rest = np.zeros(bench.model.size)
    steady, pressed_on = RUN.until(101), replace(RUN.until(41), start=Start(rest - 3e-3, rest + 0.1))
    shared, alone = Responder(bench), [respond(bench, run) for run in (steady, pressed_on)]
    for run, expected in ((steady, alone[0]), (pressed_on, alone[1]), (steady, alone[0])):
        for name, values in shared.respond(run).items():
            np.testing.assert_array_equal(values, expected[name])


@each
def test_visible_where_the_prior_puts_it(effect):
    for location, parameters in everywhere(effect)[:1]:
        found = respond(effect.on(BASE, location, shaped_values(parameters, UPPER)), RUN)
        change = [np.std(found[n] - v) / np.std(v) for n, v in ANSWER.items()]
        offset = [abs(np.mean(found[n] - v)) / np.std(v) for n, v in ANSWER.items()]
        assert max(*change, *offset) > 2e-3


@each
def test_what_is_given_stays_as_it_is(effect):
    before = pickle.dumps(BASE)
    for location, parameters in everywhere(effect):
        effect.on(BASE, location, shaped_values(parameters, UPPER))
    assert pickle.dumps(BASE) == before


@pytest.mark.parametrize("effect", CATALOGUE, ids=[e.name for e in CATALOGUE])
def test_an_effect_describes_itself(effect):
    module = sys.modules[effect.apply.__module__]
    assert module.__name__.endswith(f".{effect.name}")
    assert module.__doc__ and effect.summary and effect.source and effect.valid.startswith("Valid ")
    assert effect.stage in STAGES and (effect.kind == "sensor") == (effect.location in (CHANNEL, CHANNEL_PAIR))
    assert effect.kind in ("physics", "sensor")
    assert pickle.loads(pickle.dumps(effect)) == effect
    parameters = effect.parameters(Typical())
    assert all(p.unit for p in parameters) and set(effect.linear) <= {p.name for p in parameters}


@pytest.mark.parametrize("effect", [e for e in CATALOGUE if e.linear], ids=lambda e: e.name)
def test_linear_parameters_are_linear_in_the_equation_of_motion(effect):
    location, parameters = everywhere(effect)[0]
    values, null = shaped_values(parameters, UPPER), null_values(parameters)
    base = {**values, **{n: null[n] for n in effect.linear}}
    half = {**values, **{n: values[n] / 2 for n in effect.linear}}
    none, some, full = (equation_residual(effect.on(BASE, location, v), RUN, ANSWER) for v in (base, half, values))
    assert abs(some - none).max() > 0
    elastic = location == "joint_0" and effect.stage == "friction"     # a way to stick that grows with the force
    assert np.linalg.norm(full - 2 * some + none) <= (0.1 if elastic else 1e-6) * np.linalg.norm(some - none)


def test_parameters_at_a_location_are_those_of_its_typical_quantities():
    for effect in (named("coulomb"), named("runout"), named("sensor_gain")):
        location, parameters = everywhere(effect)[0]
        assert effect.at(BASE, location, (RUN,)) == parameters


def test_names_are_unique_and_found():
    assert len({e.name for e in CATALOGUE}) == len(CATALOGUE)
    assert named("runout").name == "runout"


def test_the_order_of_stages_is_declared_and_does_not_depend_on_that_of_the_terms():
    softer = Term(named("compliant_arm"), "joint_0", {"compliance": 1e-4, "behind": 0.0})
    play = Term(named("sensor_gain"), "x", {"error": 0.2})
    fall = Term(named("falling_friction"), "contact", {"rise": 0.3, "decay_speed": 0.5})
    one, other = (respond(compose(BASE, terms), RUN) for terms in ((softer, play, fall), (fall, play, softer)))
    for name in one:
        np.testing.assert_array_equal(one[name], other[name])
    assert not np.array_equal(one["x"], ANSWER["x"])


def test_pairs_can_be_composed():
    """Each effect with the next one in the catalogue, both at the upper quartile of their priors."""
    for first, second in zip(ON_BENCHES, ON_BENCHES[1:], strict=False):
        terms = [Term(e, location, shaped_values(parameters, UPPER)) for e in (first, second)
                 for location, parameters in everywhere(e)[:1]]
        found = respond(compose(BASE, terms), SHORT)
        assert all(np.isfinite(v).all() for v in found.values()), (first.name, second.name)


@pytest.mark.parametrize("location, values, said", [
    ("nowhere", {"damping": 1.0}, "joint_0"), ("joint_0", {"drag": 1.0}, "damping"),
    ("joint_0", {"damping": -1.0}, "0 to"), ("joint_0", {}, "none")])
def test_wrong_locations_names_and_signs_are_refused(location, values, said):
    with pytest.raises(ConfigError, match=said):
        named("joint_damping").on(BASE, location, values)


def test_no_contact_no_location():
    contacts = BASE.model.contacts
    empty = replace(contacts, **{n: getattr(contacts, n)[:0] for n in ("normal", "tangent", "lateral", "position",
                                                                      "area", "lever", "preload")})
    assert named("runout").locations(replace(BASE, groups={}, model=replace(BASE.model, contacts=empty))) == ()


def test_what_an_effect_extends_is_in_the_catalogue_at_the_same_kind_of_location():
    known = {e.name: e.location for e in CATALOGUE}
    extending = [e for e in CATALOGUE if e.extends]
    assert extending and all(known[name] == e.location and name != e.name for e in extending for name in e.extends)


@pytest.mark.parametrize("names, places, told", [
    (["coulomb", "dahl"], ["guide", "guide"], "dry friction"), (["coulomb"], ["guide"], ""),
    (["coulomb", "dahl"], ["guide", "arm"], ""), (["coulomb", "cubic_stiffness"], ["guide", "guide"], ""),
    (["runout", "thickness_variation"], ["disc", "disc"], ""), (["coulomb + dahl", "dahl"], ["guide", "guide"], ""),
    ([], [], "")])
def test_laws_of_one_family_at_one_place_are_called_by_it(names, places, told):
    assert family(names, places) == told


def test_what_extends_a_law_is_of_its_family():
    family_of = {e.name: e.family for e in CATALOGUE}
    both = [(e, name) for e in CATALOGUE for name in e.extends if e.family and family_of[name]]
    assert both and all(e.family == family_of[name] or e.name == "stribeck_joint" for e, name in both)
