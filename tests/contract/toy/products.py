"""Two products of a chain that needs no physics."""

from pipeline.contract import Array, count, part, parts, product, quantity, text


@product(version=1)
class Inner:
    """A nested product."""

    position: Array = quantity("m", "point xyz", "points")


@product(version=1)
class Source:
    """Numbers to work on."""

    time: Array = quantity("s", "time", "time axis")
    label: Array = text("channel", "names")
    signal: Array = quantity("Pa", "channel time", "signals")
    root: Array = quantity("1/s", "channel", "roots", complex)
    flag: Array = count("channel", "flags")
    scale: Array = quantity("1", "", "a scalar")
    inner: Inner = part("a part")


@product(version=1)
class Doubled:
    """Numbers worked on."""

    signal: Array = quantity("Pa", "channel time", "doubled signals")


@product(version=1)
class Mean:
    """Numbers worked on in another way."""

    level: Array = quantity("Pa", "channel", "mean of the signals")


@product(version=1)
class Compared:
    """How variants of a case differ from it."""

    variant: Array = text("variant", "names of the variants")
    ratio: Array = quantity("1", "variant", "their signal over that of the case")


@product(version=1)
class Shelf:
    """Nested products by name."""

    points: dict[str, Inner] = parts("points by name")


@product(version=1)
class Sought:
    """Levels that were tried."""

    level: Array = quantity("Pa", "trial", "levels in their order")
