"""Names of parameters and hypotheses."""

import pytest

from pipeline.diagnosis.problem import label, nominal, parameter_name, split_name
from pipeline.inference.priors import Normal, Parameter


@pytest.mark.parametrize("parts", [("falling_friction", "contact", "rise"), ("coulomb", "a.b", "force")])
def test_names_can_be_taken_apart(parts):
    assert split_name(parameter_name(*parts)) == parts


def test_nominal_names_have_no_effect():
    assert split_name("joints.mount.stiffness") == ("", "", "")
    assert nominal([Parameter("a", "1", 1.0, Normal(1.0, 0.1))]).effects == ()


def test_a_pair_is_labelled_by_both():
    assert label((("runout", "disc"), ("coulomb", "arm"))) == "runout at disc + coulomb at arm"
