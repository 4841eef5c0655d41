"""Stage model_update on a disc whose values are known."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline import products
from pipeline.case_models.bodies.free_body import FreeBody
from pipeline.case_models.bodies.measured_points import rows
from pipeline.contract import ConfigError
from pipeline.products import ModalTest, ResponseFunctions
from stages.model_update import Settings, model_update

COARSE = {"web_cells": 2, "ring_cells": 3, "angular_cells": 20}
ANGLES = np.deg2rad([0, 25, 60, 100, 150, 190, 230, 280, 325])
GIVEN = {"disc": COARSE, "values": {"young": {"spread": 0.1}, "ring_thickness": {"spread": 0.05}, "web_thickness": {
    "spread": 0.1}}, "points": [{"place": f"node {k}", "position": [f"{155 * np.cos(a)} mm", f"{155 * np.sin(a)} mm",
                                                                   "3.4 mm"]} for k, a in enumerate(ANGLES)]}
TRUE = {"young": "128 GPa", "ring_thickness": "7.1 mm", "web_thickness": "4 mm"}
PLACE = [f"node {k} direction 3" for k in range(9)]


def hammered(error=2e-5, noise=0.01, split=5e-4):
    """(ResponseFunctions, ModalTest) of the true disc, its pairs split, accelerances struck at the first point."""
    random, settings = np.random.default_rng(3), Settings(**GIVEN | {"disc": COARSE | TRUE})
    body = FreeBody(settings, "superlu", 1900.0)
    modes = body(np.zeros(3))
    frequency = modes.frequency * np.where(np.arange(len(modes.frequency)) % 2, 1 + split, 1.0)
    kept = frequency < 2000
    seen = rows(settings.points, PLACE, PLACE[:1] * 9, ["m/s^2/N"] * 9, body.nodes, "test")
    residue = (-2j * np.pi * frequency * (seen.moved @ modes.shown) * (seen.struck @ modes.shown))[:, kept].T
    frequency = frequency[kept] * (1 + error * random.standard_normal(kept.sum()))
    count, line, empty = len(frequency), np.arange(3.0), np.zeros(0)
    test = products.TestModes(
        frequency=frequency, frequency_std=error * frequency, damping_ratio=np.full(count, 1e-3),
        damping_ratio_std=np.full(count, 1e-5), narrow=np.zeros(count, int), partner=np.arange(count), place=PLACE,
        reference=PLACE[:1] * 9, shape=residue * (1 + noise * random.standard_normal(residue.shape)),
        shape_std=noise * abs(residue), likeness=np.eye(count), noise=np.zeros(9), line=line, measured=line,
        fitted=line, order=empty.astype(int), pole_frequency=empty, pole_damping=empty, stable=empty.astype(int),
        chosen=empty.astype(int))
    responses = products.TestResponses(
        line=line, response=np.ones((9, 3), complex), coherence=np.empty((0, 3)), label=PLACE, unit=["m/s^2/N"] * 9,
        place=PLACE, reference=PLACE[:1] * 9, method="given", averages=[0], left_out=[], decay=0.0,
        remark=[])
    return ResponseFunctions(tests={"hammer": responses}), ModalTest(runs={"hammer": test})


@pytest.fixture(scope="module")
def result():
    return model_update(*hammered(), settings=Settings(**GIVEN))


def test_values_come_out_to_one_percent_and_within_what_they_say(result):
    assert list(result.parameter) == [f"disc.{name}" for name in TRUE] and list(result.unit) == ["Pa", "m", "m"]
    off = np.log(result.after / (128e9, 7.1e-3, 4e-3))
    assert abs(off).max() < 0.01 and (abs(off) < 2.5 * result.after_spread).all()
    assert (result.after_spread < 0.02).all()


def test_every_mode_finds_its_own(result):
    assert result.clear.all() and set(result.members) == {1, 2}
    assert (result.likeness[np.arange(len(result.pair)), result.pair] > 0.98).all()
    assert result.diameters[result.pair[:2]].tolist() == [2, 2]
    off = abs(result.frequency[result.pair] / result.measured_frequency - 1)
    assert off.max() < 1e-3 < abs(result.frequency_before[result.pair] / result.measured_frequency - 1).min()


def test_points_agree_and_a_sensor_mounted_the_wrong_way_round_is_told(result):
    assert (result.agreement > 0.99).all() and (result.distance < 0.02).all()
    responses, modes = hammered()
    test = modes.runs["hammer"]
    turned = replace(test, shape=test.shape * np.where(np.arange(9) == 4, -1.0, 1.0))
    wrong = model_update(responses, ModalTest(runs={"hammer": turned}), settings=Settings(**GIVEN))
    assert wrong.agreement.argmin() == 4


def test_values_that_the_body_does_not_have_and_runs_without_modes_are_refused():
    responses, modes = hammered()
    with pytest.raises(ConfigError, match="values above 0: disc.ring_inner_radius, .*, found disc.yuong"):
        model_update(responses, modes, settings=Settings(**GIVEN | {"values": {"yuong": {"spread": 0.1}}}))
    with pytest.raises(ConfigError, match="model_update.run: expected a run with modes: hammer, found 'stop'"):
        model_update(responses, modes, settings=Settings(**GIVEN | {"run": "stop"}))
