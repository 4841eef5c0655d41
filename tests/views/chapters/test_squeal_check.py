"""Tables of saturated squeal: who squeals, which features agree, and nothing unless asked."""

from pipeline.products import SquealCheck
from pipeline.views.chapters.squeal_check import squeal_note, squeal_tables
from tests.views.diagnosis_for_views import diagnosis

CHECK = SquealCheck(
    sentence="squeals in only one of recording and recalibrated model", who=["recorded", "recalibrated", "completed"],
    records=[2, 3, 3], squealing=[2, 0, 3], feature=["frequency of laser", "share of time open"], unit=["Hz", "1"],
    known=[[1, 0], [0, 0], [1, 1]], mean=[[2200.0, 0], [0, 0], [2201.0, 0.1]], spread=[[2.0, 0], [0, 0], [1.0, 0.01]],
    agrees=[[0, 0], [0, 0], [1, 0]])


def test_what_was_recorded_stands_beside_the_models():
    squealing, features = squeal_tables(diagnosis(squeal={"slide": CHECK}))
    assert squealing.rows == (("slide", "2 of 2", "0 of 3", "3 of 3", CHECK.sentence.item()),)
    (run, name, *values, agrees), = features.rows
    assert (run, name, values[1], agrees) == ("slide", "frequency of laser / Hz", "—", "completed: yes")
    assert "never by waveform" in features.title and values[0].endswith("± 2")


def test_a_model_that_could_not_be_simulated_is_told():
    alone = SquealCheck(sentence="x", who=["recorded"], records=[2], squealing=[1], feature=[], unit=[],
                        known=[[]], mean=[[]], spread=[[]], agrees=[[]])
    squealing, *_ = squeal_tables(diagnosis(squeal={"slide": CHECK, "other": alone}))
    assert squealing.rows[1][:4] == ("other", "1 of 2", "not simulated", "not simulated")


def test_without_asking_there_is_no_table():
    assert squeal_tables(diagnosis()) == ()


def test_the_note_counts_what_differs_and_what_scatters_too_much_to_tell():
    wide = SquealCheck(sentence="x", who=["recorded", "recalibrated"], records=[3, 3], squealing=[3, 3],
                       feature=["frequency of laser", "level of laser", "mean of torque"], unit=["Hz", "m/s", "N m"],
                       known=[[1, 1, 1], [1, 1, 0]], mean=[[1200.0, 0.18, 105.0], [1210.0, 0.12, 0.0]],
                       spread=[[170.0, 0.01, 2.0], [10.0, 0.01, 0.0]], agrees=[[0, 0, 0], [1, 0, 0]])
    note = squeal_note(diagnosis(squeal={"stop": wide}))
    assert "1 of 2 features differ between the recordings and the recalibrated model" in note
    assert "1 scatter by more than 10% and would agree with much else" in note
    assert squeal_note(diagnosis()) == ""
