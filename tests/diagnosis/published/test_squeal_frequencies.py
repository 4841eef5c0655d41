"""Squeal lines: a sparse list that agrees is believed, a dense one is not."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.published.squeal_frequencies import (
    SquealLines,
    claims,
    needed_tolerance,
    rarely,
    squeal_problem,
    squeal_reasons,
    undecided,
)
from pipeline.products import ComplexModes, Lines, Recording, Run
from tests.diagnosis.solving import solved as diagnosed
from tests.views.products_for_views import filled

TOLD = fill(SquealLines, {"kind": "squeal", "run": "bench", "list": "laser", "low": "15.6 kHz", "high": "18.8 kHz",
                          "model_error": 0.001}, "diagnosis.lines")
HEARD = np.array([16600.0, 17800.0])


def recording():
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "topography", "friction")}
    lines = Lines(label=["one", "two"], frequency=HEARD, frequency_tolerance=[20.0, 20.0], level=[0, 0],
                  level_known=[0, 0], partners=[0, 0], diameters=[-1, -1], place="ring")
    return Recording(source=[], runs={"bench": Run(description="", repeat_of="", lines={"laser": lines}, **empty)})


def modes(frequency, growing=()):
    return filled(ComplexModes, operating_pressure=[1e6], operating_speed=[12.0],
                  operating_root=[2j * np.pi * np.array([*frequency, 19500.0])],
                  unstable_operating=[0] * len(growing), unstable_root=10 + 2j * np.pi * np.array(growing))


def solved(found):
    return diagnosed(squeal_problem(recording(), TOLD, found), kept=9, draws=2000)


def test_a_dense_list_meets_the_lines_and_decides_nothing():
    given = modes(np.arange(15000.0, 19400.0, 45.0))
    found = claims(recording(), TOLD, given)
    assert [found[k].effect for k in undecided(found, recording(), TOLD)] == ["flexible_disc", "falling_friction",
                                                                              "changing_load"]
    assert found[-1].match.p_value > 0.5 and solved(found).decision.verdict == "unknown"
    said = " ".join(squeal_reasons(recording(), TOLD, found, given))
    assert "a mode every 45 Hz" in said and "frequencies alone cannot decide" in said


def test_multiples_of_a_growing_mode_that_meet_both_lines_are_named():
    """Two lines of four in the band, 20 Hz wide in 3.2 kHz: rare by chance."""
    found = claims(recording(), TOLD, modes([900.0, 16000.0], growing=[1186.0]))
    multiple = next(c for c in found if c.effect == "saturated_motion")
    assert multiple.match.matched == 2 and multiple.match.p_value < 0.01
    assert "saturated_motion at contact" in [c.name for c in solved(found).decision.named]


def test_modes_at_random_are_not_believed():
    generator = np.random.default_rng(2)
    drawn = [modes(generator.uniform(15600, 18800, 30)) for _ in range(20)]
    named = [solved(claims(recording(), TOLD, given)).decision.named for given in drawn]
    assert sum(bool(n) for n in named) <= 1


def test_agreement_that_chance_gives_too_explains_nothing():
    given = modes(np.arange(15610.0, 18800.0, 200.0))
    found = claims(recording(), TOLD, given)
    assert not any(rarely(found)) and found[-1].match.p_value == pytest.approx(0.26**2, abs=0.006), "(16 * 52 / 3200)^2"


def test_the_tolerance_that_would_decide_covers_a_tenth_of_the_band_for_two_lines():
    lines = np.arange(15645.0, 18800.0, 90.0)
    assert needed_tolerance(lines, (15600.0, 18780.0), 2) == pytest.approx(4.5, abs=0.1)


def test_modes_that_end_within_the_band_are_refused():
    with pytest.raises(ConfigError, match="diagnosis.lines.high.*complex modes end"):
        claims(recording(), TOLD.model_copy(update={"high": 20000.0}), modes([900.0]))
