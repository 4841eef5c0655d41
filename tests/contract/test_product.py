"""Products refuse what breaks their contract."""

import numpy as np
import pytest

from pipeline.contract import Array, ProductError, parts, product, quantity
from tests.contract.toy.products import Inner, Shelf, Source

GOOD = {"time": [0.0, 1.0], "label": ["a"], "signal": np.zeros((1, 2)), "root": [1j], "flag": [1], "scale": 1.0,
        "inner": Inner(position=np.zeros((2, 3)))}


@pytest.mark.parametrize("field, value, message", [
    ("signal", np.zeros((1, 3)), "source.signal: expected 2 along 'time' as in the fields before, found 3"),
    ("signal", np.zeros(2), r"source.signal: expected dimensions \('channel', 'time'\), found shape \(2,\)"),
    ("signal", [[0.0, np.nan]], "source.signal: expected finite values, found 1 that are not"),
    ("signal", [[0.0, 1j]], "source.signal: expected float64, found complex128"),
    ("flag", [0.5], "source.flag: expected int64, found float64"),
    ("label", [3], "source.label: expected strings, found 3"),
    ("inner", None, "source.inner: expected a inner, found NoneType"),
])
def test_refuses(field, value, message):
    with pytest.raises(ProductError, match=message):
        Source(**{**GOOD, field: value})


def test_arrays_are_read_only_copies():
    signal = np.zeros((1, 2))
    made = Source(**{**GOOD, "signal": signal})
    signal[0, 0] = 5.0
    assert made.signal[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        made.signal[0, 0] = 1.0


def test_a_field_named_like_a_dimension_is_its_coordinate():
    with pytest.raises(ProductError, match="wrong.time: expected the 1-D coordinate"):
        @product(version=1)
        class Wrong:
            time: Array = quantity("s", "time channel", "two-dimensional")


def test_unknown_unit_is_refused():
    with pytest.raises(ProductError, match="not in the SI vocabulary"):
        quantity("mm", "", "a length")


@pytest.mark.parametrize("points, message", [
    ([GOOD["inner"]], "shelf.points: expected a mapping of names to inner, found list"),
    ({"a/b": GOOD["inner"]}, "shelf.points: a name: expected letters, digits and _ . -, found 'a/b'"),
    ({"a": None}, "shelf.points.a: expected a inner, found NoneType"),
])
def test_refuses_parts(points, message):
    with pytest.raises(ProductError, match=message):
        Shelf(points=points)


def test_parts_are_asked_for_but_where_there_may_be_none():
    with pytest.raises(TypeError, match="points"):
        Shelf()

    @product(version=1)
    class Bare:
        points: dict[str, Inner] = parts("none needed", empty=True)

    one, other = Bare(), Bare()
    one.points["a"] = GOOD["inner"]
    assert not other.points


def test_arrays_of_products_are_shared_and_those_of_others_copied():
    """A stretch of a long record is a view of it; what somebody may still write to is copied, through views too."""
    @product(version=1)
    class Sample:
        value: Array = quantity("m", "point", "any")

    own = np.arange(4.0)
    first = Sample(value=own)
    own[0] = 9.0
    assert first.value[0] == 0.0
    assert np.shares_memory(Sample(value=first.value[1:3]).value, first.value)
    view = own[:2]
    view.setflags(write=False)
    assert not np.shares_memory(Sample(value=view).value, own)


def test_float32_stays_where_a_field_is_narrow():
    @product(version=1)
    class Sampled:
        """Samples of a file."""

        samples: Array = quantity("1", "sample", "samples", narrow=True)
        other: Array = quantity("1", "sample", "others")

    single, double = np.ones(3, np.float32), np.ones(3)
    assert [Sampled(samples=x, other=x).samples.dtype for x in (single, double, [1, 2, 3])] == ["f4", "f8", "f8"]
    assert Sampled(samples=single, other=single).other.dtype == "f8"
