"""Settings: strict, frozen pydantic models; quantities carry their unit in the YAML.

A section is declared as

    class Settings(Section):
        thickness: Quantity("m", gt=0) = option("6.87 mm", "ring thickness")

and read from ``{thickness: 7 mm}`` or, with its origin, from
``{thickness: {value: 7 mm, origin: stated, source: "Table 1"}}``.
"""

import json
import os
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, ClassVar, NamedTuple, Union, get_args, get_origin

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
    create_model,
    model_validator,
)

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.received import confined
from pipeline.contract.units import example, to_si

#: keys of an annotated YAML value
ORIGINS = ("stated", "inferred", "measured", "tuned", "assumed", "user")
ANNOTATION = {"value", "origin", "source", "doubt", "choose"}


class Section(BaseModel):
    """One YAML section; unknown keys are refused and values are frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=True, allow_inf_nan=False,
                              defer_build=True)
    #: settings that have no effect while another one is 0, none or false: {the other: names}
    only_with: ClassVar[dict] = {}

    @model_validator(mode="before")
    @classmethod
    def _cleared(cls, values):
        """Without lists and mappings that are null but cannot be none: their defaults hold."""
        if not isinstance(values, dict):
            return values
        values = cls.completed(values)
        return {key: value for key, value in values.items()
                if value is not None or not _holds_many(cls.model_fields.get(key))}

    @classmethod
    def completed(cls, values):
        """The written mapping of the section with what it stands for; ValueError for what is at odds. Here as it is."""
        return values

    def decided_by_statement(self):
        """Names of the values that matter not only by their size but also by being stated in the case: none here."""
        return ()


def _holds_many(info):
    """Whether a field is a section, list or mapping, and cannot be none."""
    options = _options(info.annotation) if info else []
    return type(None) not in options and any(get_origin(o) in (tuple, dict) or _is_section(o) for o in options)


def _options(annotation):
    """The types that an annotation allows, without what annotates them."""
    if get_origin(annotation) is Annotated:
        return _options(get_args(annotation)[0])
    unions = (Union, UnionType)
    return [o for a in get_args(annotation) for o in _options(a)] if get_origin(annotation) in unions else [annotation]


def _is_section(annotation):
    return isinstance(annotation, type) and issubclass(annotation, Section)


def section(name, meaning, fields):
    """A Section class from ``fields`` {key: (annotation, option)}, for keys that a catalogue gives."""
    return create_model(name, __base__=Section, __doc__=meaning, **fields)


@dataclass(frozen=True)
class Unit:
    """Marks the SI unit of an annotated setting."""

    name: str


def Quantity(unit, **bounds):  # noqa: N802 - reads as a type in annotations
    """A float in the SI unit ``unit``; ``bounds`` are pydantic's gt, ge, lt, le."""
    spelt = {"type": ["string", "number"], "examples": [example(unit)], "x-unit": unit}
    return Annotated[float, BeforeValidator(lambda v, info: _in_si(v, unit, info)), Field(**bounds),
                     WithJsonSchema(spelt), Unit(unit)]


def Quantities(unit, **bounds):  # noqa: N802
    """A tuple of floats in ``unit``, each within ``bounds``; at least one."""
    return Annotated[tuple[Quantity(unit, **bounds), ...], Field(min_length=1)]


#: names, of which one may be written without a list
Names = Annotated[tuple[str, ...], BeforeValidator(lambda value: (value,) if isinstance(value, str) else value),
                  WithJsonSchema({"type": ["string", "array"], "items": {"type": "string"}})]


def OneOf(*sections):  # noqa: N802
    """One of several sections, distinguished by their key ``kind``."""
    return Annotated[Union[sections], Field(discriminator="kind")]  # noqa: UP007


def option(default, meaning, **more):
    """One setting with its default (``...`` = compulsory) and its meaning."""
    return Field(default, description=meaning, **more)


def stored(section):
    """A filled section as text, for a product that must be built again from it."""
    return section.model_dump_json()


def restored(cls, text):
    """The section that ``stored`` wrote."""
    return cls.model_validate(json.loads(text), context={"stored": True})


def _in_si(value, unit, info):
    if (info.context or {}).get("stored") and isinstance(value, float | int):
        return float(value)
    try:
        return to_si(value, unit, "")
    except ConfigError as error:
        raise ValueError(f"expected {error.expected}, found {error.found}") from None


