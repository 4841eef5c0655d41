"""Places of a modal test on a mesh."""

import numpy as np
import pytest

from pipeline.case_models.bodies.measured_points import Point, rows
from pipeline.contract import ConfigError

NODES = np.array([[0, 0, 0], [100, 0, 0], [0, 100, 0], [100, 100, 2]]) * 1e-3
POINTS = (Point(place="node 1", position=["1 mm", "0 mm", "0 mm"]),
          Point(place="rim", position=["0.1 m", "0.1 m", "2 mm"], direction=(0.0, 0.6, 0.8)))
SHAPE = np.arange(24.0).reshape(12, 2)


def seen(places, references, units=("m/s^2/N",) * 3):
    return rows(POINTS, places, references, units[:len(places)], {"disc": NODES}, "model_update")


def test_a_residue_is_the_motion_of_the_place_times_that_of_the_reference():
    found = seen(["node 1 direction -3", "elsewhere direction 1", "rim"], ["node 1 direction 3"] * 3,
                 ("m/s^2/N", "m/N", "m/s/N"))
    assert found.index.tolist() == [0, 2] and found.order.tolist() == [2, 1]
    np.testing.assert_allclose(found.distance, 1e-3, rtol=1e-9)
    moved = np.array([-SHAPE[2], 0.6 * SHAPE[10] + 0.8 * SHAPE[11]])
    np.testing.assert_allclose(found.products(SHAPE[:, :1]), moved[:, :1] * SHAPE[2, 0])
    both = found.products(SHAPE)
    assert both.shape == (2, 3)     # of a pair of modes: both squares, and their product
    np.testing.assert_allclose(both[:, 0], moved[:, 0] * SHAPE[2, 0])
    np.testing.assert_allclose(both[:, 1], (moved[:, 0] * SHAPE[2, 1] + moved[:, 1] * SHAPE[2, 0]) / 2)


def test_of_unknown_references_those_of_the_first_count():
    found = seen(["node 1 direction 3", "rim", "rim"], ["hammer", "hammer", "other"])
    assert found.struck is None and found.index.tolist() == [0, 1]
    np.testing.assert_allclose(found.products(SHAPE)[0], SHAPE[2])


def test_without_points_there_is_nothing_to_compare():
    assert rows((), ["a"], ["b"], ["m/N"], {"disc": NODES}, "model_update") is None


def test_points_off_the_body_unknown_places_and_missing_directions_are_refused():
    with pytest.raises(ConfigError, match="a point of the body, within 0.005 m of a node, found one 0.9 m away"):
        rows((Point(place="p", position=["1 m", "0 m", "0 m"]),), ["p direction 1"], ["p direction 1"], ["m/N"],
             {"disc": NODES}, "model_update")
    with pytest.raises(ConfigError, match="places of the responses: node 7 direction 1, found node 1, rim"):
        seen(["node 7 direction 1"], ["hammer"])
    with pytest.raises(ConfigError, match="node 1: expected a direction of three numbers"):
        seen(["node 1"], ["hammer"])
