"""Lists as features: nothing, one factor, one alternative, two alternatives."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.published.frequency_lists import FACTOR, Alternative, Features, lines_of, list_problem
from pipeline.inference.priors import LogNormal, Parameter
from pipeline.products import Recording, Run
from tests.diagnosis.solving import solved as diagnosed

MODEL = np.array([200.0, 450.0, 700.0, 1100.0, 1600.0, 2300.0])
NAMES = [f"row_{k}" for k in range(len(MODEL))]
WRONG = Alternative("mis_paired", "row_2", {"row_2": np.array([900.0])}, "sensor")
RISING = Alternative("rise", "modes", {n: np.array([f * (1 - 0.2 * f / 2300)])
                                        for n, f in zip(NAMES, MODEL, strict=True)})


def asked(measured, alternatives=(WRONG, RISING), factor=True):
    features = {n: Features("frequency", "Hz", [m], [0.01 * m]) for n, m in zip(NAMES, measured, strict=True)}
    free = (Parameter(FACTOR, "1", 1.0, LogNormal(1.0, 0.05)),) if factor else ()
    return list_problem(features, {n: np.array([f]) for n, f in zip(NAMES, MODEL, strict=True)}, alternatives, free)


def solved(measured, **options):
    return diagnosed(asked(measured, **options), kept=8, draws=2000)


def scattered(measured, seed=0):
    return measured * (1 + 0.01 * np.random.default_rng(seed).standard_normal(len(measured)))


def test_nothing_wrong_is_consistent():
    assert solved(scattered(MODEL)).decision.verdict == "consistent"
    assert solved(scattered(MODEL), factor=False).decision.verdict == "consistent"


def test_one_factor_on_all_is_a_wrong_value():
    found = solved(scattered(1.06 * MODEL))
    assert found.decision.verdict == "parameters" and found.null.values[FACTOR] == pytest.approx(1.06, abs=0.015)


def test_the_list_that_differs_is_located_and_its_alternative_named():
    measured = scattered(np.where(MODEL == 700.0, 900.0, MODEL))
    found = solved(measured)
    assert [c.name for c in found.decision.named] == ["mis_paired at row_2"] and found.decision.verdict == "sensor"
    place = asked(measured).locator.located(found)["run"][0]
    assert place.significant() == ("row_2",)


def test_a_second_alternative_is_named_beside_the_first():
    both = RISING.shown["row_2"] + 200.0
    measured = scattered(np.array([both[0] if n == "row_2" else RISING.shown[n][0] for n in NAMES]))
    found = solved(measured)
    assert {found.nominal.effects[0][0], found.decision.named[0].name.split()[0]} == {"mis_paired", "rise"}


def test_what_no_alternative_explains_is_unknown():
    assert solved(np.where(MODEL == 1100.0, 1300.0, MODEL)).decision.verdict == "unknown"


def test_lists_that_are_not_there_are_refused():
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "lines", "topography", "friction")}
    recording = Recording(source=[], runs={"bench": Run(description="", repeat_of="", **empty)})
    with pytest.raises(ConfigError, match="runs among bench, found test"):
        lines_of(recording, "test", "disc")
    with pytest.raises(ConfigError, match="lists of run bench: none"):
        lines_of(recording, "bench", "disc")
