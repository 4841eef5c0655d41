"""A search over a design space: brakes that were tried, the best of them, and what was not searched."""

from pipeline.contract import Array, count, product, quantity, text


@product(version=1)
class DesignSearch:
    """Brakes of a declared design space, searched from several starts for the smallest growth of unstable modes.

    The first brake is the case. Values are SI, of lists indices; growth rates are those of the reduced model.
    """

    parameter: Array = text("parameter", "settings of the space")
    unit: Array = text("parameter", "SI unit; empty for numbers without one and for lists")
    lower: Array = quantity("1", "parameter", "lower end of the range, in its unit; 0 for lists")
    upper: Array = quantity("1", "parameter", "upper end; 0 for lists")
    choices: Array = text("parameter", "values of the list, separated by ' | '; empty for ranges")
    slope: Array = text("parameter", "analytic: by left and right vectors; differences: by more brakes; list: every other value was tried")
    case_value: Array = text("parameter", "value of the case, as the space would write it")
    case_inside: Array = count("", "1 where the space holds the case")
    brake: Array = text("brake", "folder of the brake in variants/; case: the case itself")
    value: Array = quantity("1", "brake parameter", "values of the brake, in their units; of lists the index")
    written: Array = text("brake parameter", "the same as a case gives them")
    start: Array = count("brake", "start that asked for it first; -1 for the case outside the space")
    round: Array = count("brake", "round in which it was computed; -1 for the case")
    role: Array = text("brake", "case, start, line search, difference, or other value of a list")
    unstable: Array = count("brake", "unstable modes, those of one frequency counted once")
    growth: Array = quantity("1/s", "brake", "growth of the objective")
    cost: Array = quantity("1/s", "brake", "weighted cost")
    objective: Array = quantity("1/s", "brake", "the sum of both, which is sought small")
    kind: Array = text("", "growth that was minimised: largest growth rate, or sum of the growth rates")
    budget: Array = count("", "brakes that might be computed")
    computed: Array = count("", "brakes that were")
    start_first: Array = count("begin", "brake at which each start began")
    start_best: Array = count("begin", "brake with the smallest objective among those of the start")
    start_ended: Array = text("begin", "why it ended")
    best: Array = count("", "brake with the smallest objective; 0, the case, where none is better; -1 without a space")
    cost_name: Array = text("column", "columns of costs, as stated")
    cost_unit: Array = text("column", "their units, empty without one")
    best_cost: Array = quantity("1", "column", "cost of the best design, in that unit")
    pressure: Array = quantity("Pa", "operating", "pressure of the operating point")
    speed: Array = quantity("rad/s", "operating", "speed of the drive there")
    growth_before: Array = quantity("1/s", "operating", "largest growth rate in the case; 0 where all modes are stable")
    growth_after: Array = quantity("1/s", "operating", "the same in the best design")
    unstable_before: Array = count("operating", "unstable modes in the case")
    unstable_after: Array = count("operating", "unstable modes in the best design")
    not_searched: Array = text("statement", "what the search leaves open")
