"""The law that looks most like the residual: the true one where it is large, none where nothing is left."""

from pipeline.blind_trial.baselines.largest_residual import answer


def test_it_names_what_is_large_and_nothing_where_little_is_left(hidden, control):
    assert [(e["name"], e["place"]) for e in answer(hidden)["effects"]] == [("cubic_stiffness", "link_0")]
    assert answer(control)["verdict"] == "parameters"
