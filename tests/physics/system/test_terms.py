"""Terms: how each kind stands with s, and what changes with speed and friction."""

import numpy as np
import pytest

from pipeline.physics.system.forms import Block
from pipeline.physics.system.terms import TIMES, Kind, Owner, Term, What


@pytest.mark.exact
@pytest.mark.parametrize(("kind", "factor"), [(Kind.MASS, (2 + 3j) ** 2), (Kind.DAMPING, 2 + 3j), (Kind.STIFFNESS, 1),
                                              (Kind.LOSS, 1j)])
def test_factors(kind, factor):
    assert kind.factor(2 + 3j) == factor


def test_a_sliding_term_says_how_it_changes():
    term = Term.sliding(What.GYROSCOPIC, Kind.DAMPING, Block(np.eye(2), 3.0), Owner.BODY)
    assert term.times == "speed" and term.matrix[0, 0] == 3.0
    assert Term.whole("mass", "mass", np.eye(2)).times == "1"


def test_every_dependence_is_one_of_matrices():
    from pipeline.case_models.matrices.dependence import summands
    for what, times in TIMES.items():
        assert summands(times, what)
