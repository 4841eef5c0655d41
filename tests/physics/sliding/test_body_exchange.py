"""A body exchanged for itself changes nothing; for another one it is the model built with the other."""

import numpy as np
import pytest

from pipeline.physics.reduction.body import BodyTerms
from pipeline.physics.sliding.body_exchange import exchanged
from tests.physics.lumps import random_structure

pytestmark = pytest.mark.exact


def split_model():
    from dataclasses import replace

    model = random_structure(6, 3e3)
    return replace(model, body_name=("one", "other"), coordinate_body=np.array([0, 0, 0, 1, 1, 1]))


def terms_of(model, own, factor=1.0):
    rows = np.vstack([model.joints.rows, model.contacts.normal, model.contacts.tangent, model.contacts.lateral,
                      model.input_rows, model.sensor_rows])[:, own]
    parts = {name: factor * getattr(model, name)[np.ix_(own, own)]
             for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
    return BodyTerms(**parts, rows=rows, position=np.empty((0, 3)), face=np.empty((0, 4), int),
                     recovery=np.empty((0, 3, len(own))))


def test_a_body_exchanged_for_itself_changes_nothing():
    model = split_model()
    again = exchanged(model, "other", terms_of(model, np.arange(3, 6)))
    for before, after in zip(model.frictionless(), again.frictionless(), strict=True):
        assert np.array_equal(before, after)
    assert np.array_equal(again.sensor_rows, model.sensor_rows)
    assert np.array_equal(again.coordinate_body, model.coordinate_body)


def test_the_new_body_stands_last():
    model = split_model()
    found = exchanged(model, "one", terms_of(model, np.arange(3), factor=2.0))
    assert np.array_equal(found.coordinate_body, [1, 1, 1, 0, 0, 0])
    assert np.diag(found.mass) == pytest.approx([1, 1, 1, 2, 2, 2])
    assert np.array_equal(found.contacts.normal[:, 3:], model.contacts.normal[:, :3])
