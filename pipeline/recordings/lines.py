"""Lists of lines from published facts."""

from fnmatch import fnmatch

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.products import Lines


def line_list(facts, patterns, multiples, place, where):
    """Lines of the published ``facts`` whose keys match ``patterns``, each with its ``multiples``, in order.

    A doubted value enters with its corrected reading. ConfigError at ``where`` for a pattern without a fact and for
    facts that are not frequencies.
    """
    for pattern in patterns:
        if not any(fnmatch(fact.key, pattern) for fact in facts):
            raise ConfigError(f"{where}.facts", "a key of the file, or a pattern of keys",
                              f"{pattern}, which matches no key")
    chosen = [fact for fact in facts if any(fnmatch(fact.key, pattern) for pattern in patterns)]
    others = [fact.key for fact in chosen if fact.value is None or fact.unit != "Hz"]
    if others:
        raise ConfigError(f"{where}.facts", "facts in Hz", ", ".join(others))
    order = np.tile(np.arange(1, multiples + 1), len(chosen))
    each = [fact for fact in chosen for _ in range(multiples)]
    return Lines(
        label=[fact.key if k == 1 else f"{fact.key} x {k}" for fact, k in zip(each, order, strict=True)],
        frequency=order * [fact.value if fact.read_as is None else fact.read_as for fact in each],
        frequency_tolerance=order * [fact.tolerance for fact in each], level=np.zeros(len(each)),
        level_known=np.zeros(len(each), int), partners=[{None: 0, True: 1, False: 2}[fact.single] for fact in each],
        diameters=[-1 if fact.diameters is None else fact.diameters for fact in each], place=place)
