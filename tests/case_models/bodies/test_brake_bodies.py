"""Settings of the bodies of a brake: units, and what is refused."""

import pytest

from pipeline.case_models.bodies.brake_bodies import Caliper, Disc, Pad, Piston
from pipeline.case_models.bodies.brake_joints import PressedPads
from pipeline.contract.settings import ConfigError, fill


def test_quantities_are_read_in_their_units():
    disc = fill(Disc, {"young": "110 GPa", "ring_thickness": "0.9 cm"}, "structure.disc")
    assert (disc.young, disc.ring_thickness) == pytest.approx((110e9, 9e-3))
    assert fill(Piston, {"fluid": {"line_length": "80 cm"}}, "structure.piston").fluid.line_length == pytest.approx(0.8)


@pytest.mark.parametrize(("body", "given", "said"), [
    (Disc, {"young": "-1 GPa"}, "structure.young"), (Pad, {"angle": "200 deg"}, "structure.angle"),
    (Caliper, {"thickness": "1 mm"}, "structure.thickness: unknown key"),
    (Disc, {"poisson": 0.5}, "structure.poisson")])
def test_what_no_body_can_have_is_refused(body, given, said):
    with pytest.raises(ConfigError, match=said):
        fill(body, given, "structure")


@pytest.mark.parametrize("section", [Disc, Pad, PressedPads])
def test_what_has_no_effect_without_another_setting_is_a_setting_itself_and_the_other_is_off_by_default(section):
    for other, names in section.only_with.items():
        assert {other, *names} <= set(section.model_fields) and not getattr(section(), other)
