"""Variants that a stage asks for by what came of those before: a search.

The option ``further`` of a stage is a pure function ``(sections, given, computed)``: ``given`` {argument: product} are
its inputs, read at their first use, ``computed(name, changes)`` the products {argument: product} of a variant, None
where it is not computed yet. It returns {name: changes} of every variant that it asks for so far. The same products
lead to the same variants: an interrupted search goes on where it stopped, by walking through what is there once more.
"""

from functools import partial

from pipeline.contract import store
from pipeline.contract.stage import Products


def asked(run, stage, ready=None):
    """{name: changes} of all variants that a Stage asks for in a ChainRun, as far as it can know them.

    ``ready``: names of the variants whose products may be read; None = all whose products are there.
    """
    made = dict(stage.variants(run.case.sections))
    if stage.further is None:
        return made
    filled = run.filled(stage)
    if not all(_is_there(product, run.path(product)) for product in filled.values() if product):
        return made
    given = Products({name: partial(read, product, run.path(product)) if product else lambda: None
                      for name, product in filled.items()})

    def computed(name, changes):
        if ready is not None and name not in ready:
            return None
        variant = run.varied(name, changes)
        found = {argument: read(product, variant.path(product)) for argument, product in stage.varied.items()}
        return None if None in found.values() else found

    return {**made, **stage.further(run.case.sections, given, computed)}


def read(product, path):
    """The product at ``path``; None where there is none of this class and version."""
    return store.read(product, path) if _is_there(product, path) else None


def _is_there(product, path):
    identity = store.identity(path)
    return identity is not None and identity[:2] == (product.name, product.version)
