"""Pairs of modes of one frequency."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.sliding.doublets import doublets
from tests.physics.lumps import lumps


def modes(*squared, rows=None):
    """Coordinates of unit mass with these squared frequencies."""
    return lumps(np.ones(len(squared)), np.eye(len(squared)) if rows is None else rows, squared)


@pytest.mark.exact
def test_pairs_by_rising_frequency():
    assert doublets(modes(900.0, 400.0, 100.0, 901.0, 400.5)) == {"lumps 1": (1, 4), "lumps 2": (0, 3)}
    assert doublets(modes(400.0, 400.0, 400.0)) == {"lumps 1": (0, 1)}
    assert doublets(modes(100.0, 110.0)) == {} and doublets(modes(100.0, 110.0), 0.1) == {"lumps 1": (0, 1)}


@pytest.mark.exact
def test_mass_counts():
    model = replace(modes(400.0, 800.0), mass=np.diag([1.0, 2.0]))
    assert doublets(model) == {"lumps 1": (0, 1)}


def test_what_is_coupled_free_or_of_other_bodies_is_no_doublet():
    assert doublets(modes(400.0, 400.0, 50.0, rows=[[1, 0, 0], [0, 1, 0], [1, -1, 1.0]])) == {}
    assert doublets(modes(0.0, 0.0)) == {}
    assert doublets(replace(modes(400.0, 400.0), body_name=("one", "other"), coordinate_body=np.arange(2))) == {}
