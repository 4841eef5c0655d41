"""A stage is its signature."""

import pytest

from pipeline.contract import Context, ProductError, stage
from tests.contract.toy import load
from tests.contract.toy.products import Source
from tests.contract.toy.source import Settings


def test_the_signature_is_the_contract():
    doubled = load("doubled")
    assert doubled.name == "doubled" and doubled.inputs == {"given": (Source,)} and not doubled.optional
    assert doubled.summary == "Multiply the signals." and doubled.method == "Signals were multiplied by {factor}."
    assert load("source")(settings=Settings()).signal.max() == 1000.0


def test_refuses_an_incomplete_signature_or_another_name():
    def source(settings, context):
        """No annotations. Method: none."""

    def other(settings: Settings, context: Context) -> Source:
        """Another name.

        Method:
        None.
        """

    with pytest.raises(ProductError, match="annotate the products read"):
        stage(source)
    with pytest.raises(ProductError, match="share one name"):
        stage(other)
