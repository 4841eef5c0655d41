"""Stage response_functions: given responses, blows here and there, lasting forces, motions alone, what is refused."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.products import FrequencyResponse, Recording, Run
from pipeline.recordings.samples import channel
from stages.modal_test import Settings as ModalSettings
from stages.modal_test import modal_test
from stages.response_functions import Settings, response_functions
from tests.physics.signals.test_frequency_response import DAMPING, FREQUENCY, RATE, SHAPE, hammered, moved

LINE = np.arange(0.0, 200.0)
GIVEN = {f"p{k}": FrequencyResponse(frequency=LINE, response=1.0 / (60.0 - LINE + 2j + k), unit="m/N",
                                    place=f"node {k} direction 3", reference="node 1 direction 3") for k in range(2)}


def run(force, motion, places=("a", "b", "c"), unit="N", **more):
    channels = {} if force is None else {"hammer": channel(force, unit, "force", RATE, 0.0, "test", role="excitation",
                                                           place="a", direction=(0, 0, -1))}
    channels |= {f"x_{place}": channel(row, "m", "displacement", RATE, 0.0, "test", place=place, direction=(0, 0, 1))
                 for place, row in zip(places, motion, strict=True)}
    return Run(description="", repeat_of="", channels=channels, **more)


def responses(settings=None, **runs):
    return response_functions(Recording(source=[], runs=runs), settings=Settings(**(settings or {}))).tests


BLOWS = hammered([0.1, 0.7], 1.3, 4)


def test_responses_of_a_file_are_taken_as_they_are_and_records_left():
    tests = responses(file=Run(description="", repeat_of="", frf=GIVEN), stop=run(*BLOWS))
    assert list(tests) == ["file"] and str(tests["file"].method) == "given" and len(tests["file"].coherence) == 0
    assert [str(p) for p in tests["file"].place] == ["node 0 direction 3", "node 1 direction 3"]


def test_blows_of_a_hammer_give_modes_with_their_units_and_places():
    test = responses(hammer=run(*BLOWS))["hammer"]
    assert (str(test.method), test.averages.tolist(), str(test.unit[1])) == ("blows", [2], "m/N")
    assert (str(test.place[1]), str(test.reference[1])) == ("b direction 3", "a direction -3")
    assert test.coherence.shape == test.response.shape and test.decay > 0
    modes = modal_test(response_functions(Recording(source=[], runs={"hammer": run(*BLOWS)}), settings=Settings()),
                       settings=ModalSettings(lowest_frequency="100 Hz", highest_frequency="1.5 kHz")).runs["hammer"]
    np.testing.assert_allclose(modes.frequency, FREQUENCY, rtol=2e-3)
    np.testing.assert_allclose(modes.damping_ratio, DAMPING, rtol=0.1)


def test_a_hammer_that_wanders_is_one_test():
    """One sensor, a blow here and there: rows of one shape, all under the window that the longest decay asks for."""
    force, motion = hammered([0.1], 0.8, 4)
    later = hammered([0.1], 0.7, 4)
    tests = responses({"together": True}, first=run(force, motion[:1], "a"), second=run(later[0], later[1][1:2], "b"))
    whole = tests["all"]
    assert [str(label) for label in whole.label] == ["first: x_a", "second: x_b"] and whole.averages.tolist() == [1, 1]
    assert len(whole.line) == len(responses(second=run(later[0], later[1][1:2], "b"))["second"].line)
    modes = modal_test(type("Given", (), {"tests": tests})(), settings=ModalSettings(
        lowest_frequency="100 Hz", highest_frequency="1.5 kHz")).runs["all"]
    ratio = np.real(modes.shape[:, 1] / modes.shape[:, 0])
    np.testing.assert_allclose(ratio, SHAPE[:, 1] / SHAPE[:, 0], rtol=0.1)


def test_a_lasting_force_and_motions_alone():
    force = np.random.default_rng(1).standard_normal(int(30 * RATE))
    motion = moved(force)
    shaken = responses({"resolution": "1 Hz"}, shaker=run(force, motion))["shaker"]
    assert str(shaken.method) == "lasting force" and shaken.averages.tolist() == [59]
    alone = responses({"references": ["x_b"]}, ambient=run(None, motion))["ambient"]
    assert str(alone.method) == "motions alone" and str(alone.unit[0]) == "m*m*s"
    assert [str(r) for r in alone.reference] == ["b direction 3"] * 3
    chosen = responses(ambient=run(None, motion))["ambient"]
    assert str(chosen.reference[0]) == f"{'abc'[motion.std(axis=1).argmax()]} direction 3"


@pytest.mark.parametrize("settings, made, told", [
    ({"runs": ["hamer"]}, lambda: run(*BLOWS), "response_functions.runs: expected some of a, found hamer"),
    ({}, lambda: run(BLOWS[0], BLOWS[1][:0], ()), "or channels of motion, found hammer in N"),
    ({"method": "blows"}, lambda: run(None, BLOWS[1]), "or channels of motion and of force, found x_a in m"),
    ({"force": ["x_a"]}, lambda: run(*BLOWS), "response_functions.force: expected channels of a in N, found x_a in m"),
    ({"motion": ["x"]}, lambda: run(*BLOWS), "response_functions.motion: expected channels of a in m or .*, found x"),
    ({"references": ["x"]}, lambda: run(None, BLOWS[1]), "response_functions.references: expected channels of motion"),
    ({}, lambda: run(0 * BLOWS[0], BLOWS[1]), "response_functions: a: frequency response"),
    ({}, lambda: run(np.where(np.arange(len(BLOWS[0])) == 9, np.nan, BLOWS[0]), BLOWS[1]), "gaps in hammer"),
    ({}, lambda: Run(description="", repeat_of="", frf=GIVEN | {"other": FrequencyResponse(
        frequency=LINE[:9], response=np.ones(9), unit="1", place="", reference="")}),
     "frequency responses on one frequency axis, found 2 axes")])
def test_what_gives_no_responses_is_refused(settings, made, told):
    with pytest.raises(ConfigError, match=told):
        responses(settings, a=made())


def test_runs_on_other_axes_are_not_one_test():
    coarse = {"p": FrequencyResponse(frequency=2 * LINE, response=GIVEN["p0"].response, unit="m/N", place="",
                                     reference="")}
    with pytest.raises(ConfigError, match="runs on one frequency axis, found 2 axes"):
        responses({"together": True}, one=Run(description="", repeat_of="", frf=GIVEN),
                  two=Run(description="", repeat_of="", frf=coarse))


def measured(rows, line, unit="m/N"):
    """A run of given responses."""
    return Run(description="", repeat_of="", frf={f"p{k}": FrequencyResponse(
        frequency=line, response=row, unit=unit, place=f"node {k} direction 3", reference="node 0 direction 3")
        for k, row in enumerate(rows)})


def swapped(line):
    """Accelerances by spectra of SciPy, the conjugate of the force with that of the motion interchanged."""
    force = np.random.default_rng(2).standard_normal(int(60 * RATE))
    spectra = [scipy.signal.csd(row, force, RATE, nperseg=int(RATE))[1] for row in moved(force)]
    power = scipy.signal.welch(force, RATE, nperseg=int(RATE))[1]
    return [row / power for row in spectra], np.arange(len(power), dtype=float)


def other_exponent(line):
    """Receptances by the inverse of NumPy's transform, which has the other sign."""
    force, motion = hammered([0.1], 2.0, 4)
    return np.fft.ifft(motion)[:, :2 * len(line)] / np.fft.ifft(force)[:2 * len(line)], np.fft.fftfreq(
        len(force), 1 / RATE)[:2 * len(line)]


