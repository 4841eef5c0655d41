"""The chapter of a diagnosis says what the product says, for every verdict; the map shows where and how much."""

import numpy as np
import pytest

from pipeline.views.chapters.bench import bench as bench_chapter
from pipeline.views.chapters.bench.diagnosis import chapter, headline, note
from pipeline.views.chapters.bench.hypotheses import refusal_table
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import diagnosis as pictures
from pipeline.views.pages.report import page, plan
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as products
from tests.views.diagnosis_for_views import bench, changed, diagnosis


@pytest.fixture(scope="module")
def written():
    """The chapter of what is missing, read by many tests."""
    return chapter(diagnosis(), Look())


@pytest.mark.parametrize("kind, said, tone", [
    ("missing", "Coulomb at guide is missing (97\u202f%)", "warning"),
    ("tie", "Missing effect identified up to ambiguity: coulomb at guide or quadratic damping at arm", "warning"),
    ("sensor", "The measurement, not the physics: coulomb at guide (97\u202f%)", "warning"),
    ("parameters", "Parameter values are off; no physics is missing", "warning"),
    ("consistent", "Nothing is missing: the model explains the recordings", "quiet"),
    ("unknown", "Unmodelled physics at guide, outside the catalogue", "squeal"),
    ("numerics", "The solver, not the physics", "warning")])
def test_every_verdict_has_its_headline(kind, said, tone, words_only):
    found = diagnosis(kind)
    assert headline(found)[0].startswith(said) and headline(found)[1] == tone
    assert chapter(found, Look()).figures, "and a chapter"
    assert verdict({"diagnosis": found}, ()).headline == headline(found)[0]


@pytest.mark.parametrize("kind, rows, said, kinds", [
    ("missing", ([1], [2]), "Coulomb at guide and quadratic damping at arm are missing", ()),
    ("tie", ([1], [2, 3]), "Missing effect identified up to ambiguity: coulomb at guide, and quadratic damping at arm"
     " or sensor", ()),
    ("tie", ([], [1]), "Proposed, not confirmed: coulomb at guide", ()),
    ("sensor", ([], [1, 2]), "The measurement, not the physics: coulomb at guide or quadratic damping at arm",
     ("sensor", "sensor")),
    ("sensor", ([1], [3]), "The measurement, and physics too: coulomb at guide and sensor gain at position", ())])
def test_what_is_known_is_told_apart_from_what_may_be(kind, rows, said, kinds):
    found = diagnosis(kind, known=rows[0], named=rows[1], kind=["physics", *(kinds or ("physics",) * 2), "sensor"])
    assert headline(found)[0].startswith(said)
    told = dict(note(found))["What is missing"]
    assert ("20.4" in told) == (len(rows[1]) == 1 and kind != "tie"), "values are those of the first alone"
    assert "not tell apart" not in told or len(rows[1]) > 1


def test_refusals_of_single_laws_fill_a_table_not_the_first_screen():
    found = diagnosis("unknown", reason=[
        "nothing reaches the noise", "coulomb at guide: it leaves 12% of the excess error",
        "coulomb at guide: its fit did not converge", "quadratic_damping at arm: it leaves 40% of the excess error"])
    told = dict(note(found))["How certain"]
    assert told.startswith("Nothing reaches the noise. 2 laws were refused: the table of refusals tells why.")
    assert refusal_table(found).rows == (
        ("coulomb at guide", "it leaves 12% of the excess error; its fit did not converge"),
        ("quadratic damping at arm", "it leaves 40% of the excess error"))
    assert refusal_table(diagnosis()) is None


@pytest.mark.parametrize("field, said", [
    ("failure", "The diagnosis failed: nothing could be judged"),
    ("runs_differ", "The model fits each run alone, at values that differ from run to run")])
def test_what_stands_in_place_of_a_leading_law_is_the_headline(field, said):
    found = diagnosis("unknown", **{field: "because of this and that"})
    assert headline(found)[0] == said
    assert dict(note(found))["What is missing"].startswith("Because of this and that.")


