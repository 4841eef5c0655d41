"""verdict.json says what the products say, in plain JSON."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.pad_motion import chapter
from pipeline.views.pages.summary import verdict
from pipeline.views.pages.verdict_file import SCHEMA, verdict_text
from tests.views import products_for_views as small
from tests.views.countermeasures_for_views import countermeasures


def written(products):
    return json.loads(verdict_text(verdict(products, ()), products))


def test_modes_convergence_and_headline_are_there():
    modes, refined = small.complex_modes(), small.convergence()
    told = written({"complex_modes": modes, "convergence": refined})
    assert told["schema"] == SCHEMA and told["squeal_can_start"] is True and told["probability"] is None
    assert told["headline"].startswith("Squeal can start") and told["warnings"] == []
    first = told["unstable_modes"][0]
    assert first["frequency"] == pytest.approx(modes.unstable_root[0].imag / (2 * np.pi))
    assert first["growth_rate"] == modes.unstable_root[0].real and first["damping_ratio"] < 0
    assert (first["nodal_diameters_in_plane"], first["nodal_diameters_out_of_plane"]) == (2, 5)
    assert first["nodal_diameters"] == 5 and first["bodies"]["disc"] == 0.7
    assert set(first["growth_by_term"]) == set(map(str, modes.growth_term)) and first["finite_elements"] is None
    assert told["convergence"]["converged"] and told["convergence"]["refined"] == list(refined.refinement)


def test_sensitivities_are_told_by_value_and_unit():
    told = written({"complex_modes": small.complex_modes(), "sensitivities": small.sensitivities()})["sensitivities"]
    assert [mode["mode"] for mode in told["modes"]] == [0, 2]
    assert told["modes"][0]["growth_per_standard_deviation"]["structure.joints.shim_stiffness"] == 120.0
    assert told["modes"][0]["growth_per_unit"]["friction"] == pytest.approx(30 / 0.012)
    assert told["units"]["structure.disc.density"] == "kg/m^3"
    assert told["tried"][0] == {"value": "friction", "now": 0.6, "then": 0.42, "mode": 0, "growth_rate": -3.0}
    assert written({"complex_modes": small.complex_modes()})["sensitivities"] is None


def test_modes_solved_for_on_the_full_matrices_state_residual_and_distance():
    modes = small.complex_modes()
    residual = np.full(len(modes.unstable_root), -1.0)
    residual[0] = 3e-7
    moved = replace(modes, unstable_residual=residual, unstable_reduced=modes.unstable_root * (1 + 1e-4) + 5)
    first, second = written({"complex_modes": moved})["unstable_modes"][:2]
    root, reduced = moved.unstable_root[0], moved.unstable_reduced[0]
    assert second["finite_elements"] is None and first["finite_elements"] == {
        "residual": 3e-7, "reduced_frequency_change": pytest.approx(reduced.imag / root.imag - 1),
        "reduced_growth_change": pytest.approx(reduced.real - root.real)}


def test_every_mode_says_what_damps_it_and_those_followed_where_they_come_from():
    first, *others = written({"complex_modes": small.complex_modes()})["unstable_modes"]
    assert first["damping"] == {"bodies": {"disc": -2.6, "pad_inner": -30.0}, "joints": {"abutment": -10.0}}
    assert first["critical_friction"] == 0.4 and first["mechanism"] == "mode coupling" and first["same_mode_as"] == 0
    assert first["pair"] == [{"frequency": pytest.approx(16600), "body": "disc", "nodal_diameters": 5},
                             {"frequency": pytest.approx(16400), "body": "pad_inner", "nodal_diameters": 5}]
    assert others and all(mode["pair"] is mode["critical_friction"] is mode["mechanism"] is None for mode in others)
    assert {mode["same_mode_as"] for mode in others} == {0}


def test_heard_lines_are_there_where_they_were_weighed():
    modes, weighed = small.complex_modes(), small.line_evidence()
    assert written({"complex_modes": modes})["heard_lines"] is None
    told = written({"complex_modes": modes, "line_evidence": weighed})["heard_lines"]
    assert told["verdict"] == "flexible" and told["lines"] == [16600, 17800]
    assert (told["ln_factor_flexible_against_rigid"], told["standard_error"]) == (4.3, 0.5)
    assert told["ln_factors"]["flexible_less_damping"] == {"value": 5.0, "standard_error": 0.58}


def test_the_simulation_is_there_where_there_was_one():
    modes, cycle = small.complex_modes(), small.limit_cycle()
    told = written({"complex_modes": modes, "limit_cycle": cycle})["transient"]
    assert [each["simulated_growth_rate"] for each in told["onset"]] == [111, 361, 209]
    last = told["limit_cycles"][1]
    assert last["pressure"] == 3e6 and last["settled"] is True and last["frequency"] == 8050
    assert last["velocity"] == pytest.approx(np.sqrt((cycle.level[1, :, -1] ** 2).mean()))
    assert told["changes"] == {"step": {"level_db": 0.05, "frequency": 1e-4}}
    assert written({"complex_modes": modes})["transient"] is None


def test_what_is_not_converged_or_not_examined_is_a_warning():
    modes = small.complex_modes()
    doubtful = written({"complex_modes": modes, "convergence": small.convergence(converged=False)})
    assert doubtful["warnings"][0].startswith("Not converged") and not doubtful["convergence"]["converged"]
    assert not doubtful["convergence"]["modes"][1]["found"]
    assert doubtful["convergence"]["growth_change_by"]["bracket_mesh"] == [-110, 0]
    alone = written({"complex_modes": modes})
    assert alone["warnings"] == ["convergence was not examined"] and alone["convergence"] is None


def test_contact_force_outside_the_computed_pressures_is_a_warning():
    modes, law = small.complex_modes(), small.friction_map()
    pressure = np.full((9, 12), 2e6)
    pressure[:, 0] = 2 * law.computed_pressure.max()
    products = {"complex_modes": replace(modes, operating_force=pressure * 1e-4), "friction_map": law,
                "reduced_model": SimpleNamespace(contact_area=np.full(12, 1e-4))}
    share = pressure[0, 0] / pressure[0].sum()
    said = written(products)["warnings"][-1]
    assert said.startswith(f"Up to {100 * share:.2g}") and "--set micro_friction.pressures=" in said
    inside = replace(modes, operating_force=np.full((9, 12), 2e6 * 1e-4))
    assert written({**products, "complex_modes": inside})["warnings"] == ["convergence was not examined"]


def test_probabilities_are_there_with_their_intervals():
    product = small.probability()
    told = written({"complex_modes": small.complex_modes(), "probability": product})["probability"]
    assert told["value"] == product.overall and told["interval"] == list(product.overall_interval)
    assert told["draws"] == 60 and [p["value"] for p in told["operating_points"]] == list(product.probability)
    assert told["operating_points"][-1]["pressure"] == 3e6 and told["sensitivity"]["friction"] == 0.7


def test_cases_without_complex_modes_have_a_verdict_too():
    told = written({})
    assert told["squeal_can_start"] is None and told["unstable_modes"] == [] and told["warnings"] == []


def test_an_open_energy_balance_of_the_pads_is_a_warning_wherever_it_is_told():
    """None up to 1 %."""
    closed = small.multibody()
    open_at_one = replace(closed, imbalance=np.append(np.full(8, 0.009), 0.023))
    for motion, warned in ((replace(closed, imbalance=np.full(9, 0.01)), False), (open_at_one, True)):
        products = {"complex_modes": small.complex_modes(), "convergence": small.convergence(), "multibody": motion}
        warnings = written(products)["warnings"]
        answers = " ".join(text for _, text in verdict(products, ()).answers)
        text = chapter(motion, Look(60)).conclude
        if warned:
            assert len(warnings) == 1 and "open by up to 2.3\u202f% of the energy exchanged" in warnings[0]
            assert "at 1 of 9 operating points" in warnings[0] and warnings[0] in answers and warnings[0] in text
        else:
            assert warnings == [] and "energy balance" not in answers and "closes within 1\u202f%" in text


def test_countermeasures_are_there_by_name():
    given = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    assert written(given)["countermeasures"] is None
    told = written({**given, "countermeasures": countermeasures()})["countermeasures"]
    assert told["best"] == "shim" and told["variants"]["shim"]["modes"] == {"gone": 2, "weaker": 2}
    assert told["variants"]["shim"]["probability"]["change"] == -0.3
    assert told["variants"]["shorter_lining"]["costs"] == {"mass": -0.05}
    assert written({**given, "countermeasures": countermeasures(draws=0)})["countermeasures"]["variants"]["shim"][
        "probability"] is None
