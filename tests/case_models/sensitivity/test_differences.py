"""Settings that are raised and lowered."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.sensitivity.differences import (
    Difference,
    by_differences,
    check_differences,
    raised_and_lowered,
)
from pipeline.contract import ConfigError, Quantity, Section, option


class Structure(Section):
    ring_thickness: Quantity("m", gt=0) = option("8 mm", "thickness")
    layers: int = option(2, "layers")
    ratio: float = option(0.25, "ratio")


def sections(*names):
    found = [Difference(setting=name, variation=0.01) for name in names]
    return {"structure": Structure(), "complex_modes": Structure(), "sensitivities": SimpleNamespace(differences=found)}


@pytest.mark.parametrize(("names", "message"), [
    (["structure.layers"], "structure.ring_thickness"), (["structure.ring_thicknes"], "structure.ring_thickness"),
    (["complex_modes.ratio"], "reduced_model"), (["ring_thickness"], "reduced_model"),
    (["structure.ratio", "structure.ratio"], "each setting once")])
def test_what_is_no_number_of_an_earlier_stage_is_refused(names, message):
    with pytest.raises(ConfigError, match=message):
        check_differences(sections(*names), "sensitivities.differences")


def test_a_quantity_is_written_with_its_unit():
    changes = raised_and_lowered(sections("structure.ring_thickness", "structure.ratio"))
    assert list(changes) == ["structure.ring_thickness.more", "structure.ring_thickness.less", "structure.ratio.more",
                             "structure.ratio.less"]
    assert changes["structure.ring_thickness.more"]["structure.ring_thickness"] == f"{0.008 * 1.01!r} m"
    assert changes["structure.ratio.less"]["structure.ratio"] == 0.25 * 0.99
    assert changes["structure.ratio.less"]["complex_modes.followed"] == 0


def test_derivatives_are_central_differences_and_lost_modes_are_told():
    """Roots that change by 3 % of the value squared on top of 500 1/s per value; a mode that ends is not known."""
    roots = np.array([[100 + 6000j], [50 + 9000j]])
    modes = SimpleNamespace(unstable_operating=np.array([0, 1]), unstable_reduced=roots[:, 0])
    more = SimpleNamespace(operating_root=roots + np.array([[5.0 + 0.2], [0.0]]))
    less = SimpleNamespace(operating_root=np.array([[100 - 5.0 + 0.2 + 6000j], [50 + 12000j]]))
    card = SimpleNamespace(settings={"structure": {"ring_thickness": 0.008}},
                           units={"structure": {"ring_thickness": "m"}})
    table = by_differences((Difference(setting="structure.ring_thickness", variation=0.01),), modes, np.array([0, 1]),
                           {"structure.ring_thickness.more": more, "structure.ring_thickness.less": less}, card)
    assert table["unit"] == ["m"] and table["scatter"][0, 0] == pytest.approx(8e-5)
    assert table["derivative"][0, 0].real * 8e-5 == pytest.approx(5.0)
    assert table["error"][0, 0] * 8e-5 == pytest.approx(0.2)
    np.testing.assert_array_equal(table["known"], [[1], [0]])
