"""Pairing of modes, and squeal lines."""

import numpy as np
import pytest

from pipeline.products import ComplexModes, Squeal, Structure
from pipeline.validation.modes import disc_mode_rows, squeal_rows, system_mode_rows
from pipeline.validation.published_facts import Published
from tests.views.products_for_views import filled


def fact(key, value, role="test", **more):
    said = {"part": "modes", "quantity": "q", "tolerance": 1, "why": "w", "source": "s"}
    return Published(key=key, role=role, value=value, **said, **more)


def disc():
    return filled(Structure, free_frequency=[250.0, 252.0, 255.0, 430.0, 650.0, 652.0],
                  free_diameters=[2, 2, 0, 0, 3, 3], free_out_of_plane=np.ones(6))


def test_pairs_by_shape_before_frequency():
    rows = disc_mode_rows(disc(), [fact("pair", 256.0, single=False), fact("single", 251.0, single=True),
                                   fact("three", 600.0, single=False, diameters=3)])
    assert (rows["pair"].value, rows["single"].value, rows["three"].value) == (252.0, 255.0, 650.0)
    assert "multiplicity" in rows["pair"].note and "diameters (3)" in rows["three"].note


def test_a_row_without_a_mode_takes_none_from_another():
    rows = disc_mode_rows(disc(), [fact("lost", 330.0, single=True), fact("found", 435.0, single=True)])
    assert (rows["lost"].value, rows["found"].value) == (None, 430.0)


def test_each_mode_is_taken_once_per_column():
    facts = [fact(key, 250.8, role, single=False, diameters=2)
             for key, role in (("a", "simulation"), ("b", "simulation"), ("c", "simulation"), ("d", "test"))]
    rows = disc_mode_rows(disc(), facts)
    assert sorted(row.value or 0 for key, row in rows.items() if key != "d") == [0, 250.0, 252.0]
    assert rows["d"].value == 250.0


def test_printed_value_in_doubt_is_paired_as_read_and_modes_beyond_ours_are_open():
    rows = disc_mode_rows(disc(), [fact("misprint", 43.0, single=True, doubt="a digit lost", read_as=433.0),
                                   fact("high", 900.0, single=True)])
    assert rows["misprint"].value == 430.0
    assert rows["high"].value is None and "end at 652 Hz" in rows["high"].note


def test_nearest_complex_mode_with_its_neighbours():
    root = 2j * np.pi * np.array([[16000.0, 16550.0, 17000.0, 17900.0], [16000.0, 16580.0, 17000.0, 17900.0]])
    modes = filled(ComplexModes, operating_pressure=[1e6, 3e6], operating_speed=[8.5, 12.0], operating_root=root - 1)
    known = {"complex_mode_at_line_1": 16600.0, "complex_mode_at_line_2": 40000.0}
    rows = system_mode_rows(modes, known)
    assert rows["complex_mode_at_line_1"].value == pytest.approx(16580.0)
    assert "3 roots" in rows["complex_mode_at_line_1"].note
    assert rows["complex_mode_at_line_2"].value is None


def squealing(frequency, coupling="assembly", order=None):
    events = {f"event_{name}": np.zeros(len(frequency), int) for name in ("operating", "sensor")}
    more = {f"event_{name}": np.zeros(len(frequency)) for name in ("level", "start", "duration")}
    order = np.ones(len(frequency), int) if order is None else np.array(order)
    return filled(Squeal, event_frequency=frequency, event_order=order, event_fundamental=frequency / order,
                  coupling=coupling, **events, **more)


def test_harmonics_are_no_squeal_frequencies():
    """The event nearest the first line is a harmonic: the row takes the nearest tone of its own."""
    known = {"squeal_line_1": 16600.0}
    rows = squeal_rows(squealing([1620.0, 3000.0, 16610.0, 15000.0], order=[2, 1, 20, 1]), known)
    assert rows["squeal_line_1"].value == 15000.0
    assert (rows["squeal_lines"].value, rows["no_mode_excited"].value) == (2, 2)
    assert rows["no_squeal_at_constant_load"].value == 4
    assert "2 harmonics of lower tones excluded" in rows["squeal_lines"].note
    only = squeal_rows(squealing([1620.0], order=[2]), known)
    assert (only["squeal_lines"].value, only["squeal_line_1"].value) == (0, None)
    assert "1 harmonic of lower tones excluded" in only["squeal_line_1"].note


def test_squeal_lines():
    known = {"squeal_line_1": 16600.0, "squeal_line_2": 17800.0}
    rows = squeal_rows(squealing([16620.0, 3000.0, 16580.0]), known)
    assert (rows["squeal_lines"].value, rows["no_mode_excited"].value) == (2, 3)
    assert rows["squeal_line_1"].value in (16580.0, 16620.0)
    assert all(row.note.count("response of the whole assembly") == 1 for row in rows.values())
    assert "disc alone" in squeal_rows(squealing([3000.0], coupling="disc"), known)["squeal_lines"].note
    quiet = squeal_rows(squealing([]), known)
    assert (quiet["squeal_lines"].value, quiet["squeal_line_2"].value) == (0, None)
