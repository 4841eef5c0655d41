"""The CSV of a search: a row of each brake, the best marked."""

import csv
from types import SimpleNamespace

import numpy as np

from pipeline.case_models.design_search.table import csv_table


def test_every_brake_has_a_row():
    product = SimpleNamespace(
        brake=["case", "design_search.1"], start=[0, 1], round=[-1, 0], role=["case", "start"],
        parameter=["structure.pad.lining_thickness"], written=[["0.011 m"], ["0.01 m"]], unstable=[2, 1],
        kind="largest", growth=np.array([50.0, 2.5]), cost=np.array([0.0, 0.5]), objective=np.array([50.0, 3.0]),
        best=1)
    rows = list(csv.DictReader(csv_table(product).splitlines()))
    assert [row["structure.pad.lining_thickness"] for row in rows] == ["0.011 m", "0.01 m"]
    assert rows[1]["objective / 1/s"] == "3" and [row["best"] for row in rows] == ["", "best"]
    assert rows[1]["largest / 1/s"] == "2.5" and rows[0]["role"] == "case"
