"""The CSV file of a product Countermeasures."""

import csv
import io

import pytest

from pipeline.case_models.countermeasures.table import csv_table, sampled
from tests.views.countermeasures_for_views import countermeasures


def rows(product):
    return list(csv.DictReader(io.StringIO(csv_table(product))))


def test_every_mode_has_a_row_and_every_variant_one_over_all_points():
    product = countermeasures()
    made = rows(product)
    assert len(made) == len(product.variant) + len(product.before)
    whole = next(row for row in made if row["pressure / MPa"] == "any")
    assert float(whole["squeal probability change"]) == pytest.approx(product.overall_change[0])
    assert whole["change exceeds interval"] == "yes" and whole["mass / kg"] == "0.1" and whole["state"] == ""


def test_cells_are_those_of_the_product():
    product = countermeasures()
    first = next(row for row in rows(product) if row["state"])
    assert float(first["frequency before / Hz"]) == pytest.approx(product.before[0].imag / 6.283185307, rel=1e-5)
    assert float(first["growth after / 1/s"]) == pytest.approx(product.after[0].real)
    assert float(first["damping ratio before"]) == pytest.approx(-product.before[0].real / abs(product.before[0]))
    unknown = next(row for row in rows(product) if row["state"] == "new")
    assert unknown["frequency before / Hz"] == "" and unknown["match"] == "ambiguous"


def test_without_draws_there_are_no_probabilities():
    product = countermeasures(draws=0)
    assert all(row["squeal probability before"] == "" == row["change exceeds interval"] for row in rows(product))
    assert sampled(product, 0) is None
