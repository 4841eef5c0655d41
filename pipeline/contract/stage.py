"""A stage is a pure function; its signature is the whole contract."""

import importlib
import inspect
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Union, get_args, get_origin, get_type_hints

from pipeline.contract.context import Context
from pipeline.contract.errors import ConfigError, ConvergenceError, ProductError
from pipeline.contract.product import is_product
from pipeline.contract.settings import Section

#: remedy of errors in time, where a stage has the setting 'step'
_SHORTER = "take a shorter step"


class Variants(dict):
    """name -> product that a variant of the case leads to; annotated as ``Variants[Product]`` in a stage.

    A variant is the same chain with some settings changed, computed up to that product before the stage runs.
    """


class Products(Mapping):
    """Products of all previous stages by name, each read at its first use."""

    def __init__(self, readers):
        """``readers``: product name -> function without arguments that reads it."""
        self._readers, self._read = dict(readers), {}

    def __getitem__(self, name):
        if name not in self._read:
            self._read[name] = self._readers[name]()
        return self._read[name]

    def __iter__(self):
        return iter(self._readers)

    def __len__(self):
        return len(self._readers)


class Sections(dict):
    """name -> filled settings of previous stages, for a stage that builds anew, in another way, what these built.

    ``sections: Sections`` in a stage takes those that the option ``built_from`` names; they join its hash.
    """


@dataclass(frozen=True)
class Stage:
    """What the runner, the command line and the report need to know about one step."""

    name: str           # 'complex_modes': file, function, YAML section and output file
    run: Callable
    inputs: dict        # argument name -> tuple of product classes that may fill it
    optional: frozenset     # argument names that may stay empty
    reads_all: bool     # True where the argument 'products' takes every product before it
    output: type        # product class
    settings: type      # settings class
    summary: str        # first docstring line: the CLI help
    method: str         # docstring paragraph after 'Method:': the sentence of the report
    companions: Callable | None     # (product, CaseText) -> {file name: str or bytes}, written beside it
    reads_case: bool    # True for the report: everything that it may say about the case joins its hash
    check: Callable     # {stage: settings} -> None; raises for settings that contradict those of other stages
    varied: dict        # argument name -> product class, for arguments that take it from each variant of the case
    variants: Callable  # {stage: settings} -> {name of a variant: {'stage.key': value}}
    check_variants: Callable    # ({stage: settings}, {name of a variant: {stage: settings}}) -> None; as ``check``
    further: Callable | None    # asks for variants by what came of others, see pipeline.contract.further
    built_from: tuple   # names of the stages whose settings the argument 'sections' holds
    only_checked: Callable      # as ``variants``, of some that are refused like these and never computed
    alone: bool         # True where its work is one long task: it then runs beside the stages that do not need it

    def __call__(self, *args, **kwargs):
        """Run the pure function; ``context`` and optional inputs may be left out.

        A ConfigError about something that is a setting of this stage names that setting, and so does a ConvergenceError
        that a shorter step may cure.
        """
        absent = dict.fromkeys(name for name in list(self.inputs)[len(args):] if name in self.optional)
        try:
            return self.run(*args, **{"context": Context(), **absent, **kwargs})
        except ConfigError as error:
            setting = self._setting(error.where)
            if setting is None:
                raise
            raise ConfigError(setting, error.expected, error.found, error.remedy) from error
        except ConvergenceError as error:
            if _SHORTER not in (error.remedy or "") or "step" not in self.settings.model_fields:
                raise
            remedy = error.remedy.replace(_SHORTER, f"lower {self.name}.step")
            raise type(error)(error.where, error.expected, error.found, remedy) from error

    def __reduce__(self):
        """Other processes import the stage from its module."""
        return _imported, (self.run.__module__, self.name)

    def _setting(self, where):
        """'transient.step (time stepping)' for 'time stepping: step', 'steps' if it holds several; else None."""
        part, _, name = str(where).rpartition(": ")
        key = next((k for k in (name, f"{name}s") if part and k in self.settings.model_fields), None)
        return key and f"{self.name}.{key} ({part})"


def _imported(module, name):
    return getattr(importlib.import_module(module), name)


def stage(run=None, **options):
    """Turn ``def name(a: ProductA, settings: Settings, context: Context) -> Name`` into a Stage.

    Options: ``companions``, ``reads_case``, ``check``, ``variants``, ``check_variants``, ``further``, ``built_from``,
    ``only_checked`` and ``alone``, see Stage.
    """
    return partial(_stage, **options) if run is None else _stage(run, **options)


def _stage(run, *, companions=None, reads_case=False, check=lambda sections: None, variants=None,
           check_variants=lambda sections, varied: None, further=None, built_from=(), only_checked=lambda sections: {},
           alone=False):
    hints = get_type_hints(run)
    output, settings = hints.pop("return", None), hints.pop("settings", None)
    context = hints.pop("context", None)
    reads_all = hints.get("products") is Products and hints.pop("products") is Products
    builds = hints.get("sections") is Sections and hints.pop("sections") is Sections
    varied = {name: get_args(hints.pop(name))[0] for name in list(hints) if get_origin(hints[name]) is Variants}
    inputs = {name: _options(hint) for name, hint in hints.items()}
    fits = (is_product(output) and isinstance(settings, type) and issubclass(settings, Section)
            and context is Context and all(inputs.values()) and all(map(is_product, varied.values()))
            and bool(varied) == (variants is not None) and builds == bool(built_from))
    if not fits:
        raise ProductError(f"stage {run.__name__}: annotate the products read, 'settings', 'context' and"
                           f" the product written; Variants of a product go with 'variants', Sections with"
                           " 'built_from'")
    doc, file = inspect.getdoc(run) or "", run.__module__.rpartition(".")[2]
    if not file == run.__name__ == output.name or "Method:" not in doc:
        raise ProductError(f"stage {run.__name__}: file, function and product share one name"
                           f" (found {file}, {output.name}); the docstring needs 'Method:'")
    summary, _, method = doc.partition("Method:")
    optional = frozenset(name for name, hint in hints.items() if type(None) in get_args(hint))
    return Stage(run.__name__, run, inputs, optional, reads_all, output, settings, summary.strip().splitlines()[0],
                 " ".join(method.split()), companions, reads_case, check, varied,
                 variants or (lambda sections: {}), check_variants, further, tuple(built_from), only_checked, alone)


def _options(hint):
    options = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    return tuple(p for p in options if is_product(p))
