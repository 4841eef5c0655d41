"""What every effect of the scale of the roughness owes."""

import pickle

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import CATALOGUE, named
from pipeline.effects.effect import Term, compose, null_values, shaped_values
from pipeline.effects.typical import ASPERITIES
from pipeline.physics.friction.state_variables import Film
from tests.effects.benches import rubbing as bench
from tests.effects.rough_pair import DRAG, rubbed, rubbing

MICRO = tuple(e for e in CATALOGUE if e.locations(rubbing()))
UPPER = 0.75


@pytest.fixture(scope="module")
def base():
    return rubbed(rubbing())


def each(test):
    return pytest.mark.parametrize("effect", MICRO, ids=[e.name for e in MICRO])(test)


def parameters(effect):
    return effect.at(rubbing(), ASPERITIES, (DRAG,))


def arrays(record):
    """{name: array} of a SlidingRecord and of its maps."""
    return {name: value for name, value in (vars(record) | vars(record.maps)).items() if name != "maps"}


def test_who_they_are():
    assert {e.name for e in MICRO} == {"third_body_film", "material_transfer", "wear_law", "shear_limit"}
    assert all(e.locations(bench()) for e in CATALOGUE if e not in MICRO), "other effects act on a bench"


@each
def test_null_is_the_base_bit_for_bit(effect, base):
    found = rubbed(effect.on(rubbing(), ASPERITIES, null_values(parameters(effect))))
    for name, values in arrays(base).items():
        np.testing.assert_array_equal(arrays(found)[name], values, err_msg=name)


@each
def test_finite_over_the_prior(effect):
    random = np.random.default_rng(5)
    draws = [shaped_values(parameters(effect), share) for share in (0.03, 0.5, 0.97)]
    draws.append({p.name: float(p.prior.sample(random)) for p in parameters(effect)})
    for values in draws:
        found = rubbed(effect.on(rubbing(), ASPERITIES, values))
        assert np.all(found.friction > 0) and all(np.isfinite(values).all() for values in arrays(found).values())


@each
def test_visible_where_the_prior_puts_it(effect, base):
    """In friction or in what is worn, under a pressure that is not that of reference."""
    found = rubbed(effect.on(rubbing(), ASPERITIES, shaped_values(parameters(effect), UPPER)), 3e6)
    plain = rubbed(rubbing(), 3e6)
    change = abs(found.friction / plain.friction - 1).max()
    worn = abs(found.maps.disc_wear - plain.maps.disc_wear).max() / plain.maps.disc_wear.max()
    assert max(change, worn) > 2e-3


@each
def test_what_is_given_stays_as_it_is(effect):
    before = pickle.dumps(rubbing())
    effect.on(rubbing(), ASPERITIES, shaped_values(parameters(effect), UPPER))
    assert pickle.dumps(rubbing()) == before


def test_all_together():
    terms = tuple(Term(e, ASPERITIES, shaped_values(parameters(e), UPPER)) for e in MICRO)
    forth, back = (compose(rubbing(), order) for order in (terms, terms[::-1]))
    assert forth.wearing == back.wearing and forth.shearing == back.shearing
    assert isinstance(forth.shearing.film, Film) and np.isfinite(rubbed(forth).friction).all()


@each
def test_a_bench_has_no_asperities(effect):
    with pytest.raises(ConfigError, match="a rough pair, as in stage micro_friction, found a bench"):
        effect.on(bench(), ASPERITIES, shaped_values(parameters(effect)))


def test_a_rough_pair_has_no_joints():
    with pytest.raises(ConfigError, match="none here"):
        named("cubic_stiffness").on(rubbing(), "joint_0", {"coefficient": 1.0})
    with pytest.raises(ConfigError, match="a rough pair"):
        named("wear_law").on(bench(), "contact", {"exponent": 1.0, "pressure": 1e6})
