"""Errors of the models on the page: of samples over their deviation, of features over their noise; squeal of stops."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.products import Bench, BenchRun, BenchStops, DiagnosedRun
from pipeline.views.chapters.bench import bench as bench_chapter
from pipeline.views.chapters.bench.diagnosis import chapter, note
from pipeline.views.chapters.bench.model_errors import changes, differs, error_table, held_out_stops, stop_table
from tests.views.diagnosis_for_views import diagnosis

CHANNELS, UNITS = ["pole 1 frequency", "pole 1 growth rate", "pole 2 frequency"], ["Hz", "rad/s", "Hz"]
MEASURED, NOISE, VALID = [1288.67, 314.8, 0.0], [0.43, 2.7, 1.0], [1, 1, 0]


def stop(held_out, growth=314.8):
    """The nominal model is 30 times its noise off in each feature, recalibrated 7, completed 2."""
    measured, noise = np.array([MEASURED]).T.copy(), np.array(NOISE)
    measured[1] = growth
    models = {name: measured + times * noise[:, None] * np.array([[1], [1], [0]])
              for name, times in (("nominal", 30), ("recalibrated", 7), ("completed", 2))}
    return DiagnosedRun(held_out=held_out, condition=[], condition_value=[], time=[0.0], measured=measured,
                        valid=np.array([VALID]).T, noise=noise, error=[0.5, 0.1, 0.05, 8.3], **models)


def told(verdict="missing", **runs):
    runs = runs or {"stop_a": stop(0), "stop_b": stop(1)}
    return diagnosis(verdict, runs=runs, channel=CHANNELS, channel_unit=UNITS,
                     fit=[[0.26, 0.19, 0.19, 233.0], [0.18, 0.04, 0.01, 8.3]])


def test_errors_of_features_are_counted_in_their_noise():
    text = f"{differs(told())} {changes(told())}"
    assert "30 times the noise of the features, 7 times after" in text
    assert "within 2 times the noise (without the effect, refitted: 7 times the noise)" in text
    assert "830" not in text and "noise alone" not in text
    table = error_table(told())
    assert table.rows[0] == ("stop_a", "fitted", "30", "7", "2") and table.rows[-1][0] == "all held out"


def test_held_out_features_within_their_noise_do_not_judge():
    alike = stop(1)
    off = 0.5 * alike.noise[:, None] * np.array([[1], [1], [0]])
    alike = replace(alike, **dict.fromkeys(("nominal", "recalibrated", "completed"), alike.measured + off))
    product = told(stop_a=stop(0), stop_b=alike)
    assert differs(product) == (
        "Held-out runs cannot judge the nominal model, which is within their noise. On fitted runs the error of the"
        " nominal model is 30 times the noise of the features, 7 times after its parameters are refitted.")
    assert "predicts the fitted runs within 2 times the noise" in changes(product)


def test_errors_of_samples_stay_shares_of_their_deviation():
    assert "of the standard deviation" in differs(diagnosis()) and "noise" in changes(diagnosis())
    assert error_table(diagnosis()).head[-1] == "noise alone"


def test_what_fitted_values_predict():
    assert changes(told("parameters")) == ("With the fitted values the model predicts the held-out runs within 7 times"
                                           " the noise (nominal 30 times the noise).")
    assert changes(told("unknown")) == ""


def test_the_first_screen_says_how_the_held_out_stop_squeals():
    sentence = dict(note(told()))["Held-out squeal"].replace("\u202f", " ")
    assert sentence == ("stop_b squeals with 314.8 ± 2.7 1/s at 1288.7 Hz measured; 334 1/s at 1291.7 Hz recalibrated,"
                        " 320 1/s at 1289.5 Hz completed.")
    assert sentence in chapter(told(), None).conclude.replace("\u202f", " ")
    assert "completed" not in held_out_stops(told("parameters"))


def test_no_stop_no_sentence():
    for product in (diagnosis(), told(tap=stop(1, growth=-20.0))):
        assert held_out_stops(product) == "" and stop_table(product) is None


def test_stops_are_listed_with_what_each_model_makes_of_them():
    table = stop_table(told())
    assert table.head[2:] == ("squeal", "measured", "nominal", "recalibrated", "completed") and len(table.rows) == 4
    assert table.rows[0][2:] == ("growth rate / 1/s", "314.8 ± 2.7", "395.8", "333.7", "320.2")


def test_the_chapter_of_the_bench_lists_single_stops_and_why_some_tell_nothing():
    column = dict.fromkeys(("begin", "end"), [0.10, 0.0]) | {"std": [2.0, 0.0], "grown": [4.5, 0.0]}
    stops = {"stop_a": BenchStops(stop=["stop_a", "stop_b"], growth_rate=[189.3, 0.0], frequency=[1191.2, 0.0],
                                  reason=["", "expected a squeal, found none"], **column)}
    run = BenchRun(time=[0.0], measured=[[1.0]], predicted=[[2.0]], valid=[[1]], error=[8.3], root_mean_square=[1.0])
    product = Bench(settings="{}", channel=["pole 1 frequency"], unit=["Hz"], runs={"stop_a": run}, stops=stops)
    result = bench_chapter.chapter(product, None)
    onsets, errors = result.tables
    assert result.figures == () and result.see == "1 run, 1 feature: poles, ratios of sensors, orders."
    assert onsets.rows[0][1:3] == ("189.3 ± 2", "1191.2") and onsets.rows[1][1] == "expected a squeal, found none"
    assert "8.3 times the noise of the features" in result.conclude and errors.head[2] == "error over noise"
    assert errors.rows[0][2] == "8.3" and pytest.approx(8.3) == product.runs["stop_a"].error[0]
