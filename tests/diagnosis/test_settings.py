"""Priors from the section ``diagnosis``."""

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.settings import Prior, parameter
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Uniform


def of(given, value=2.0, unit="N"):
    return parameter("p", unit, value, fill(Prior, given, "prior"), "diagnosis.parameters.p")


@pytest.mark.parametrize("given, prior", [
    ({"spread": 0.3}, LogNormal(2.0, 0.3)), ({"prior": "normal", "std": "3 kN"}, Normal(2.0, 3000.0)),
    ({"prior": "half_normal", "std": "3 N"}, HalfNormal(3.0)),
    ({"prior": "uniform", "low": "1 N", "high": "5 N"}, Uniform(1.0, 5.0))])
def test_families(given, prior):
    assert of(given).prior == prior and of(given).nominal == 2.0 and of(given).null is None


@pytest.mark.parametrize("given, value, said", [
    ({}, 0.0, "not\\s+positive"), ({"prior": "normal"}, 1.0, "p.std"),
    ({"prior": "uniform", "low": "3 N", "high": "5 N"}, 1.0, "between 3 and 5"),
    ({"prior": "normal", "std": "3 kg"}, 1.0, "in N")])
def test_what_is_no_prior_is_refused(given, value, said):
    with pytest.raises(ConfigError, match=said):
        of(given, value)
