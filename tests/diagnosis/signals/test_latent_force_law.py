"""The latent force as a law: coefficients come back, it predicts what no effect explains, and only when asked."""

from functools import cache

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.files import as_json
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.forward_model import shown
from pipeline.diagnosis.signals.latent_force import LatentRun
from pipeline.diagnosis.signals.latent_force_law import LABEL, LatentLaw, regressed
from pipeline.inference.search.gp_latent_force import Dependence
from tests.case_models.test_force_balance import BALANCED
from tests.diagnosis.small_rig import FINE, HIDDEN, NOISE, laid_out, model, recording
from tests.diagnosis.solving import solved

TIME = np.linspace(0, 20, 4001)
X, V = 1e-2 * np.sin(3 * TIME) + 4e-3 * np.cos(7.1 * TIME), 3e-2 * np.cos(3 * TIME) - 2.84e-2 * np.sin(7.1 * TIME)
ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.2}},
         "held_out": ["level_3"], "draws": 2000, "effects": ["attached_mass", "sensor_delay"], "solver": False}


def law(force, *clear):
    follows = [(Dependence(n, 0.5, 0.001 if n in clear else 0.5, np.zeros(1), np.zeros(1)), "")
               for n in ("displacement", "velocity", "angle of the drive", "time")]
    return regressed([LatentRun(TIME, force, np.ones(len(TIME)), X, V, 5 * TIME)], follows)


@pytest.mark.exact
def test_coefficients_come_back_of_what_is_followed():
    force = 0.2 - 30 * X - 4e4 * X**3 - 2 * V - 0.5 * np.sign(V) + 0.1 * np.cos(10 * TIME - 0.7)
    found = law(force, "displacement", "velocity", "angle of the drive")
    wanted = {"constant": 0.2, "x": -30, "x^3": -4e4, "v": -2, "sign of v": -0.5, "cos 2 angle": 0.1 * np.cos(0.7),
              "sin 2 angle": 0.1 * np.sin(0.7)}
    assert {t: found.coefficient[t] for t in wanted} == pytest.approx(wanted, rel=1e-6) and found.share > 1 - 1e-9
    assert set(law(force, "velocity").coefficient) <= {"constant", "v", "|v| v", "sign of v"}
    assert found.unit("x^3") == "N/m^3" and found.unit("sign of v") == found.unit("cos 2 angle") == "N"


def test_what_is_followed_by_nothing_is_no_law_and_friction_never_drives():
    assert law(X) is None and law(X, "time") is None
    driving = law(0.5 * np.sign(V), "velocity")
    assert "sign of v" not in driving.coefficient and driving.coefficient.get("|v| v", 0.0) <= 0


@pytest.mark.exact
def test_as_elements_it_is_the_force_that_was_hidden():
    """-15000 x^3, as an element, is the hidden cubic spring of the rig bit for bit."""
    bench = benches.built(model(), laid_out(step=FINE))
    one = recorded(recording(HIDDEN, noise=0.0), laid_out())["level_3"]
    told = LatentLaw({"constant": 0.0, "x": 0.0, "x^2": 0.0, "x^3": -15000.0}, {}, 1.0, (1.0, 1.0))
    row, *_ = bench.joint("mount")
    np.testing.assert_allclose(shown(bench.with_elements(*told.elements(bench, row)), one.run, one.channels),
                               one.samples, atol=1e-9)


@cache
def posed(forward, predict):
    """DiagnosisProblem of a cubic spring that the weighed effects lack."""
    settings = laid_out(**(BALANCED if forward is force_balance_problem else {}))
    noise = {"force on block": "0.2 N"} if forward is force_balance_problem else {"x": f"{NOISE} m"}
    section = fill(Settings, {**ASKED, "noise": {"std": noise}, "latent_force": {"predict": predict}}, "d")
    runs = recorded(recording(HIDDEN, (2.0, 9.0, 7.0), 1e-5 if forward is force_balance_problem else NOISE), settings)
    whole = benches.built(model(), settings)
    equation = [settings.equation] if forward is force_balance_problem else []
    return forward(whole, runs, section, *equation)


@cache
def answered(forward):
    """Its Diagnosis, which does not depend on what the latent force is used for."""
    return solved(posed(forward, False), kept=2)


def told(forward, predict):
    """Its product."""
    return product(posed(forward, predict), answered(forward))


@pytest.mark.parametrize("forward", [forced_problem, force_balance_problem])
def test_held_out_runs_are_predicted_where_asked_and_labelled(forward):
    found = told(forward, True)
    assert found.verdict == "unknown" and LABEL in found.latent_use.item()
    written = as_json(found)["fit"]["held_out"]
    before, extra = written["recalibrated"], written["with_latent_force"]
    assert extra["label"] == LABEL and extra["by_run"].keys() == {"level_3"} and extra["value"] < 0.03 * before
    assert extra["value"] < 1.05 * written["noise_floor"]
    assert "not converged" not in found.latent_use.item()
    cubic, = (t["value"] for t in extra["force"] if t["term"] == "x^3")
    assert cubic == pytest.approx(-15000, rel=0.02)
    assert "with_latent_force" not in as_json(found)["fit"]["training"]


@pytest.mark.parametrize("forward", [forced_problem, force_balance_problem])
def test_nothing_is_predicted_with_it_unless_asked(forward):
    found = told(forward, False)
    assert found.verdict == "unknown" and not found.latent_predicted and not found.latent_use.item()
    assert "with_latent_force" not in as_json(found)["fit"]["held_out"]
