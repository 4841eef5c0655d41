"""The completed case: values of the best draw in the document of the case, and no case where nothing is named."""

import copy
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import documents
from pipeline.contract.case import CaseText
from pipeline.contract.units import to_si
from pipeline.diagnosis.published.completed_case import chosen, companions, completed
from tests.views import products_for_views as small

LUMPED = {
    "chain": "lumped_squeal", "title": "Bench",
    "lumped": {"springs": {"abutment_a": {"along": {"pad.x": 1}, "stiffness": "10 N/mm", "damping": "2 N s/m"},
                           "wave": {"along": {"disc.x": 1}, "stiffness": {"value": "5 kN/m", "origin": "measured"}}},
               "contacts": {"lining": {"normal": {"pad.z": 1}, "stiffness": "4 kN/m", "lever": "0.2 m"}}},
    "complex_modes": {"speeds": ["4 rad/s"], "friction": 0.5, "damping_speed": "10 m/s"},
    "recording": {}, "line_evidence": {"hypotheses": {}}}
#: of the best draw
DRAWN = {"joint_stiffness:abutment": 1.5, "joint_loss": 2.0, "contact_stiffness": 0.8, "damping_speed": 1.2,
         "friction": 0.03, "friction_over_speed": 0.01, "falling friction": 0.05, "growth by changing load": 0.0}


def named(values, verdict="flexible"):
    """Of a LineEvidence what the case is completed from: the best hypothesis has these values in its best draw."""
    base = small.line_evidence()
    value, weight = np.ones((4, 40, len(values))), np.full((4, 40), 0.01)
    value[2, 7], weight[2, 7] = list(values.values()), 0.61
    return SimpleNamespace(hypothesis=base.hypothesis, disc=base.disc, evidence=base.evidence, verdict=verdict,
                           column=np.array(list(values)), value=value, weight=weight, speed=np.array([4.0, 6.0]))


def number(stated, unit):
    assert stated["origin"] == "inferred" and "most probable draw of flexible_less_damping" in stated["source"]
    return to_si(stated["value"], unit, "")


def test_the_best_draw_is_that_of_the_best_flexible_hypothesis():
    product = named(DRAWN)
    assert chosen(product.disc, product.evidence, product.weight) == (2, 7)


def test_a_lumped_case_gets_the_values_of_the_draw_and_nothing_that_asks_what_was_heard():
    before = copy.deepcopy(LUMPED)
    made = completed(named(DRAWN), CaseText("bench", LUMPED))
    assert before == LUMPED and made["chain"] == "lumped_modes" and not {"recording", "line_evidence"} & set(made)
    springs, contact = made["lumped"]["springs"], made["lumped"]["contacts"]["lining"]
    assert number(springs["abutment_a"]["stiffness"], "N/m") == pytest.approx(15e3)
    assert number(springs["abutment_a"]["damping"], "N s/m") == pytest.approx(2 * 1.5 * 2)
    assert springs["wave"]["stiffness"]["origin"] == "measured"
    assert number(contact["stiffness"], "N/m") == pytest.approx(3200)
    assert number(made["complex_modes"]["damping_speed"], "m/s") == pytest.approx(12)


@pytest.mark.exact
def test_friction_has_the_level_and_the_slope_of_the_draw_at_the_mean_speed():
    """mu = 0.5 + 0.03 + (0.01 - 0.05) ln(v), v = 5 rad/s at 0.2 m."""
    modes = completed(named(DRAWN), CaseText("bench", LUMPED))["complex_modes"]
    last, rest = number(modes["friction"], "1"), number(modes["friction_at_rest"], "1")
    decay, speed = number(modes["decay_speed"], "m/s"), 5 * 0.2
    more = (rest - last) * np.exp(-speed / decay)
    assert last + more == pytest.approx(0.53 - 0.04 * np.log(speed), rel=1e-12)
    assert -more * speed / decay == pytest.approx(-0.04, rel=1e-9)


def test_a_brake_of_finite_elements_gets_what_its_case_can_state():
    document = {"chain": "disc_squeal", "structure": {
        "joints": {"finger_stiffness": "400 MN/m", "finger_loss_factor": 0.1, "abutment_stiffness": "50 MN/m"},
        "pad": {"lining_young_normal": {"value": "1.5 GPa", "origin": "assumed"}, "lining_loss_factor": 0.03},
        "disc": {"loss_factor": 0.002}}, "complex_modes": {"damping_speed": "1 m/s"}, "line_evidence": {}}
    drawn = {"joint_stiffness:finger": 0.9, "lining_stiffness": 1.1, "body_loss": 0.5, "joint_loss": 2.0,
             "contact_stiffness": 1.3, "friction": -0.02}
    made = completed(named(drawn), CaseText("brake", document))
    assert made["chain"] == "brake_squeal"
    joints, pad = made["structure"]["joints"], made["structure"]["pad"]
    assert number(joints["finger_stiffness"], "N/m") == pytest.approx(360e6)
    assert joints["abutment_stiffness"] == "50 MN/m"
    assert number(joints["finger_loss_factor"], "1") == pytest.approx(0.2)
    assert number(pad["lining_young_normal"], "Pa") == pytest.approx(1.65e9)
    assert number(pad["lining_loss_factor"], "1") == pytest.approx(0.015)
    assert number(made["structure"]["disc"]["loss_factor"], "1") == pytest.approx(0.001)
    assert "contact_stiffness 1.3; friction higher by -0.02" in made["description"]


@pytest.mark.parametrize("verdict", ["undecided", "rigid", "none"])
def test_no_case_is_written_where_the_flexible_disc_is_not_named(verdict):
    assert companions(named(DRAWN, verdict), CaseText("bench", LUMPED)) == {}
    (name, text), = companions(named(DRAWN), CaseText("bench", LUMPED)).items()
    assert name == "bench_two_way.yaml" and "flexible in the loop" in text
    assert documents.yaml_text(completed(named(DRAWN), CaseText("bench", LUMPED))) == text
