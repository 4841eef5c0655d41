"""Chapter of the frequency responses: how they came about, what was left out."""

from pipeline.products import ResponseFunctions
from pipeline.views.chapters.bench.response_functions import chapter, remarks
from pipeline.views.chapters.chapter import Look
from tests.views import products_for_views as small

LOOK = Look(dpi=50)


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_blows_are_told_with_what_was_left_out():
    made = chapter(small.response_functions(), LOOK)
    assert "4 responses, lines 10.1 Hz apart, from blows, 2 blows; windows that add 3.5 1/s" in plain(made.conclude)
    assert "their coherence is 0.98. Left out: 2.1 s: struck twice." in plain(made.conclude)
    assert len(made.figures) == 1 and "below, their coherence" in made.figures[0].caption


def test_given_responses_have_no_coherence():
    made = chapter(small.response_functions(known=False), LOOK)
    assert plain(made.conclude) == (
        "Test hammer: 4 responses, lines 10.1 Hz apart, as given, without a window; where the front end weighed its"
        " records by an exponential one, response_functions.window_decay takes it off the damping ratios. Phases have"
        " the opposite sign.")
    assert "coherence" not in made.figures[0].caption


def test_remarks_of_the_first_screen_name_their_test_among_several():
    one = small.response_functions(known=False).tests["hammer"]
    assert remarks(ResponseFunctions(tests={"a": one})) == "Phases have the opposite sign."
    assert remarks(ResponseFunctions(tests={"a": one, "b": one})) == (
        "Test a: phases have the opposite sign. Test b: phases have the opposite sign.")
    assert remarks(small.response_functions()) == ""