def test_only_rules_that_were_applied_are_told():
    found = diagnosis(reason=["2 operating point(s): whether values agree across them was not tested"])
    assert "held-out gain, bounds" in dict(note(found))["How certain"]
    fitted = {name: changed(run, held_out=0) for name, run in diagnosis().runs.items()}
    assert "false alarms, agreement over runs, bounds" in dict(note(changed(diagnosis(), runs=fitted)))["How certain"]


def test_values_that_moved_together_name_the_one_that_moved_most():
    told = dict(note(diagnosis("parameters", parameter_nominal=[211.0, 20.3])))
    assert told["What is missing"].endswith("differ: joints.guide.damping 215 ± 4\u202fN s/m (given 211\u202fN s/m).")


def test_the_note_answers_what_a_colleague_would_ask():
    told = dict(note(diagnosis()))
    assert "held-out runs the error of the nominal model is 60\u202f%" in told["What differs"]
    assert "lies at guide, at amplitudes 1 to 5\u202fmm" in told["Where"]
    assert told["What is missing"] == "Coulomb at guide: force 20.4 ± 0.3\u202fN."
    assert "0.0005" in told["How certain"] or "10" in told["How certain"]
    assert "within 1.5\u202f%" in told["What it changes"] and "1\u202f% of the excess" in told["What it changes"]
    assert "level = 8 N" in told["Measure next"] and "quadratic damping at arm" in told["Measure next"]


def test_wrong_values_are_told_with_what_was_given():
    told = dict(note(diagnosis("parameters", parameter_nominal=[200.0, 20.4])))
    assert told["What is missing"].endswith("joints.guide.damping 215 ± 4\u202fN s/m (given 200\u202fN s/m).")


def test_of_many_wrong_values_those_that_changed_most_are_listed():
    count = 12
    value = 100.0 * (1 + np.arange(1, count + 1) / 100)
    many = diagnosis("parameters", parameter=[f"joints.j{k}.damping" for k in range(count)],
                     parameter_unit=["N s/m"] * count, parameter_nominal=np.full(count, 100.0), parameter_value=value,
                     parameter_std=np.full(count, 0.1), parameter_owner=np.zeros(count, int),
                     parameter_factor=np.zeros(count, int))
    told = dict(note(many))["What is missing"]
    assert told.startswith("No physics; these values differ: joints.j11.damping 112 ± 0.1")
    assert "j4.damping" in told and "j3.damping" not in told and told.endswith("4 others by up to 4\u202f%.")


def test_a_description_is_never_called_physics():
    found = diagnosis("unknown")
    assert dict(note(found))["What is missing"].endswith(found.latent_sentence.item())
    described = chapter(found, Look())
    assert any("not identified physics" in n for n in described.notes)
    assert any("not identified physics" in f.caption for f in described.figures)


def test_what_leads_is_told_with_what_it_takes_and_leaves_and_only_then_is_the_catalogue_in_doubt():
    found = diagnosis("unknown", leading=[1], leading_takes=[0.81], leading_stays=[0.19],
                      leading_values=["force 20.4 +- 0.3 N"],
                      noise_verdict=["unknown", "missing"], noise_named=["", "coulomb at guide"])
    assert headline(found)[0] == ("Leading explanation, not confirmed: coulomb at guide; takes 81\u202f% of the excess"
                                  " error on held-out runs")
    told = dict(note(found))
    assert "takes 81\u202f% of the excess error on held-out runs, and 19\u202f% stays" in told["What is missing"]
    assert "it would be missing (coulomb at guide) at 2 times what is known of it" in told["How certain"]
    family = diagnosis("unknown", leading=[1, 2], leading_takes=[0.81, 0.8], leading_stays=[0.19, 0.2],
                       leading_values=["", ""])
    assert "Of its family, " in dict(note(family))["What is missing"] and headline(family)[0] == headline(found)[0]
    narrow = diagnosis("unknown", objection=["", "the prior of its force excludes the data", "", ""])
    assert headline(narrow)[0].endswith("the fit of coulomb at guide cannot be relied on")
    assert "coulomb at guide, cannot be relied on: the prior of its force" in dict(note(narrow))["What is missing"]
    assert "outside it" in dict(note(diagnosis("unknown")))["What is missing"]
    assert "the same at 0.5 and 2 times the noise" in dict(note(diagnosis()))["How certain"]


