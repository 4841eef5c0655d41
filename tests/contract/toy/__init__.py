"""A chain of two stages, for tests of the house that need no physics."""

from importlib import import_module

CHAINS = {"toy": ("source", "doubled")}


def load(name):
    """The toy Stage called ``name``."""
    return getattr(import_module(f"tests.contract.toy.{name}"), name)
