"""How a search went: what a brake comes to, and the lowest of a start."""

from pipeline.case_models.design_search.course import Asked, Course, Evaluation


def test_the_objective_is_growth_and_cost():
    assert Evaluation(3.0, 0.5).objective == 3.5


def test_the_lowest_of_a_start_is_among_its_own_brakes_and_its_first():
    known = {(0,): Evaluation(9.0), (1,): Evaluation(4.0), (2,): Evaluation(7.0), (3,): Evaluation(1.0)}
    asked = {(1,): Asked(0, "line search", 0), (2,): Asked(1, "start", 0), (3,): Asked(1, "line search", 1)}
    course = Course(asked, known, ((0,), (2,), (8,)), ("", "", ""), True)
    assert [course.lowest(start) for start in range(3)] == [(1,), (3,), None]
