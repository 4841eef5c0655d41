"""The block of effects: from YAML to terms, and what it refuses."""

import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import (
    Settings,
    check_locations,
    conditions,
    parameters,
    rubbing_with_effects,
    terms,
    with_effects,
)
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import ASPERITIES
from pipeline.physics.friction.state_variables import Film
from tests.diagnosis.small_rig import HIDDEN, effects, laid_out, model
from tests.effects import rough_pair


def test_every_effect_is_a_key_with_its_parameters():
    assert set(Settings.model_fields) == {e.name for e in CATALOGUE} | {"conditions"}
    term, = terms(effects({"moving_base": {"mount": {p.name: f"1 {p.unit}" if p.unit != "1" else 1
                                                     for p in parameters(next(e for e in CATALOGUE
                                                                              if e.name == "moving_base"))}}}))
    assert term.effect.name == "moving_base" and term.location == "mount"


def test_values_arrive_in_si():
    term, = terms(effects(HIDDEN))
    assert term.values == {"coefficient": 1.5e4}


def test_an_effect_at_its_null_is_none():
    assert terms(effects({"moving_base": {"mount": {"compliance": "0 m/N", "frequency": "9 Hz"}}})) == ()


def test_conditions_are_those_that_effects_ask_for():
    assert conditions(effects({"conditions": {"humidity": 0.8}})) == {"humidity": 0.8}
    assert conditions(effects({})) == conditions(None) == {}
    with pytest.raises(ConfigError, match="did you mean 'humidity'"):
        fill(Settings, {"conditions": {"humidty": 0.8}}, "case.yaml: effects")


def test_no_effects_leave_the_bench_alone():
    bench = benches.built(model(), laid_out())
    assert with_effects(bench, None) is bench and with_effects(bench, effects({})) is bench


@pytest.mark.parametrize("given, said", [
    ({"cubic_stifness": {"mount": {"coefficient": "1 N/m^3"}}}, "did you mean 'cubic_stiffness'"),
    ({"cubic_stiffness": {"mount": {"coefficient": "1 N/m"}}}, "N/m\\^3"),
    ({"cubic_stiffness": {"mount": {}}}, "coefficient")])
def test_wrong_blocks_are_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        fill(Settings, given, "case.yaml: effects")


def test_a_wrong_place_and_a_sensor_without_recordings_are_refused():
    bench = benches.built(model(), laid_out())
    with pytest.raises(ConfigError, match="mount"):
        with_effects(bench, effects({"cubic_stiffness": {"mont": {"coefficient": "1 N/m^3"}}}))
    with pytest.raises(ConfigError, match="sensor"):
        with_effects(bench, effects({"sensor_gain": {"x": {"error": 0.1}}}), channels=False)


FILM = {"third_body_film": {ASPERITIES: {"gain": 0.3, "distance": "1 mm", "pressure": "1 MPa"}}}


def test_terms_at_asperities_go_to_the_rough_pair_alone():
    bench = benches.built(model(), laid_out())
    assert with_effects(bench, effects(FILM)) is bench
    found = rubbing_with_effects(rough_pair.rubbing(), effects({**HIDDEN, **FILM}))
    assert found.shearing.film == Film(0.3, 1e-3, 1e6)
    assert rubbing_with_effects(rough_pair.rubbing(), effects(HIDDEN)) == rough_pair.rubbing()


@pytest.mark.parametrize("given, chain, said", [
    (FILM, ("effects", "bench"), "third_body_film.asperities: expected a chain with micro_friction"),
    (HIDDEN, ("effects", "micro_friction"), "expected a chain with complex_modes or multibody or transient")])
def test_a_place_that_no_stage_of_the_chain_has_is_refused(given, chain, said):
    sections = {**dict.fromkeys(chain), "effects": fill(Settings, given, "effects")}
    with pytest.raises(ConfigError, match=said):
        check_locations(sections)
    check_locations({**sections, "micro_friction": None, "bench": None})
