"""Stage modal_test on frequency responses of a disc."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.products import FrequencyResponse, Recording, ResponseFunctions, Run
from stages.modal_test import Settings, modal_test
from stages.response_functions import Settings as ResponseSettings
from stages.response_functions import response_functions
from tests.physics.modal.test_frf_identification import disc, noisy, responses

LINE = np.arange(0.0, 2500.1, 0.5)
FREQUENCY, DAMPING, SHAPE = disc()


def recorded(line=LINE, **runs):
    measured = noisy(responses(line, FREQUENCY, DAMPING, SHAPE), 0.01, np.random.default_rng(2))
    frf = {f"p{k}": FrequencyResponse(frequency=line, response=row, unit="m/s^2/N", place=f"node {k} direction 3",
                                      reference="node 1 direction 3") for k, row in enumerate(measured)}
    return Recording(source=[], runs={"hammer": Run(description="", repeat_of="", frf=frf),
                                      "stop": Run(description="", repeat_of="")} | runs)


def given(recording, **settings):
    return response_functions(recording, settings=ResponseSettings(**settings))


@pytest.fixture(scope="module")
def result():
    return modal_test(given(recorded()), settings=Settings(highest_frequency="2.2 kHz")).runs


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


def test_a_band_without_lines_is_refused():
    with pytest.raises(ConfigError, match="64 or more lines between 3000 and 2500 Hz"):
        modal_test(given(recorded()), settings=Settings(lowest_frequency="3 kHz"))


def test_a_dead_response_is_named_and_coarse_ones_are_taken():
    whole = recorded().runs["hammer"].frf
    dead = whole | {"p3": FrequencyResponse(frequency=LINE, response=0 * LINE, unit="m/s^2/N", place="", reference="")}
    with pytest.raises(ConfigError, match="responses that are not 0 all over, found p3"):
        modal_test(given(Recording(source=[], runs={"a": Run(description="", repeat_of="", frf=dead)})),
                   settings=Settings())
    coarse = modal_test(given(recorded(np.arange(0.0, 2500.1, 12.5))), settings=Settings())
    assert len(coarse.runs["hammer"].line) == 200


def test_peaks_that_are_too_narrow_for_a_lasting_force_are_marked():
    """2.4 to 3.4 Hz wide, at lines of 1 Hz."""
    test = given(recorded(np.arange(0.0, 2500.1))).tests["hammer"]
    settings = Settings(highest_frequency="2.2 kHz")
    for method, narrow in (("lasting force", [1] * 5), ("given", [0] * 5), ("blows", [0] * 5)):
        modes = modal_test(ResponseFunctions(tests={"a": replace(test, method=method)}), settings=settings).runs["a"]
        assert modes.narrow.tolist() == narrow


def test_what_windows_add_is_taken_off_the_decay_rates():
    """Responses at i w + r, as blows under exp(-r t) give them."""
    decay, natural = 3.0, 2 * np.pi * FREQUENCY
    laplace = 2j * np.pi * LINE + decay
    modal = 1.0 / (natural[:, None] ** 2 + laplace**2 + 2 * (DAMPING * natural)[:, None] * laplace)
    shown = np.einsum("mo,mf->of", SHAPE * SHAPE[:, :1], modal)
    whole = given(recorded()).tests["hammer"]
    shown = noisy(shown, 0.002, np.random.default_rng(5))
    tests = ResponseFunctions(tests={"blows": replace(whole, response=shown, decay=decay)})
    modes = modal_test(tests, settings=Settings(highest_frequency="2.2 kHz")).runs["blows"]
    assert np.all(abs(modes.damping_ratio - 1e-3) < 4 * modes.damping_ratio_std)
    np.testing.assert_allclose(modes.damping_ratio, 1e-3, rtol=0.03)
    np.testing.assert_allclose(modes.frequency, np.sort(FREQUENCY), rtol=2e-5)
    chosen = modes.chosen >= 0
    assert np.median(modes.pole_damping[chosen]) == pytest.approx(1e-3, rel=0.05)
