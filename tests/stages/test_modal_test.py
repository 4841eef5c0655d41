"""Stage modal_test on frequency responses of a disc."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import FrequencyResponse, Recording, Run
from stages.modal_test import Settings, modal_test
from tests.physics.modal.test_frf_identification import disc, noisy, responses

LINE = np.arange(0.0, 2500.1, 0.5)
FREQUENCY, DAMPING, SHAPE = disc()


def recorded(line=LINE, **runs):
    measured = noisy(responses(line, FREQUENCY, DAMPING, SHAPE), 0.01, np.random.default_rng(2))
    frf = {f"p{k}": FrequencyResponse(frequency=line, response=row, unit="m/s^2/N", place=f"node {k} direction 3",
                                      reference="node 1 direction 3") for k, row in enumerate(measured)}
    return Recording(source=[], runs={"hammer": Run(description="", repeat_of="", frf=frf),
                                      "stop": Run(description="", repeat_of="")} | runs)


@pytest.fixture(scope="module")
def result():
    return modal_test(recorded(), settings=Settings(highest_frequency="2.2 kHz")).runs


def test_modes_of_all_parts_of_the_band_once(result):
    assert list(result) == ["hammer"]
    modes = result["hammer"]
    np.testing.assert_allclose(modes.frequency, np.sort(FREQUENCY), rtol=1e-5)
    assert np.all(abs(modes.frequency - np.sort(FREQUENCY)) < 4 * modes.frequency_std)
    np.testing.assert_allclose(modes.damping_ratio, 1e-3, rtol=0.03)
    assert str(modes.place[3]) == "node 3 direction 3" and modes.shape.shape == (5, 12)


def test_doublets_are_pairs_and_the_single_mode_is_none(result):
    assert result["hammer"].partner.tolist() == [1, 0, 2, 4, 3]


def test_what_is_left_is_the_noise(result):
    modes = result["hammer"]
    assert np.median(modes.noise) == pytest.approx(0.01, rel=0.15)
    near = abs(modes.line - 1450) < 5
    np.testing.assert_allclose(modes.fitted[near], modes.measured[near], rtol=0.05)
    assert modes.line[0] == 0.5 and modes.line[-1] == 2200
    assert set(modes.chosen) == {-1, 0, 1, 2, 3, 4} or set(modes.chosen) == {-1, *range(5)} - {1}
    assert np.all(np.diag(modes.likeness) == pytest.approx(1)) and modes.likeness[0, 1] < 0.1


@pytest.mark.parametrize("settings, told", [
    ({"runs": ["hamer"]}, "modal_test.runs: expected some of hammer, stop, found hamer"),
    ({"runs": ["stop"]}, "a run with frequency responses, found none"),
    ({"lowest_frequency": "3 kHz"}, "64 or more lines between 3000 and 2500 Hz")])
def test_what_holds_no_responses_is_refused(settings, told):
    with pytest.raises(ConfigError, match=told):
        modal_test(recorded(), settings=Settings(**settings))


def test_responses_on_unlike_axes_are_refused():
    other = FrequencyResponse(frequency=np.arange(100.0), response=np.ones(100), unit="1", place="", reference="")
    mixed = Run(description="", repeat_of="", frf=recorded().runs["hammer"].frf | {"other": other})
    with pytest.raises(ConfigError, match="frequency responses on one frequency axis, found 2 axes"):
        modal_test(Recording(source=[], runs={"mixed": mixed}), settings=Settings())


def test_a_dead_response_is_named_and_coarse_ones_are_taken():
    whole = recorded().runs["hammer"].frf
    dead = whole | {"p3": FrequencyResponse(frequency=LINE, response=0 * LINE, unit="m/s^2/N", place="", reference="")}
    with pytest.raises(ConfigError, match="responses that are not 0 all over, found p3"):
        modal_test(Recording(source=[], runs={"a": Run(description="", repeat_of="", frf=dead)}), settings=Settings())
    coarse = modal_test(recorded(np.arange(0.0, 2500.1, 12.5)), settings=Settings())
    assert len(coarse.runs["hammer"].line) == 200