def test_laws_of_one_family_at_one_place_are_called_by_it():
    one = {"effect": ["", "coulomb", "dahl", "sensor_gain"], "place": ["", "guide", "guide", "position"]}
    told = "dry friction at guide, of a form that is open: coulomb or dahl"
    assert headline(diagnosis("tie", **one, family="dry friction"))[0].endswith(told)
    leading = diagnosis("unknown", **one, family="dry friction", leading=[1, 2], leading_takes=[0.81, 0.8],
                        leading_values=["", ""],
                        leading_stays=[0.19, 0.2])
    assert f"not confirmed: {told}; takes" in headline(leading)[0]
    assert headline(diagnosis("tie", **one))[0].endswith("coulomb at guide or dahl at guide")


def test_laws_that_explain_much_together_lead_with_their_values_and_why_they_are_not_named():
    found = diagnosis("unknown", leading=[1], leading_takes=[0.19], leading_stays=[0.8], leading_values=[""],
                      leading_set=[0])
    assert headline(found)[0] == ("Leading explanation, not confirmed: coulomb at a and cubic stiffness at a together;"
                                  " 11 % of the excess error stays")
    told = dict(note(found))["What is missing"]
    assert "coulomb at a.force 0.19 N" in told and "not named: coulomb at a adds an evidence of 1.0 nat" in told


def test_what_holds_in_part_says_so_with_what_it_leaves():
    found = diagnosis(in_part=1, model_error=3.1, left_floors=2.9, left_sentence="It lies between 20 and 40 Hz.",
                      unexplained_share=0.021, noise_verdict=["unknown", "missing"])
    assert "coulomb at guide is missing, in part: 2.1\u202f% of the excess error stays" in headline(found)[0].lower()
    told = dict(note(found))
    assert "holds in part" in told["What is left"] and "beside an error of 3.1 noise floors" in told["What is left"]
    assert "it would be unknown at 0.5 times the error of the model" in told["How certain"]
    assert "in part" not in headline(diagnosis())[0] + dict(note(diagnosis()))["What is left"]


def test_what_is_left_after_naming_is_told_with_the_next_candidate():
    found = diagnosis(left_floors=7.6, left_sentence="It lies between 20 and 40 Hz.",
                      left_candidate="quadratic_damping at arm: it leaves 30% of the excess error")
    assert dict(note(found))["What is left"] == (
        "7.6 noise floors remain. It lies between 20 and 40 Hz. Next candidate: Quadratic damping at arm: it leaves"
        " 30% of the excess error.")
    assert dict(note(diagnosis()))["What is left"] == ""


def test_without_a_held_out_run_the_chapter_says_so():
    found = diagnosis()
    fitted = {name: changed(run, held_out=0) for name, run in found.runs.items()}
    assert "No run was held out" in chapter(changed(found, runs=fitted), Look()).notes[0]


def test_the_map_shows_the_tone_in_its_octave_and_noise_as_one():
    """A tone of 30 noises in one octave of l lines: its root mean square over noise is 30 / sqrt(4 l / 600)."""
    edges, before = pictures.mismatch(diagnosis(), "recalibrated")
    row = int(np.searchsorted(edges, 5.0)) - 1
    assert edges[row] < 5 < edges[row + 1] and np.argmax(before[0]) == row
    lines = np.sum((np.arange(301) / 3 >= edges[row]) & (np.arange(301) / 3 < edges[row + 1]))
    assert before[0, row] == pytest.approx(30 / np.sqrt(4 * lines / 600), rel=0.1)
    _, after = pictures.mismatch(diagnosis(), "completed")
    assert after[:, -3:] == pytest.approx(np.ones((2, 3)), rel=0.25)


