"""Stage micro_friction at tiny size."""

import numpy as np
import pytest

from pipeline.case_models import effect_block
from pipeline.contract import ConfigError, Context, ConvergenceError
from pipeline.contract.settings import fill, restored
from stages.friction_map import Settings as MapSettings
from stages.friction_map import friction_map
from stages.micro_friction import Settings, micro_friction
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface

TINY = {"pressures": ["1 MPa", "3 MPa"], "disc_speeds": ["8.5 rad/s", "12 rad/s"], "cycles": 4,
        "recorded_distances": ["0 mm", "2.5 mm", "10 mm"], "realisations": 2, "refinement": [1.0, 2.0]}


def rough(**changes):
    return surface(settings=SurfaceSettings(nodes=32, shortest_wavelength="125 um", **changes))


@pytest.fixture(scope="module")
def result():
    return micro_friction(rough(), settings=Settings(**TINY))


def test_axes_are_sliding_speeds_and_cycle_distances(result):
    np.testing.assert_allclose(result.speed, [8.5 * 0.128, 12 * 0.128])
    np.testing.assert_array_equal(result.disc_speed, [8.5, 12.0])
    np.testing.assert_allclose(result.distance, [0.0, 2.5e-3, 10e-3])
    assert result.friction.shape == (2, 2, 3)


@pytest.mark.exact
def test_friction_is_limit_times_area_over_pressure(result):
    expected = result.limit_at_speed * result.real_area / result.pressure[:, None, None]
    np.testing.assert_allclose(result.friction, expected, rtol=1e-4)
    assert result.shear_limit == pytest.approx(0.1 * 234e6 / np.sqrt(3.0), rel=1e-14)


@pytest.mark.exact
def test_block_compliance_is_thickness_over_oedometric_modulus(result):
    solids = Settings(**TINY)
    expected = sum(1e-3 * (1 + nu) * (1 - 2 * nu) / (s.youngs_modulus * (1 - nu))
                   for s in (solids.pad, solids.disc) for nu in [s.poisson_ratio])
    assert result.block_compliance == pytest.approx(expected, rel=1e-12)


def test_running_in(result):
    assert np.all(np.diff(result.friction, axis=2) > 0.0)
    assert np.all(result.wear_depth[:, :, 0] == 0.0) and np.all(np.diff(result.wear_depth, axis=2) > 0.0)
    assert np.all(result.friction_std > 0.0)
    assert np.all(result.real_area[1] > result.real_area[0])
    np.testing.assert_allclose(result.refinement, [4.0, 8.0])
    assert result.refinement_area[1] < result.refinement_area[0]


@pytest.mark.exact
def test_worn_volume(result):
    solids = Settings(**TINY)
    assert result.pad_wear[-1].mean() == pytest.approx(solids.pad.wear_coefficient * 3e6 * 10e-3, rel=1e-12)
    assert result.disc_wear[-1].mean() == pytest.approx(solids.disc.wear_coefficient * 3e6 * 10e-3, rel=1e-12)


def test_another_surface_gives_another_friction(result):
    other = micro_friction(rough(disc={"kind": "generated", "seed": 9}), settings=Settings(**TINY))
    assert np.abs(other.friction / result.friction - 1.0).max() > 0.01


def test_same_seed_same_bits(result):
    again = micro_friction(rough(), settings=Settings(**TINY))
    np.testing.assert_array_equal(again.friction, result.friction)
    np.testing.assert_array_equal(again.contact_pressure, result.contact_pressure)


@pytest.mark.parametrize("wrong", [{"recorded_distances": ["0 mm", "1 mm", "10 mm"]},
                                   {"recorded_distances": ["2.5 mm", "10 mm"]}, {"recorded_distances": ["0 mm"]},
                                   {"recorded_distances": ["0 mm", "10 mm", "5 mm"]}, {"pressures": ["3 MPa", "1 MPa"]},
                                   {"disc_speeds": ["12 rad/s", "12 rad/s"]}])
def test_axes_that_do_not_rise_are_refused(wrong):
    with pytest.raises(ConfigError, match=rf"micro_friction\.{next(iter(wrong))}"):
        micro_friction(rough(), settings=Settings(**{**TINY, **wrong}))


