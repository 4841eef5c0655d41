"""Cases that a modal test completes."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from pipeline.case_models.bodies.updated_case import completed
from pipeline.contract.case import CaseText
from tests.views import products_for_views as small

CASE = CaseText("disc", {"chain": "model_update", "title": "A disc", "model_update": {
    "body": "disc", "disc": {"density": "7100 kg/m^3"},
    "values": {"young": {"spread": 0.1}, "disc.poisson": {"spread": 0.1}, "pad.lining_density": {"spread": 0.02}}}})


def test_values_are_stated_as_measured_and_handed_on_as_priors():
    product = replace(small.model_update(), clear=np.ones(4, int), correlation=np.array([[1, 0.3], [0.3, 1]]))
    section = yaml.safe_load(completed(product, CASE)["disc_updated.yaml"])["model_update"]
    assert section["disc"]["young"] == {"value": "1.283e+11 Pa", "origin": "measured",
                                        "source": "modal test disc, 0.4%"}
    assert section["disc"]["density"] == "7100 kg/m^3" and section["body"] == "disc"
    assert section["values"] == {"pad.lining_density": {"spread": 0.02}, "disc.young": {"spread": 0.004},
                                 "disc.poisson": {"spread": 0.09, "correlation": {"disc.young": 0.3}}}
    assert CASE.document["model_update"]["values"]["young"] == {"spread": 0.1}


def test_a_brake_with_them_is_a_case_of_its_own():
    product = replace(small.model_update(), clear=np.ones(4, int))
    brake = yaml.safe_load(completed(product, CASE)["disc_brake.yaml"])
    assert brake["chain"] == "brake_squeal" and brake["title"] == "A disc, updated"
    assert list(brake["structure"]) == ["disc"] and brake["structure"]["disc"]["young"]["origin"] == "measured"


@pytest.mark.parametrize("clear", [[1, 1, 0, 0], [0, 0, 0, 1]])
def test_a_test_of_something_else_completes_nothing(clear):
    assert completed(replace(small.model_update(), clear=np.array(clear)), CASE) == {}


def test_without_a_case_there_is_nothing_to_complete():
    assert completed(replace(small.model_update(), clear=np.ones(4, int)), None) == {}
