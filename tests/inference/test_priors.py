"""Priors: densities that integrate to one, quantiles, moments of draws, and the latent coordinate."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from pipeline.contract.errors import ConfigError
from pipeline.inference.priors import LATENT_LIMIT, Factors, HalfNormal, LogNormal, Normal, Parameter, Uniform

PRIORS = [(Normal(2.0, 0.5), stats.norm(2.0, 0.5)), (LogNormal(3.0, 0.4), stats.lognorm(0.4, scale=3.0)),
          (HalfNormal(1.5), stats.halfnorm(scale=1.5)), (Uniform(-1.0, 3.0), stats.uniform(-1.0, 4.0))]


@pytest.mark.exact
@pytest.mark.parametrize("prior, reference", PRIORS, ids=lambda p: type(p).__name__)
def test_quantile_and_density_are_those_of_the_family(prior, reference):
    share = np.linspace(0.001, 0.999, 41)
    value = prior.quantile(share)
    np.testing.assert_allclose(value, reference.ppf(share), rtol=1e-9)
    np.testing.assert_allclose(prior.log_density(value), reference.logpdf(value), rtol=1e-9, atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("prior, reference", PRIORS, ids=lambda p: type(p).__name__)
def test_latent_coordinates_are_the_inverse_and_carry_a_standard_normal(prior, reference):
    latent = np.linspace(-5, 5, 31)
    np.testing.assert_allclose(prior.latent(prior.value(latent)), latent, atol=2e-8)
    slope = (prior.value(latent + 1e-5) - prior.value(latent - 1e-5)) / 2e-5
    inner = np.abs(latent) < 4
    density = np.exp(prior.log_density(prior.value(latent))) * slope
    np.testing.assert_allclose(density[inner], stats.norm.pdf(latent)[inner], rtol=1e-5)


@pytest.mark.parametrize("prior, reference", PRIORS, ids=lambda p: type(p).__name__)
def test_draws_have_the_moments_of_the_family_and_repeat_with_their_seed(prior, reference):
    draws = prior.sample(np.random.default_rng(3), 40000)
    assert abs(draws.mean() - reference.mean()) < 4 * reference.std() / 200
    assert np.all(draws >= prior.support[0]) and np.all(draws <= prior.support[1])
    assert np.array_equal(draws, prior.sample(np.random.default_rng(3), 40000))


@pytest.mark.exact
@pytest.mark.parametrize("prior, reference", PRIORS, ids=lambda p: type(p).__name__)
def test_scale_is_the_root_mean_square_about_the_centre(prior, reference):
    expected = {"LogNormal": 3.0 * 0.4, "HalfNormal": np.sqrt(quad(lambda x: x**2 * reference.pdf(x), 0, 20)[0])}
    assert prior.scale == pytest.approx(expected.get(type(prior).__name__, reference.std()))


def test_values_at_the_edge_of_a_prior_stay_finite():
    assert HalfNormal(1.0).latent(0.0) == -LATENT_LIMIT and LogNormal(1.0, 0.1).latent(0.0) == -LATENT_LIMIT
    assert HalfNormal(1.0).value(-LATENT_LIMIT) < 1e-14
    assert HalfNormal(1.0).log_density(-0.1) == -np.inf and Uniform(0.0, 1.0).log_density(1.1) == -np.inf


@pytest.mark.parametrize("make", [lambda: Normal(0.0, 0.0), lambda: LogNormal(0.0, 0.1), lambda: HalfNormal(0.0),
                                  lambda: Uniform(1.0, 1.0)])
def test_a_prior_without_width_is_refused(make):
    with pytest.raises(ConfigError, match="prior"):
        make()


def test_a_parameter_outside_its_prior_is_refused():
    with pytest.raises(ConfigError, match="parameter force: nominal: expected a value between 0 and inf"):
        Parameter("force", "N", -1.0, HalfNormal(1.0), 0.0)


def test_the_sign_of_an_effect_is_known_where_its_null_ends_the_support():
    assert Parameter("a", "1", 0.5, HalfNormal(1.0), 0.0).sign == 1
    assert Parameter("a", "1", 0.5, Uniform(0.0, 1.0), 1.0).sign == -1
    assert Parameter("a", "1", 0.5, Normal(0.0, 1.0), 0.0).sign == 0
    assert Parameter("a", "1", 0.5, HalfNormal(1.0)).sign == 0


@pytest.mark.exact
def test_a_negative_median_mirrors_the_prior():
    prior, mirror = LogNormal(-3.0, 0.4), LogNormal(3.0, 0.4)
    assert prior.support == (-np.inf, 0.0) and prior.scale == mirror.scale
    for value in (0.7, 3.0, 11.0):
        assert prior.latent(-value) == mirror.latent(value)
        assert prior.value(prior.latent(-value)) == pytest.approx(-value)
        assert prior.log_density(-value) == pytest.approx(mirror.log_density(value))
    assert prior.latent(2.0) == -LATENT_LIMIT


@pytest.mark.exact
def test_factors_are_as_likely_as_each_other_and_known_to_their_spread():
    prior = Factors((-10.0, -1.0, 0.1, 1e3), 0.02)
    values = prior.sample(np.random.default_rng(1), 4000)
    for factor in prior.each:
        near = values[np.abs(values / factor - 1) < 0.2]
        assert len(near) == pytest.approx(1000, abs=100)
        assert np.std(np.log(near / factor)) == pytest.approx(0.02, rel=0.1)
    np.testing.assert_allclose([prior.value(u) for u in prior.alternatives], prior.each, rtol=1e-12)
    for value in (-10.3, -0.98, 0.1, 1.01e3):
        assert prior.value(prior.latent(value)) == pytest.approx(value, rel=1e-9)
    assert Factors((-1.0,), 0.02).latent(1.0) == -8.0
    assert np.exp(prior.log_density(1e3)) == pytest.approx(1 / (4 * 20 * np.sqrt(2 * np.pi)))
    assert Parameter("sign", "1", -1.0, Factors((-1.0,), 0.02), 1.0).discrete


def test_a_factor_of_zero_is_refused():
    with pytest.raises(ConfigError, match="factors other than 0"):
        Factors((0.0, 1.0), 0.02)