def stated(**given):
    return effect_block.product(fill(effect_block.Settings, given, "effects"))


@pytest.mark.exact
def test_effects_of_the_block_act_at_the_asperities(result):
    """Half the shear limit is half the friction (no heat); half of what the pad loses sticks to the disc."""
    settings = Settings(**TINY, softening="0 1/K")
    block = stated(shear_limit={"asperities": {"factor": 0.5, "pressure_coefficient": 0}},
                   material_transfer={"asperities": {"share": 0.5}})
    found = micro_friction(rough(), block, settings=settings)
    assert found.shear_limit == pytest.approx(0.5 * result.shear_limit, rel=1e-14)
    plain = micro_friction(rough(), settings=settings)
    np.testing.assert_allclose(found.friction[:, :, 0], 0.5 * plain.friction[:, :, 0],
                               rtol=1e-4)
    lost = settings.disc.wear_coefficient - 0.5 * settings.pad.wear_coefficient
    assert found.disc_wear[-1].mean() == pytest.approx(lost * 3e6 * 10e-3, rel=1e-9)


def test_an_empty_block_changes_no_bit(result):
    np.testing.assert_array_equal(micro_friction(rough(), stated(), settings=Settings(**TINY)).friction,
                                  result.friction)


def test_the_product_tells_its_section(result):
    assert restored(Settings, result.settings.item()) == Settings(**TINY)


def test_non_convergence_raises():
    with pytest.raises(ConvergenceError, match="normal contact"):
        micro_friction(rough(), settings=Settings(**TINY, max_iterations=2))


def test_errors_are_those_of_pairs_of_surfaces_where_there_are_several():
    settings = Settings(**TINY | {"refinement": [1.0]})
    found = micro_friction(rough(pairs=3), settings=settings)
    assert found.pair_friction.shape == (3, 2, 2, 3)
    np.testing.assert_allclose(found.pair_friction.mean(axis=0), found.friction, rtol=1e-12)
    np.testing.assert_allclose(found.friction_std, found.pair_friction.std(axis=0, ddof=1) / np.sqrt(3), rtol=1e-12)


def test_the_first_of_several_pairs_is_that_of_one(result):
    found = micro_friction(rough(pairs=2), settings=Settings(**TINY))
    np.testing.assert_allclose(found.pair_friction[0], result.friction, rtol=1e-12)
    np.testing.assert_array_equal(found.contact_pressure, result.contact_pressure)


def test_three_grids_tell_the_limit_of_the_area():
    found = micro_friction(rough(), settings=Settings(**TINY | {"refinement": [1.0, 2.0, 4.0]}))
    assert found.area_limit < found.refinement_area[-1] < found.refinement_area[0]
    assert 0 < found.area_limit_error < found.refinement_area[0] - found.area_limit


@pytest.mark.parametrize("wrong", [{"pressures": ["1 MPa", "1 GPa"]}, {"pressures": ["1 Pa", "1 MPa"]},
                                   {"rate_coefficient": 6.0}, {"refinement": [1.0, 1e5]}])
def test_what_the_pair_cannot_bear_is_refused_before_anything_slides(wrong):
    class Still(Context):
        def map(self, *_):
            pytest.fail("it slides")

    with pytest.raises(ConfigError, match=rf"^micro_friction\.{next(iter(wrong))}"):
        micro_friction(rough(), settings=Settings(**{**TINY, **wrong}), context=Still())


@pytest.mark.parametrize("wrong", [{"third_body_factor": 0}, {"disc_strength": "0 MPa"},
                                   {"pad": {"wear_coefficient": "-1e-6 mm^2/N"}}])
def test_no_shear_strength_and_negative_wear_are_refused(wrong):
    with pytest.raises(ConfigError, match=rf"micro_friction\.{next(iter(wrong))}.*: input should be greater than"):
        fill(Settings, {**TINY, **wrong}, "case: micro_friction")