def written(line):
    """Mobilities by their formula in exp(-i w t)."""
    omega = 2 * np.pi * line[:, None]
    natural = 2 * np.pi * FREQUENCY
    return [np.sum(-1j * omega * row * SHAPE[:, 0] / (natural**2 - omega**2 - 2j * DAMPING * natural * omega), axis=1)
            for row in SHAPE.T], line


@pytest.mark.parametrize("made", [swapped, other_exponent, written])
def test_phases_of_the_opposite_sign_are_turned_and_told(made):
    rows, line = made(np.arange(1.0, 1500.0))
    test = responses(file=measured(rows, line))["file"]
    np.testing.assert_array_equal(test.response, np.conj(rows))
    assert "opposite sign" in str(test.remark[0]) and "conjugate of each is used" in str(test.remark[0])
    modes = modal_test(type("Given", (), {"tests": {"file": test}})(), settings=ModalSettings(
        lowest_frequency="100 Hz", highest_frequency="1.2 kHz")).runs["file"]
    near = [int(abs(modes.frequency - f).argmin()) for f in FREQUENCY]
    np.testing.assert_allclose(modes.frequency[near], FREQUENCY, rtol=2e-3)
    right = responses(file=measured(np.conj(rows), line))["file"]
    np.testing.assert_array_equal(right.response, test.response)
    assert not len(right.remark)


