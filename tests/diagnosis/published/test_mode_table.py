"""Tables of modes: pairs, what lies nearer, and what the diagnosis says of tables whose fault is known."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.published.mode_table import (
    ModeTable,
    Table,
    alternatives,
    exchanges,
    held_ratio,
    mode_problem,
    mode_reasons,
    nearer,
    table,
)
from pipeline.products import Lines, Recording, Run
from tests.diagnosis.solving import solved as diagnosed

COMPUTED = {"a": 200.0, "b": 450.0, "c": 700.0, "d": 1100.0, "e": 1600.0, "f": 1900.0, "g": 2300.0}
TOLD = fill(ModeTable, {"kind": "modes", "measured": "test", "computed": "model"}, "diagnosis.lines")


def lines(frequency, tolerance=0.02, partners=None):
    values = np.array(list(frequency.values()), float)
    return Lines(label=list(frequency), frequency=values, frequency_tolerance=tolerance * values,
                 level=np.zeros(len(values)), level_known=np.zeros(len(values), int),
                 partners=partners or [1] * len(values), diameters=[-1] * len(values), place="disc")


def recording(measured, computed=None):
    empty = {kind: {} for kind in ("conditions", "channels", "frf", "modes", "topography", "friction")}
    return Recording(source=[], runs={
        name: Run(description="", repeat_of="", lines={"disc": lines(one)}, **empty)
        for name, one in (("test", measured), ("model", computed or COMPUTED))})


def solved(measured, pairs=None):
    told = TOLD if pairs is None else TOLD.model_copy(update={"pairs": pairs})
    rows = table(recording(measured), told)
    return rows, diagnosed(mode_problem(rows, None, told), kept=20, draws=2000)


def scattered(share=1.0, **changed):
    noise = 0.007 * np.random.default_rng(3).standard_normal(len(COMPUTED))
    return {f"row_{n}": share * changed.get(n, f) * (1 + e) for (n, f), e in zip(COMPUTED.items(), noise, strict=True)
            if changed.get(n, f)}


def test_lines_are_paired_by_frequency_where_no_pairs_are_printed():
    rows = table(recording({"x": 445.0, "y": 1120.0}), TOLD)
    assert rows.members == (("b",), ("d",)) and [g[0][0] for g in rows.spare] == ["a", "c", "e", "f", "g"]


def test_close_lines_of_a_round_disc_are_one_mode():
    found = lines({"a": 256.2, "b": 257.6, "c": 436.6}, partners=[2, 2, 1])
    whole = recording({"x": 260.0})
    whole.runs["model"].lines["disc"] = found
    assert table(whole, TOLD).model[0] == pytest.approx(256.9)


def test_a_table_that_agrees_is_consistent():
    assert solved(scattered())[1].decision.verdict == "consistent"


def test_one_factor_is_a_wrong_value():
    rows, found = solved(scattered(0.95))
    assert found.decision.verdict == "parameters"
    assert found.null.values["frequency_factor"] == pytest.approx(0.95, abs=0.01)
    assert any("fitted as 0.9" in r and "enough" in r for r in mode_reasons(rows, found))


def test_a_row_printed_beside_the_wrong_mode_is_told():
    pairs = {f"row_{n}": [n] for n in COMPUTED if n != "f"} | {"row_e": ["f"]}
    rows, found = solved(scattered(f=None), pairs)
    best = found.weighed[0]
    assert {"mis_paired", "unlisted_partner"} >= {c.name.split()[0] for c in found.decision.named}
    assert found.decision.named[0].name == "mis_paired at row_e as e" and best.fit.values[
        "mis_paired@row_e as e.share"] == pytest.approx(1, abs=0.15)
    assert [(rows.name[i], g[0]) for i, g in nearer(rows)] == [("row_e", ("e",))]
    assert any("1600.0 Hz (e), which the table pairs with nothing" in r for r in mode_reasons(rows, found))


def test_rows_printed_beside_each_others_modes_are_told():
    pairs = {f"row_{n}": [n] for n in COMPUTED} | {"row_e": ["f"], "row_f": ["e"]}
    rows, found = solved(scattered(), pairs)
    assert [(rows.name[i], rows.name[k]) for i, k in exchanges(rows)] == [("row_e", "row_f")]
    assert found.decision.named[0].name == "mis_paired at row_e exchanged with row_f"


def test_a_row_that_nothing_listed_explains_may_be_paired_with_a_mode_that_is_not():
    rows, found = solved(scattered(c=800.0), {f"row_{n}": [n] for n in COMPUTED})
    assert not nearer(rows) and [c.name for c in found.decision.named] == ["unlisted_partner at row_c"]
    assert any("row_c: no printed mode lies nearer" in r for r in mode_reasons(rows, found))


def test_a_support_moves_modes_by_our_own_shapes():
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    node = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(100)))

    def shape(n):
        return np.column_stack((np.zeros((100, 2)), np.cos(n * angle)))

    class Disc:
        frequency = np.array([150.0, 220.0])
        shape = None

    Disc.node, Disc.shape = node, np.array([shape(0), shape(2)])

    class Structure:
        free_frequency, free_diameters, disc = np.array([190.0, 455.0]), np.array([2, 0]), Disc

    own = np.array([200.0, 450.0, 900.0])
    rows = Table(("x", "y", "z"), own, np.ones(3), own, ((),) * 3, np.array([2, 1, 2]), np.array([2, 0, 3]), ())
    assert held_ratio(rows, Structure) == pytest.approx([220 / 190, 150 / 455, 1])
    assert "support" in [a.effect for a in alternatives(rows, Structure)]


def test_pairs_that_do_not_fit_the_lists_are_refused():
    with pytest.raises(ConfigError, match="diagnosis.lines.pairs.*found z"):
        table(recording({"x": 445.0}), TOLD.model_copy(update={"pairs": {"x": ("z",)}}))
    with pytest.raises(ConfigError, match="at least as many modes"):
        table(recording({"x": 445.0, "y": 500.0}, {"a": 445.0}), TOLD)
