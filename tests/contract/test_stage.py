"""A stage is its signature."""

import pytest

from pipeline.contract import (
    ConfigError,
    Context,
    ConvergenceError,
    ProductError,
    Products,
    Quantities,
    Section,
    option,
    stage,
)
from pipeline.contract.errors import UnsettledStepError
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
    with pytest.raises(ProductError, match="Sections with 'built_from'"):
        stage(other, built_from=("source",))


@pytest.mark.parametrize("where, told", [
    ("stepping: duration", "source.duration (stepping)"), ("pressing at 1 s: level", "source.level (pressing at 1 s)"),
    ("stepping: mass", "stepping: mass"), ("duration", "duration"), ("source.level", "source.level")])
def test_an_error_about_a_setting_names_it(where, told):
    def source(settings: Settings, context: Context) -> Source:
        """Fail.

        Method:
        Nothing was made.
        """
        raise ConfigError(where, "less", "more", "take less")

    source.__module__ = "stages.source"
    with pytest.raises(ConfigError) as raised:
        stage(source)(settings=Settings())
    assert str(raised.value) == f"{told}: expected less, found more; take less"


def test_an_error_about_one_of_several_names_the_setting_that_holds_them():
    class Steps(Section):
        """Several steps."""

        steps: Quantities("s", gt=0) = option(("1 s",), "steps")

    def source(settings: Steps, context: Context) -> Source:
        """Fail.

        Method:
        Nothing was made.
        """
        raise ConfigError("stepping: step")

    source.__module__ = "stages.source"
    with pytest.raises(ConfigError, match=r"^source\.steps \(stepping\)$"):
        stage(source)(settings=Steps())


def test_products_are_read_once_and_only_when_asked_for():
    read = []
    products = Products({name: lambda name=name: read.append(name) or name.upper() for name in ("a", "b")})
    assert list(products) == ["a", "b"] and len(products) == 2 and products.get("c") is None and not read
    assert (products["b"], products["b"]) == ("B", "B") and read == ["b"]


def test_a_stage_may_take_everything_before_it():
    def source(products: Products, settings: Settings, context: Context) -> Source:
        """Sum up.

        Method:
        Everything was used.
        """

    source.__module__ = "stages.source"
    made = stage(source)
    assert made.reads_all and not made.inputs and not load("doubled").reads_all


class Steps(Section):
    """A time step."""

    step: float = option(1.0, "time step")


@pytest.mark.parametrize("settings, remedy, told", [
    (Steps, "take a shorter step", "lower source.step"), (Settings, "take a shorter step", "take a shorter step"),
    (Steps, "take a shorter step, or look for energy", "lower source.step, or look for energy"), (Steps, None, None)])
def test_an_error_that_a_shorter_step_may_cure_names_the_setting(settings, remedy, told):
    def source(settings: settings, context: Context) -> Source:
        """Fail.

        Method:
        None.
        """
        raise UnsettledStepError("stepping at 1 s", "forces that settle", "none", remedy)

    source.__module__ = "tests.contract.toy.source"
    with pytest.raises(ConvergenceError) as raised:
        stage(source)(settings=settings())
    assert raised.value.remedy == told and isinstance(raised.value, UnsettledStepError)
