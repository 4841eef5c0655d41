"""Chains of two and three stages, for tests of the house that need no physics."""

from importlib import import_module

CHAINS = {"toy": ("source", "doubled"), "varied": ("source", "doubled", "compared"),
          "beside": ("source", "doubled", "mean"), "searched": ("source", "doubled", "sought")}


def load(name):
    """The toy Stage called ``name``."""
    return getattr(import_module(f"tests.contract.toy.{name}"), name)