def test_a_hard_body_changes_nothing_and_a_soft_one_yields(result):
    """Beyond the largest pressure the numbers are the same to the last bit; below, more area carries the load."""
    def with_hardness(value):
        return micro_friction(rough(), settings=fill(Settings, {**TINY, "pad": {"hardness": f"{value!r} Pa"}}, "m"))

    hard, soft = with_hardness(1e12), with_hardness(0.3 * float(result.contact_pressure[0].max()))
    np.testing.assert_array_equal(hard.friction, result.friction)
    assert not hard.yielding_area.any() and not result.yielding_area.any()
    assert np.all(soft.yielding_area > 0.0) and np.all(soft.yielding_area < soft.real_area)
    assert np.all(soft.real_area > result.real_area) and np.all(soft.friction > result.friction)
    assert soft.contact_pressure[0].max() <= 0.3 * result.contact_pressure[0].max() * (1 + 1e-12)


def test_particles_of_the_resin_are_the_resin_and_stiffer_ones_change_it():
    """One modulus, one shear limit: the numbers of one material; particles that hardly wear keep the surfaces apart."""
    short = TINY | {"pressures": ["1 MPa"], "disc_speeds": ["8.5 rad/s"], "cycles": 2, "realisations": 1,
                    "recorded_distances": ["0 mm", "10 mm"], "refinement": [1.0]}

    def of(**inclusions):
        asked = short | {"pad": {"inclusions": {"size": "200 um", **inclusions}}}
        return micro_friction(rough(), settings=fill(Settings, asked, "micro_friction"))

    one, same = micro_friction(rough(), settings=Settings(**short)), of(modulus_factor=1.0)
    np.testing.assert_allclose(same.friction[:, 0], one.friction[:, 0], rtol=2e-3)
    np.testing.assert_allclose(same.wear_depth[:, 0, 1:], one.wear_depth[:, 0, 1:], rtol=5e-3)
    assert (of(modulus_factor=1.0, wear_factor=0.1).wear_depth[:, 0, -1] < 0.95 * same.wear_depth[:, 0, -1]).all()
    assert of(modulus_factor=1.0, shear_factor=1e-9, share=0.5).friction[0, 0, 0] < 0.9 * same.friction[0, 0, 0]
    assert of(modulus_factor=5.0).real_area[0, 0, 0] < 0.97 * same.real_area[0, 0, 0]


def test_shear_that_lifts_changes_friction_a_little_and_between_like_bodies_nothing(result):
    def of(**more):
        asked = TINY | {"realisations": 1, "coupling": True} | more
        return micro_friction(rough(), settings=fill(Settings, asked, "micro_friction"))

    one = micro_friction(rough(), settings=Settings(**TINY | {"realisations": 1}))
    lifted = of()
    assert np.abs(lifted.contact_pressure[0] - one.contact_pressure[0]).max() > 0.02 * one.contact_pressure[0].max()
    np.testing.assert_allclose(lifted.friction, one.friction, rtol=0.05)
    assert not np.array_equal(lifted.friction, one.friction)
    alike = {"disc": {"youngs_modulus": "1 GPa", "poisson_ratio": 0.25}, "pad": {"youngs_modulus": "1 GPa"}}
    np.testing.assert_allclose(of(**alike).friction, of(**alike, coupling=False).friction, rtol=1e-12)


@pytest.mark.exact
def test_spots_that_are_also_sheared_yield_as_tabor_says(result):
    """p^2 + alpha tau^2 = H^2; where all spots yield, the area is that of the load over this pressure."""
    shear, hardness = float(result.shear_limit), 0.3 * float(result.contact_pressure[0].max())
    alpha = 0.5 * (hardness / shear) ** 2
    asked = TINY | {"realisations": 1, "pad": {"hardness": f"{hardness!r} Pa", "junction_growth": alpha}}
    found = micro_friction(rough(), settings=fill(Settings, asked, "micro_friction"))
    assert found.contact_pressure[0].max() == pytest.approx(hardness / np.sqrt(2), rel=1e-9)
    with pytest.raises(ConfigError, match=r"micro_friction\.pad\.junction_growth: expected less than"):
        micro_friction(rough(), settings=fill(Settings, TINY | {"pad": {
            "hardness": f"{hardness!r} Pa", "junction_growth": 2.1 * alpha}}, "micro_friction"))


