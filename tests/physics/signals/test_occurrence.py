"""Occurrence over two conditions: time, share and level of every bin."""

import numpy as np
import pytest

from pipeline.physics.signals.occurrence import Conditions, even_edges, occurrence


@pytest.mark.exact
def test_edges_are_round_and_hold_every_value():
    np.testing.assert_allclose(even_edges([0.3, 9.7], 10), np.arange(11.0))
    np.testing.assert_allclose(even_edges([3e5, 3.1e6], 6), np.arange(0, 5e6, 1e6))
    np.testing.assert_allclose(even_edges([300.0, 420.0], 8, 273.15), 273.15 + np.arange(20, 161, 20))
    for low, high in ((5.0, 5.0), (0.0, 0.0), (-3.0, 4.0), (1e-7, 2e-7)):
        edges = even_edges([low, high], 7)
        assert edges[0] <= low and high < edges[-1] and 2 <= len(edges) <= 8


@pytest.mark.exact
def test_every_bin_has_its_time_share_and_level():
    first = np.array([0.5, 0.5, 1.5, 1.5, 9.0, np.nan, 1.0])
    second = np.array([5.0, 5.0, 15.0, 5.0, 5.0, 5.0, 10.0])
    level = np.array([80.0, -np.inf, 90.0, -np.inf, 99.0, 99.0, 70.0])
    edges = np.array([0.0, 1.0, 2.0]), np.array([0.0, 10.0, 20.0])
    made = occurrence(first, second, level, 0.1, edges)
    np.testing.assert_allclose(made.time, [[0.2, 0.0], [0.1, 0.2]])
    np.testing.assert_allclose(made.sounding, [[0.1, 0.0], [0.0, 0.2]])
    np.testing.assert_allclose(made.level, [[80.0, 0.0], [0.0, 90.0]])
    twice = made + made
    np.testing.assert_allclose(twice.time, 2 * made.time)
    np.testing.assert_allclose(twice.level, made.level)


@pytest.mark.exact
def test_what_was_measured_goes_before_what_is_stated():
    pressure = 1e6 + 1e5 * np.arange(100.0)
    pressure[40:50] = np.nan
    told = Conditions({"pressure": [(pressure, 10.0, 2.0)], "speed": [(np.full(100, 6.0), 10.0, 2.0)]},
                      {"pressure": ([0.0], [5e5]), "temperature": ([0.0, 10.0], [300.0, 400.0])})
    np.testing.assert_allclose(told.at("pressure", np.array([0.0, 2.0, 3.0, 6.5, 11.9, 12.5])),
                               [5e5, 1e6, 2e6, 5e5, 1.09e7, 5e5])
    assert told.mean("pressure", 3.0, 0.35) == pytest.approx(2.1e6) and told.mean("pressure", 20.0, 1.0) == 5e5
    np.testing.assert_allclose(told.at("temperature", np.array([0.0, 5.0])), [300.0, 350.0])
    assert told.mean("temperature", 4.0, 2.0) == 350.0
    np.testing.assert_allclose(told.at("speed", np.array([1.0, 3.0])), [np.nan, 6.0])
    assert told.mean("speed", 3.0, 1.0) == 6.0 and told.mean("speed", 20.0, 1.0) is None
    assert told.mean("humidity", 0.0, 1.0) is None and np.isnan(told.at("humidity", np.zeros(2))).all()


def test_nothing_is_known_before_a_record_begins():
    told = Conditions({"pressure": [(np.full(600, 2e6), 100.0, 3.0)]}, {})
    assert told.mean("pressure", 1.0, 0.5) is told.mean("pressure", 2.6, 0.3) is told.mean("pressure", 9.5, 1.0) is None
    assert told.mean("pressure", 2.5, 1.0) == told.mean("pressure", 4.0, 1.0) == 2e6
