"""Every published fact gets one row, whatever the case computed."""

from pathlib import Path

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.validation.published_facts import load
from stages.comparison import Settings, comparison
from tests.views.products_for_views import complex_modes, micro_friction, multibody, squeal, structure

FILE = Path(__file__).parents[2] / "data" / "reference" / "disc_brake.yaml"
FACTS = load(FILE)


BRAKE = {"micro_friction": micro_friction, "structure": structure, "complex_modes": complex_modes,
         "multibody": multibody, "squeal": squeal}


def compare(**settings):
    chosen = Settings.model_validate({"reference": str(FILE), **settings})
    return comparison({name: build() for name, build in BRAKE.items()}, settings=chosen)


@pytest.fixture(scope="module")
def compared():
    return compare(tuned={"mode_*_test": "disc dimensions", "real_area_start": "pad roughness"})


def row(compared, key):
    number = [fact.key for fact in FACTS].index(key)
    return {name: getattr(compared, name)[number] for name in compared.__dataclass_fields__}


def test_one_row_per_fact(compared):
    assert len(compared.row) == len(FACTS)
    assert set(compared.verdict) == {"within", "outside", "not comparable"}
    missing = compared.verdict == "not comparable"
    assert all(compared.note[missing])
    assert np.all(compared.ours_known[~missing] == 1)


def test_value_in_its_printed_unit(compared):
    micro = micro_friction()
    found = row(compared, "real_area_start")
    assert found["ours"] == pytest.approx(100 * micro.real_area[0, 1, 0])
    assert (found["published"], found["verdict"], found["tuned"]) == (3, "within", "pad roughness")


def test_mode_of_table_1(compared):
    found = row(compared, "mode_01_02_test")
    assert (found["ours"], found["verdict"], found["tuned"]) == (259.4, "within", "disc dimensions")
    assert row(compared, "mode_16_17_test")["verdict"] == "not comparable"


def test_statement_with_bounds(compared):
    found = row(compared, "damped_at_low_load")
    assert found["published_known"] == 0 and found["tolerance"] == 0
    assert (found["verdict"], found["bounds"], found["field"]) == ("within", "at least 0.005", "multibody.growth_rate")


def test_inputs_are_shown_and_not_counted(compared):
    found = row(compared, "pressure_highest")
    assert (found["ours"], found["verdict"], found["tolerance"]) == (3, "not comparable", 0)


def test_condition_and_derived_rows_say_why_they_are_not_compared(compared):
    assert "condition" in row(compared, "test_pressure_lowest")["note"]
    assert "other rows" in row(compared, "mode_13_deviation")["note"]
    assert row(compared, "shape_at_line_1")["ours_known"] == 0


def test_misprint_is_shown_as_printed_and_not_counted():
    """With a mode near the value as read the row tells so, but keeps out of the verdicts."""
    base = structure()
    values = {name: getattr(base, name) for name in base.__dataclass_fields__}
    longer = type(base)(**{**values, "free_frequency": [259.4, 3500.0, 3600.0], "free_diameters": [2, 0, 4],
                           "free_out_of_plane": [1.0, 1.0, 1.0]})
    settings = Settings.model_validate({"reference": str(FILE)})
    found = row(comparison({"structure": longer}, settings=settings), "mode_18_simulation")
    assert (found["published"], found["ours"]) == (337.3, 3500.0)
    assert (found["verdict"], found["tolerance"]) == ("not comparable", 0)
    assert "within the tolerance of 177 Hz about 3537.3 Hz" in found["note"]


def test_without_reference_there_is_no_row():
    assert compare(reference=None).row.size == 0


def test_bad_settings(tmp_path):
    with pytest.raises(ConfigError, match="key of the reference file"):
        compare(tuned={"mode_99": "nothing"})
    with pytest.raises(ValueError, match="expected a file"):
        compare(reference=str(tmp_path / "none.yaml"))


def test_products_that_a_case_lacks_leave_their_rows_open():
    settings = Settings.model_validate({"reference": str(FILE)})
    one = comparison({"structure": structure()}, settings=settings)
    assert row(one, "mode_01_02_test")["verdict"] == "within"
    assert row(one, "real_area_start")["ours_known"] == 0
    assert not comparison({}, settings=settings).ours_known.any()