def test_the_case_rules_the_phase_and_mixed_signs_are_refused():
    rows, line = written(np.arange(1.0, 1500.0))
    kept = responses({"phase": "as_given"}, file=measured(rows, line))["file"]
    np.testing.assert_array_equal(kept.response, rows)
    turned = responses({"phase": "conjugate"}, file=measured(np.conj(rows), line))["file"]
    np.testing.assert_array_equal(turned.response, rows)
    with pytest.raises(ConfigError, match="phases of one sign, found the opposite sign in p1: they would come before"):
        responses(file=measured([np.conj(rows[0]), rows[1]], line))


@pytest.mark.parametrize("phase", [0.0, 0.5 * np.pi, 0.3])
def test_sizes_or_parts_alone_are_refused(phase):
    rows, line = written(np.arange(1.0, 1500.0))
    with pytest.raises(ConfigError, match="complex responses, found values of one phase, such as sizes alone, in p0"):
        responses(file=measured(np.abs(rows) * np.exp(1j * phase), line))


def test_a_sign_that_does_not_show_is_told():
    random = np.random.default_rng(0)
    rows = random.standard_normal((2, 500)) + 1j * random.standard_normal((2, 500))
    assert "does not show" in str(responses(file=measured(rows, np.arange(500.0)))["file"].remark[0])


@pytest.mark.parametrize("decay, seconds, settings", [
    (12.0, 2.0, {"window_decay": "12 1/s"}), (12.0, 2.0, {"window_end": float(np.exp(-12.0 * 2.0))}),
    (25.0, 1.0, {"window_decay": "25 1/s"}), (20.0, 1.0, {"window_end": float(np.exp(-20.0))})])
def test_the_window_of_given_responses_is_taken_off_the_damping(decay, seconds, settings):
    """A front end of one or two seconds under exp(-c t): spectra of the weighed records, as a file gives them."""
    force, motion = hammered([0.0], seconds, 4)
    weight = np.exp(-decay * np.arange(len(force)) / RATE)
    rows, line = np.fft.rfft(motion * weight) / np.fft.rfft(force * weight), np.fft.rfftfreq(len(force), 1 / RATE)
    band = line < 2e3

    def modes(given):
        tests = responses(given, file=measured(rows[:, band], line[band]))
        return modal_test(type("Given", (), {"tests": tests})(), settings=ModalSettings(
            lowest_frequency="100 Hz", highest_frequency="1.2 kHz")).runs["file"]

    right, wrong = modes(settings), modes({})
    np.testing.assert_allclose(right.damping_ratio, DAMPING, rtol=0.02)
    np.testing.assert_allclose(wrong.damping_ratio - right.damping_ratio, decay / (2 * np.pi * FREQUENCY), rtol=0.02)
    with pytest.raises(ConfigError, match="decay rates above that of the window, 100 1/s"):
        modes({"window_decay": "100 1/s"})