class Written(str):
    """Text of a YAML document with the ``folder`` of its file, to which paths in the text refer."""

    folder: Path


def written_in(folder, value):
    """The document ``value`` with every text in it as Written in ``folder``."""
    if isinstance(value, dict):
        return {key: written_in(folder, inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [written_in(folder, inner) for inner in value]
    if isinstance(value, str):
        value = Written(value)
        value.folder = folder
    return value


def moved_to(value, folders, destination):
    """The document ``value`` for a file in the folder ``destination``: paths of files relative to it.

    ``folders``: where else the files of the case are searched for.
    """
    if isinstance(value, dict):
        return {key: moved_to(inner, folders, destination) for key, inner in value.items()}
    if isinstance(value, list):
        return [moved_to(inner, folders, destination) for inner in value]
    if not isinstance(value, str) or "/" not in value and "." not in value:
        return value
    beside = (value.folder,) if isinstance(value, Written) else ()
    candidates = [Path(folder) / value for folder in (*beside, *folders)]
    file = next((path for path in candidates if os.path.isfile(path)), None)
    return str(value) if file is None else os.path.relpath(file, destination)


def _existing(value, info: ValidationInfo):
    """Resolve a file: 'measured:NAME', or a path from beside the YAML that names it, its case's folders or here."""
    context = info.context or {}
    if str(value).startswith("measured:"):
        if confined.confined():
            raise ValueError(f"expected a file of the case, found {str(value)!r}")
        try:
            return context["measured"](str(value).removeprefix("measured:"))
        except (BrakechainError, KeyError) as error:
            raise ValueError(str(error)) from None
    beside = (value.folder,) if isinstance(value, Written) else ()
    folders = (*beside, *context.get("folders", ()), ".")
    candidates = dict.fromkeys(Path(folder) / str(value) for folder in folders)
    file = next((path for path in candidates if path.is_file()), None)
    if file is None:
        raise ValueError(f"expected a file, found none at {' or '.join(repr(str(c)) for c in candidates)}")
    if not confined.allowed(file):
        raise ValueError(f"expected a file of the case, found {str(value)!r} outside its folder")
    return file


#: a path; the content of the file joins the hash of its stage
InputFile = Annotated[Path, BeforeValidator(_existing), WithJsonSchema({"type": "string", "description": "a file"})]


def NamedFile(folder):  # noqa: N802
    """An InputFile that may be the name, without ``.yaml``, of a document in ``folder``."""
    names = sorted(path.stem for path in Path(folder).glob("*.yaml"))

    def in_folder(value):
        if value in names:
            return str(Path(folder) / f"{value}.yaml")
        if not isinstance(value, str | Path) or not Path(value).suffix and not str(value).startswith("measured:"):
            raise ValueError(f"expected {', '.join(names)} or a YAML file, found {value!r}")
        return value

    return Annotated[InputFile, BeforeValidator(in_folder)]


def annotated(values):
    """Whether a mapping of a case is a value with its origin; with a key ``unit`` it is a section instead."""
    return isinstance(values, dict) and "value" in values and "unit" not in values


def without_origins(values, where):
    """``values`` with each ``{value:, origin:, source:}`` replaced by its value; ConfigError for a bad annotation."""
    if annotated(values):
        _check_annotation(values, where)
        return without_origins(values["value"], where)
    if isinstance(values, dict):
        return {key: without_origins(value, f"{where}.{key}") for key, value in values.items()}
    if isinstance(values, list):
        return [without_origins(value, f"{where}.{index}") for index, value in enumerate(values)]
    return values


def _check_annotation(values, where):
    for key in values:
        if key not in ANNOTATION:
            near = get_close_matches(str(key), ANNOTATION, 1)
            raise ConfigError(f"{where}.{key}: unknown key beside 'value'; "
                              + (f"did you mean '{near[0]}'?" if near else f"known: {', '.join(sorted(ANNOTATION))}"))
    if values.get("origin", "user") not in ORIGINS:
        raise ConfigError(f"{where}.origin", f"one of {', '.join(ORIGINS)}", repr(values["origin"]))


def fill(cls, values, where, context=None):
    """Build section ``cls`` from a plain mapping; ``where`` is 'file.yaml: stage' for messages.

    ``context``: how to find files, {"folders": Paths, "measured": name -> Path}.
    """
    if not isinstance(values, dict):
        raise ConfigError(where, "a mapping of settings", repr(values))
    try:
        return cls.model_validate(values, context=context)
    except ValidationError as error:
        raise ConfigError("\n".join(_sentence(cls, e, where) for e in error.errors())) from None


class Leaf(NamedTuple):
    """One setting of a filled section: its dotted ``key``, ``value``, SI ``unit`` or '', and ``meaning``.

    ``idle``: the dotted key of the setting that would give it an effect; '' where it has one.
    """

    key: str
    value: Any
    unit: str
    meaning: str
    idle: str


def leaves(section, prefix=""):
    """Yield the Leaf of every setting of a filled section."""
    idle = {name: f"{prefix}{other}" for other, names in section.only_with.items() if not getattr(section, other)
            for name in names}
    for name, info in type(section).model_fields.items():
        value, key = getattr(section, name), f"{prefix}{name}"
        if isinstance(value, Section):
            yield from leaves(value, f"{key}.")
        elif _of_sections(value):
            yield from _within_items(value, key)
        else:
            yield Leaf(key, value, _unit(info), info.description or "", idle.get(name, ""))


def statements(section, prefix=""):
    """Yield (dotted key, names) of every section within a filled one that values decide by being stated."""
    if names := section.decided_by_statement():
        yield f"{prefix}(stated)", list(names)
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, Section):
            yield from statements(value, f"{prefix}{name}.")


def declared(cls, steps):
    """(default as declared, meaning, SI unit or "") of the setting at ``steps``, field names, of section ``cls``."""
    options = _within(cls, steps[:-1])
    info = next(o.model_fields[steps[-1]] for o in options if steps[-1] in o.model_fields)
    return info.default, info.description or "", _unit(info)


def foreign(cls, steps, values):
    """Keys of ``values``, written for the section at ``steps`` of section ``cls``, that sections of another ``kind``
    have there and that of its own does not."""
    options = _within(cls, steps)
    own = [option for option in options if "kind" in option.model_fields
           and option.model_fields["kind"].default == values.get("kind")]
    others = {key for option in options for key in option.model_fields}
    return [key for key in values if key in others and key not in own[0].model_fields] if own else []


def _of_sections(value):
    """Whether a collection holds sections alone, or such collections."""
    items = value.values() if isinstance(value, dict) else value
    return isinstance(value, (tuple, list, dict)) and bool(value) and all(
        isinstance(item, Section) or _of_sections(item) for item in items)


def _within_items(value, key):
    for index, item in value.items() if isinstance(value, dict) else enumerate(value):
        yield from leaves(item, f"{key}.{index}.") if isinstance(item, Section) else _within_items(
            item, f"{key}.{index}")


def _unit(info):
    inner = [m for a in get_args(info.annotation) for m in getattr(a, "__metadata__", ())]
    return next((m.name for m in [*info.metadata, *inner] if isinstance(m, Unit)), "")


def _sentence(cls, error, where):
    location = ".".join([where, *(str(step) for step in error["loc"] if not _is_tag(cls, error["loc"], step))])
    if error["type"] == "extra_forbidden":
        known = sorted(_known_keys(cls, error["loc"][:-1]))
        near = get_close_matches(str(error["loc"][-1]), known, 1)
        remedy = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"
        return f"{location}: unknown key; {remedy}"
    if error["type"] == "missing":
        return f"{location}: expected a value, found none; add it to the YAML"
    message = error["msg"].removeprefix("Value error, ")
    value = "" if "found" in message else f", found {error['input']!r}"
    return f"{location}: {message[0].lower()}{message[1:]}{value}"


def _is_tag(cls, location, step):
    """True for the 'kind' that pydantic puts into the location of an error in a choice of sections."""
    return location.index(step) > 0 and step in _kinds(_within(cls, location[:location.index(step)]))


def _known_keys(cls, location):
    options = _within(cls, location)
    return options[0].model_fields if options else {}


def _within(cls, location):
    """The sections that are allowed at ``location`` of section ``cls``."""
    options = [cls]
    for step in location:
        if step in _kinds(options):
            options = [o for o in options if o.model_fields["kind"].default == step]
        else:
            annotations = [o.model_fields[step].annotation for o in options if step in o.model_fields]
            options = [s for annotation in annotations for s in _sections(annotation)] or options
    return options


def _kinds(options):
    return {o.model_fields["kind"].default for o in options if "kind" in o.model_fields} if len(options) > 1 else set()


def _sections(annotation):
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [s for inner in get_args(annotation) for s in _sections(inner)]