def test_features_are_mapped_by_channel(written):
    """Four features a run: no octaves, no spectrum; 0.05 beside a noise of 0.01 is 5."""
    few = {"time": np.arange(4.0), "measured": np.ones((1, 4)), "valid": np.ones((1, 4), int),
           "nominal": np.zeros((1, 4)), "recalibrated": np.full((1, 4), 0.95), "completed": np.ones((1, 4))}
    found = diagnosis()
    short = changed(found, runs={name: changed(run, **few) for name, run in found.runs.items()})
    names, table = pictures.by_channel(short, "recalibrated")
    assert names == ["position"] and table == pytest.approx(np.full((2, 1), 5.0))
    assert len(chapter(short, Look()).figures) == len(written.figures) - 2


def test_pictures_are_the_same_twice_and_follow_the_product():
    found = diagnosis()
    other = changed(found, posterior=found.posterior[::-1].copy(), parameter_value=2 * found.parameter_value)
    for draw in (pictures.hypotheses, pictures.stage_place, pictures.parameters):
        assert draw(found) == draw(found) != draw(other)


def test_the_page_begins_with_the_held_out_run_under_all_models_and_the_map():
    shown = {"diagnosis": diagnosis(), "bench": bench()}
    text = page([build() for build in plan(shown, Look()).values()], shown, products.case(), Look())
    assert 'id="bench"' in text and 'id="diagnosis"' in text and "Mismatch map" in text
    first = text[:text.index('id="bench"')]
    assert "Run pulses (held out): measured, nominal, recalibrated and completed" in first, "seen at once"
    assert "Mismatch map" in first


def test_the_bench_shows_prediction_beside_measurement():
    made = bench_chapter.chapter(bench(), Look())
    assert "is 0\u202f% to 20\u202f%" in made.conclude and len(made.figures) == 2
    assert made.tables[0].rows[1] == ("second", "position", "20\u202f%", "140\u202fmm")


def test_friction_is_drawn_point_by_point(written):
    whole = diagnosis()
    few = {name: changed(run, **{part: getattr(run, part)[..., :12] for part in
                                 ("time", "measured", "valid", "nominal", "recalibrated", "completed")})
           for name, run in whole.runs.items()}
    rubbed = changed(whole, channel=["friction"], channel_unit=["1"], runs=few)
    figures = chapter(rubbed, Look()).figures
    shown = [f for f in figures if f.caption.startswith("Friction of every run")]
    assert len(shown) == 1 and shown[0].image == pictures.points(rubbed)
    assert pictures.points(changed(rubbed, runs={"bang": few["bang"]})) != shown[0].image
    assert not any(f.caption.startswith("Friction of every run") for f in written.figures)
    assert "in each channel" in figures[0].caption


def test_every_threshold_is_listed_with_its_unit(written):
    table = next(t for t in written.tables if t.title == "Rules by which it was decided")
    assert [row[:2] for row in table.rows] == [("decision.posterior", "0.9"), ("poles.delay_std", "1e-06\u202fs")]


def test_combinations_are_listed_with_what_became_of_them_and_left_out_where_there_are_none(written, words_only):
    title = "Combinations of effects that were tried"
    table = next(t for t in written.tables if t.title == title)
    assert table.rows == (("coulomb at a + cubic stiffness at a", "12", "120", "11\u202f%", "1.1",
                           "coulomb at a adds an evidence of 1.0 nat", "coulomb at a.force 0.19 N"),)
    none = dict.fromkeys(("combination", "combination_gain", "combination_refitted", "combination_objective",
                          "combination_held_out", "combination_left", "combination_values",
                          "combination_outcome"), [])
    assert all(t.title != title for t in chapter(changed(diagnosis(), **none), Look()).tables)


def test_hypotheses_of_no_stage_have_no_map_of_stages(written):
    """Of lines of a disc alone: every rival is of the recordings or of the model as a whole."""
    found = diagnosis()
    nowhere = chapter(changed(found, stage=[""] * len(found.stage)), Look())
    told, without = ([str(figure) for figure in each.figures] for each in (written, nowhere))
    assert len(without) == len(told) - 1 and not any("by stage" in figure for figure in without)