def test_friction_from_rest_reaches_that_of_sliding(result):
    asked = TINY | {"realisations": 1, "presliding": [0.1, 0.5, 1.0]}
    found = micro_friction(rough(), settings=Settings(**asked))
    assert found.presliding_friction.shape == (2, 3) and np.all(np.diff(found.presliding_friction, axis=1) > 0)
    np.testing.assert_allclose(found.presliding_friction[:, -1], found.friction[:, 1, 0], rtol=0.05)
    ratio = found.tangential_stiffness / found.normal_stiffness[:, 0, 0]
    np.testing.assert_allclose(ratio, 0.75 / 0.875, rtol=0.15)        # Mindlin, Poisson ratio .25
    assert result.presliding_friction.shape == (2, 0) and not result.tangential_stiffness.any()


def test_bearing_curves_lose_what_wears_and_stress_is_largest_below_the_spots(result):
    new, worn = result.pad_bearing[[0, -1]]
    assert np.all(np.diff(new) <= 0) and (new - worn)[:10].mean() > 2 * result.pad_wear[-1].mean()
    assert new.mean() - worn.mean() == pytest.approx(result.pad_wear[-1].mean(), rel=0.05)
    assert result.stress.shape == (result.stress_depth.size, result.x.size)
    np.testing.assert_allclose(result.stress.max(), result.stress_largest.max())
    assert result.stress_largest[-1] < 0.6 * result.stress_largest.max()
    assert 0.5 < result.stress_largest.max() / result.contact_pressure[0].max() < 2.0


@pytest.mark.exact
def test_the_map_over_temperature_is_that_of_a_softer_limit(result):
    """Bodies that are warmer by T have 1 - softening T of the shear limit: as computed with that third-body factor."""
    stated = Settings(**TINY)
    made = friction_map(result, settings=MapSettings(bulk_temperatures=["0 K", "300 K"])).over_temperature["bodies"]
    cooler = friction_map(result, settings=MapSettings())
    assert not cooler.over_temperature
    np.testing.assert_allclose(made.friction[0], cooler.friction, rtol=1e-12)
    softer = micro_friction(rough(), settings=Settings(
        **TINY, third_body_factor=stated.third_body_factor * (1 - 300 * stated.softening)))
    np.testing.assert_allclose(made.friction[1], friction_map(softer, settings=MapSettings()).friction, rtol=1e-3)
    with pytest.raises(ConfigError, match="bulk_temperatures: expected less than 2000 K"):
        friction_map(result, settings=MapSettings(bulk_temperatures=["2500 K"]))


@pytest.mark.exact
def test_the_map_of_warm_bodies_is_that_of_a_softer_limit(result):
    """Its friction and all errors; the map over temperature stays, whatever the temperature of the map, but for what
    curves through other points differ between them."""
    stated = Settings(**TINY)
    warm = friction_map(result, settings=MapSettings(bulk_temperature="300 K", bulk_temperatures=["0 K", "300 K"]))
    assert warm.bulk_temperature == 300
    softer = micro_friction(rough(), settings=Settings(
        **TINY, third_body_factor=stated.third_body_factor * (1 - 300 * stated.softening)))
    made = friction_map(softer, settings=MapSettings())
    np.testing.assert_allclose(warm.friction, made.friction, rtol=1e-3)
    np.testing.assert_allclose(warm.friction_std, made.friction_std, rtol=2e-3)
    np.testing.assert_allclose(warm.pressure_slope_std, made.pressure_slope_std, rtol=2e-3)
    cold = friction_map(result, settings=MapSettings())
    np.testing.assert_allclose(warm.over_temperature["bodies"].friction[0], cold.friction, rtol=1e-5)
    np.testing.assert_allclose(warm.over_temperature["bodies"].friction[1], warm.friction, rtol=1e-12)
    with pytest.raises(ConfigError, match="friction_map.bulk_temperature: expected less than 2000 K"):
        friction_map(result, settings=MapSettings(bulk_temperature="2500 K"))
