"""The problem of self-excited recordings, and its answer on a small bench."""

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.self_excited import pole_problem
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.small_bench import RUNS, bench, laid_out, recorded
from tests.diagnosis.solving import solved

ASKED = {"forward": "poles", "solver": False, "effects": ["falling_friction", "contact_stiffness_law", "runout"],
         "parameters": {"bodies.pin.frequency": {"spread": 0.05}, "bodies.carriage.frequency": {"spread": 0.05},
                        "bodies.pin.damping": {"spread": 0.3}, "contact.stiffness": {"spread": 0.2},
                        "friction.stiffness": {"spread": 0.2}, "friction": {"spread": 0.2}}}


def asked(hidden=None, runs=(*RUNS, "turned"), **more):
    """DiagnosisProblem of these ``runs`` and what repeats them."""
    truth = bench(hidden, corrections={"bodies.pin.frequency": 1.03, "friction": 1.1, "contact.stiffness": 0.9})
    shown = {name: one for name, one in recorded(truth).items() if name.removesuffix("_again") in runs}
    return pole_problem(bench(), shown, fill(Settings, {**ASKED, **more}, "diagnosis"), laid_out().poles)


@pytest.mark.parametrize("hidden, verdict", [
    ({}, "parameters"), ({"falling_friction": {"contact": {"rise": 0.8, "decay_speed": "0.1 m/s"}}}, "missing"),
    pytest.param({"runout": {"contact": {"amplitude": "3 um", "order": 1, "phase": "0.7 rad"}}}, "unknown",
                 marks=(pytest.mark.slow, pytest.mark.study))])
def test_what_was_hidden_is_named_and_wrong_values_are_not_physics(hidden, verdict):
    """One turn alone cannot show runout at two operating points: unknown, not named."""
    told = solved(asked(hidden), kept=2, draws=2000, starts=(-1.0, 1.0))
    assert told.decision.verdict == verdict
    assert [c.name.split(" at ")[0] for c in told.decision.named] == (list(hidden) if verdict == "missing" else [])


@pytest.mark.parametrize("more, said", [({"held_out": ["never"]}, "diagnosis.held_out"),
                                        ({"saturated_squeal": {"runs": ["never"]}}, "diagnosis.saturated_squeal.runs"),
                                        ({"parameters": {"bodies.pin.colour": {}}}, "diagnosis.parameters")])
def test_wrong_settings_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        asked(runs=("rest",), **more)
