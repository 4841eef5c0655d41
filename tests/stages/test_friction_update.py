"""Stage friction_update: measured friction is of other values than the case believes, and comes out as these."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError, Context, documents
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.products import Channel, Condition, MeasuredFriction, Recording, Run
from stages.friction_map import Settings as MapSettings
from stages.friction_map import friction_map
from stages.friction_update import Settings, companions, friction_update
from stages.micro_friction import Settings as MicroSettings
from stages.micro_friction import micro_friction
from tests.diagnosis.measured_friction.test_samples import RATE, strokes
from tests.stages.test_micro_friction import rough
from tests.studies import worn

TINY = {"pressures": ["0.5 MPa", "1 MPa", "3 MPa"], "disc_speeds": ["4 rad/s", "8.5 rad/s", "16 rad/s"], "cycles": 20,
        "recorded_distances": ["0 mm", "1 mm", "2 mm", "4 mm", "6 mm", "8 mm", "10 mm"], "realisations": 2,
        "refinement": [1.0]}
SURFACES = rough()


def mapped(**changes):
    """(MicroFriction, FrictionMap) of the same surfaces with other values."""
    micro = micro_friction(SURFACES, settings=MicroSettings(**{**TINY, **changes}))
    return micro, friction_map(micro, settings=MapSettings(pressure_subdivisions=4))


@pytest.fixture(scope="module")
def believed():
    """The map that the case believes; the truth is one of the same grid."""
    micro, told = mapped()
    return replace(micro, area_limit=micro.refinement_area[0], area_limit_error=np.array(0.0)), told


def bench(true, seed=0, noise=0.01, count=40):
    """Recording of coefficients of the map ``true`` at conditions within it, in three runs."""
    random, runs = np.random.default_rng(seed), {}
    law = FrictionLaw.of(true)
    for name in ("first", "second", "third"):
        p, v = random.uniform(0.7e6, 2.5e6, count // 3), random.uniform(0.6, 2.0, count // 3)
        s = random.uniform(0.0, 4e-3, count // 3)
        mu = law.evaluate(p, v, s)[0] * (1 + noise * random.standard_normal(len(p)))
        runs[name] = Run(description="", repeat_of="", friction={"table": MeasuredFriction(
            friction=mu, friction_std=noise * mu, pressure=p, speed=v, distance=s, temperature=np.full(len(p), 293.0))})
    return Recording(source=["made for a test"], runs=runs)


def told(believed, recording, **settings):
    return friction_update(*believed, recording, settings=Settings(**settings), context=Context())


def test_friction_as_believed_is_consistent(believed):
    product = told(believed, bench(believed[1]))
    assert str(product.verdict) == "consistent" and not product.needed.any() and not len(product.setting)
    assert companions(product, SimpleNamespace(name="case", document={})) == {}


def test_another_shear_limit_is_found_in_the_units_of_its_setting(believed):
    exact = (believed[0], replace(believed[1], friction_std=0 * believed[1].friction_std))     # of the same surfaces
    product = told(exact, bench(mapped(third_body_factor=0.08)[1]))
    assert str(product.verdict) == "values" and product.term[product.needed > 0].tolist() == ["level"]
    assert product.setting.tolist() == ["third_body_factor"] and product.setting_before[0] == 0.1
    assert abs(product.setting_after[0] - 0.08) < 3 * product.setting_std[0] < 0.002


def test_faster_wear_is_told_as_wear(believed):
    true = mapped(pad={"wear_coefficient": "12e-6 mm^2/N"}, disc={"wear_coefficient": "12e-7 mm^2/N"})[1]
    product = told(believed, bench(true))
    assert product.term[product.needed > 0].tolist() == ["distance"] and str(product.verdict) == "values"
    factor = product.setting_after / product.setting_before
    assert product.setting.tolist() == ["disc.wear_coefficient", "pad.wear_coefficient"]
    assert (abs(factor - 3.0) < 3 * product.setting_std / product.setting_before).all() and (factor > 2).all()


def test_the_completed_case_states_the_values_with_their_origin(believed, tmp_path):
    exact = (believed[0], replace(believed[1], friction_std=0 * believed[1].friction_std))
    product = told(exact, bench(mapped(third_body_factor=0.08)[1]))
    case = SimpleNamespace(name="brake", document={"title": "A brake", "micro_friction": {"cycles": 20}})
    (tmp_path / "updated.yaml").write_text(companions(product, case)["brake_updated.yaml"])
    stated = documents.read_yaml(tmp_path / "updated.yaml")["micro_friction"]
    assert stated["cycles"] == 20 and stated["third_body_factor"]["origin"] == "inferred"
    assert stated["third_body_factor"]["value"] == pytest.approx(product.setting_after[0])
    falling = replace(product, setting=np.array(["rate_coefficient"]), setting_after=np.array([-0.01]),
                      setting_before=np.array([0.015]), setting_std=np.array([0.001]))
    assert companions(falling, case) == {}, "a rate of the shear limit is not negative"


def test_strokes_of_a_tribometer_are_read(believed):
    load, friction, position = strokes(mu=0.5)
    bare = {"missing": np.empty((0, 2), int), "measures": "", "rate": RATE, "begin": 0.0, "place": "", "position": [],
            "direction": [], "role": "response"}
    channels = {name: Channel(samples=samples, unit=unit, **bare) for name, samples, unit in
                (("load", load, "N"), ("friction", friction, "N"), ("position", position, "m"))}
    conditions = {name: Condition(value=[value], time=[0.0], unit=unit) for name, value, unit in
                  (("distance", 2e-3, "m"), ("temperature", 400.0, "K"))}
    recording = Recording(source=["made for a test"], runs={"strokes": Run(
        description="", repeat_of="", channels=channels, conditions=conditions)})
    product = told(believed, recording, slides={"area": "5 mm^2"})
    assert product.distance.min() > 2e-3 and (product.temperature == 400.0).all()
    assert len(product.friction) == 6 and product.friction == pytest.approx(0.5, rel=0.01)
    assert product.outside.all(), "millimetres a second are slower than the map"
    late = {**channels, "load": replace(channels["load"], begin=np.array(1.0))}
    apart = replace(recording, runs={"strokes": replace(recording.runs["strokes"], channels=late)})
    with pytest.raises(ConfigError, match="channels of run strokes of one rate, begin and length, found several"):
        told(believed, apart, slides={"area": "5 mm^2"})


@pytest.mark.parametrize("settings, message", [
    ({"runs": ["fourth"]}, "friction_update.runs: expected recorded runs with friction, of first, second, third"),
    ({"slides": {"area": "1 mm^2"}, "runs": ["bare"]}, "channels of run bare")])
def test_runs_without_friction_are_refused(believed, settings, message):
    recording = bench(believed[1])
    bare = replace(recording, runs={**recording.runs, "bare": Run(description="", repeat_of="")})
    with pytest.raises(ConfigError, match=message):
        told(believed, bare if "bare" in str(settings) else recording, **settings)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [3, *(pytest.param(seed, marks=pytest.mark.study) for seed in (4, 5))])
def test_the_shear_limit_of_an_independent_bench_is_within_the_stated_errors(seed, tmp_path):
    """Half-spaces, another contact solver, other cycles; the modulus is known, strength, wear and rate are not."""
    factors = worn.write(tmp_path / "worn.h5", seed, "")["factors"]
    modulus = {"youngs_modulus": f"{0.235 * factors['modulus']} GPa"}
    _, micro, known, recording = worn.rubbed(tmp_path / "worn.h5", pad=modulus)
    product = told((micro, known), recording)
    level = np.flatnonzero(product.fitted * (product.term == "level"))
    assert len(level) == 1 and not product.needed[product.term == "speed"].any()
    std = np.hypot(product.value_std, product.map_std)[level]
    assert abs(product.value[level] - np.log(factors["strength"])) < 2 * std
    unseen, mapped = (np.std(np.log(p / product.friction)) for p in (product.unseen, product.mapped))
    assert unseen < 0.07 < np.sqrt(np.mean(np.log(product.mapped / product.friction) ** 2)) and unseen <= mapped
