"""A case: one YAML file = one chain with its settings, each value with its origin."""

import hashlib
import json
import os
from dataclasses import asdict, dataclass, fields, replace
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path

from pipeline import __version__
from pipeline.contract import documents, settings
from pipeline.contract.chain import SECTIONS, from_sections
from pipeline.contract.context import CaseSummary
from pipeline.contract.errors import ConfigError
from pipeline.contract.received import confined

#: top-level keys beside the sections of the stages
HEAD = ("chain", "title", "description", "solver", "based_on")
SOLVERS = ("auto", "pypardiso", "superlu")


def _as_text(name):
    """A name of the file system as text, also where the locale knows no such letters."""
    return os.fsencode(name).decode("utf-8", "replace")


@dataclass(frozen=True)
class CaseText:
    """The name of a case and its whole document, origins included: what a completed case is written from."""

    name: str
    document: dict


@dataclass(frozen=True)
class CaseFile:
    """The YAML of a case, checked completely before anything is computed."""

    path: Path
    document: dict      # as read, overrides applied, origins included
    stages: tuple       # the stages of its chain, in order
    folders: tuple      # where files are searched for that are not beside the YAML that names them
    measured: object = None     # name of a public recording -> its local file
    unread: tuple = ()          # names of stages that will not run, whose sections are not checked

    def __getstate__(self):
        """What another process makes the rest from: settings are filled there anew."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def name(self):
        return self.path.stem

    @property
    def solver(self):
        return self.document.get("solver", "auto")

    @cached_property
    def _filled(self):
        """stage name -> settings that were filled so far; those of a variant begin with what its changes leave."""
        return {}

    @cached_property
    def sections(self):
        """stage name -> filled settings; ConfigError for anything not understood."""
        for stage in self.stages:
            if stage.name not in self._filled and stage.name not in self.unread:
                self._filled[stage.name] = self._section(stage)
        return {stage.name: self._filled[stage.name] for stage in self.stages if stage.name not in self.unread}

    def _section(self, stage):
        where, context = f"{self.path}: {stage.name}", {"folders": self.folders, "measured": self.measured}
        return settings.fill(stage.settings, settings.without_origins(self.given(stage), where), where, context)

    def varied(self, changes):
        """The case with ``changes`` {'stage.key': value} to its settings, as a YAML would give them."""
        document = documents.unshared(self.document)
        for key, value in _kinds_first(changes.items()):
            _change(document, self.stages, key.split("."), value, f"variant: {key}")
        varied = replace(self, document=document)
        changed = {key.partition(".")[0] for key in changes}
        varied._filled.update({name: each for name, each in self._filled.items() if name not in changed})
        return varied

    def check(self):
        """Refuse sections that are not understood or contradict each other, and variants of the case that would be."""
        for stage in self.stages:
            if stage.name not in self.unread:
                stage.check(self.sections)
        for stage in self.stages:
            if stage.varied and not self.unread:
                self._check_variants(stage)

    def _check_variants(self, stage):
        """Refuse variants that ``stage`` declares and that could not run."""
        made = {}
        for name, changes in {**stage.variants(self.sections), **stage.only_checked(self.sections)}.items():
            try:
                variant = self.varied(changes)
                _check_keys(self.path, variant.document, self.stages)
                made[name] = variant.sections
                for each in self.stages:
                    each.check(made[name])
            except ConfigError as error:
                raise ConfigError(f"variant {name} of {stage.name}: {error}") from error
        stage.check_variants(self.sections, made)

    def given(self, stage):
        """The settings of a stage as the YAML gives them, with origins."""
        section = self.document.get(stage.name)
        return {} if section is None else section

    def moved_to(self, folder):
        """CaseText for a file in ``folder``: as run, with paths of files relative to that folder."""
        document = {key: value for key, value in self.document.items() if key != "based_on"}
        return CaseText(self.name, settings.moved_to(document, self.folders, folder))

    @property
    def digest(self):
        """SHA-256 of everything that a report may say about the case."""
        return hashlib.sha256(json.dumps(asdict(self.card(__version__)), default=str).encode()).hexdigest()

    def card(self, version):
        """What the report may say about the case."""
        leaves = {s.name: list(settings.leaves(self.sections[s.name])) for s in self.stages}
        values, units, meanings, idle = ({name: {leaf.key: getattr(leaf, what) for leaf in each}
                                          for name, each in leaves.items()}
                                         for what in ("value", "unit", "meaning", "idle"))
        values = {name: {key: _file_name(value) for key, value in rows.items()} for name, rows in values.items()}
        origins = {s.name: {key: _origin(self.given(s), key.split(".")) for key in values[s.name]} for s in self.stages}
        methods = {s.name: s.method for s in self.stages}
        name, title, description = _as_text(self.name), *(self.document.get(k, "") for k in ("title", "description"))
        return CaseSummary(name, title, description, values, origins, units, meanings, methods, version, idle)


def _file_name(value):
    """A file by its name: reports do not publish paths of this machine."""
    return value.name if isinstance(value, Path) else value


def _origin(given, steps):
    """Annotation of one setting in the YAML, or of the section that holds it; 'user' for a bare value; else {}."""
    annotation = {}
    for step in steps:
        if settings.annotated(given):
            annotation, given = {k: v for k, v in given.items() if k != "value"}, given["value"]
        if isinstance(given, dict) and step in given:
            given = given[step]
        elif isinstance(given, list) and step.isdigit() and int(step) < len(given):
            given = given[int(step)]
        else:
            return annotation
    if settings.annotated(given):
        annotation = {k: v for k, v in given.items() if k != "value"}
    return {"origin": "user", **annotation}


def load(path, chains, stage_of, overrides=(), measured=None, unread=()):
    """Read and check the case at ``path``.

    chains : dict, chain name -> names of its stages in order
    stage_of : function, stage name -> Stage
    overrides : strings 'stage.key=value', as given to --set
    measured : function, name of a public recording -> its local file
    unread : names of stages that will not run, whose sections are not checked
    """
    path = Path(path)
    document, folders = _read(path, chains)
    stages = tuple(stage_of(each) for each in _named(path, document, chains, stage_of))
    for _, item in _kinds_first((item.partition("=")[0], item) for item in overrides):
        _override(document, stages, item)
    _check_keys(path, document, stages)
    case = CaseFile(path, document, stages, folders, measured, tuple(unread))
    case.check()
    return case


def _named(path, document, chains, stage_of):
    """Names of the stages of a document: those of its chain, or those that its sections ask for, which it then says."""
    name = document.get("chain") or SECTIONS
    if name == SECTIONS:
        every = {each: stage_of(each) for each in dict.fromkeys(each for names in chains.values() for each in names)}
        found = from_sections(document, every, path)
        document["chain"] = next((known for known, names in chains.items() if names == found), SECTIONS)
        return found
    if not isinstance(name, str) or name not in chains:
        raise ConfigError(f"{path}: chain", f"one of {', '.join(chains)}, or {SECTIONS}", repr(name))
    return chains[name]


def _read(path, chains, readers=()):
    """The document at ``path`` laid over the one that its key ``based_on`` names, and the folders of both.

    Sections of stages that the chain of this case does not have are not inherited. The heading of a section with
    nothing under it says nothing; elsewhere null takes away what the base states.
    """
    document = documents.read_yaml(path)
    if not isinstance(document, dict):
        raise ConfigError(path, "a mapping of sections", repr(document)[:60])
    document, base = settings.written_in(path.parent, document), document.get("based_on")
    if base is None:
        return {key: _laid_over(None, value) for key, value in document.items()}, (path.parent,)
    file = path.parent / str(base)
    if not confined.allowed(file):
        raise ConfigError(f"{path}: based_on", "a file of the case", f"{base!r} outside its folder")
    if file.resolve() in [reader.resolve() for reader in (*readers, path)]:
        raise ConfigError(f"{path}: based_on", "a file that does not lead back here", repr(base))
    inherited, folders = _read(file, chains, (*readers, path))
    base_chain, chain = (str(name) for name in (inherited.get("chain"), document.get("chain", inherited.get("chain"))))
    foreign = set(chains.get(base_chain, ())) - set(chains.get(chain, ()))
    inherited = {key: value for key, value in inherited.items() if key not in foreign}
    said = {key: value for key, value in document.items() if value is not None or not inherited.get(key)}
    return _laid_over(inherited, said), (path.parent, *folders)


def _laid_over(base, overlay):
    """``overlay`` where it has values, ``base`` elsewhere.

    Mappings with keys are laid over each other, key by key. All else replaces what the base has: values, lists, {}, []
    and null, a mapping of another ``kind``, and one that says ``based_on: null`` of itself.
    """
    if not isinstance(overlay, dict):
        return overlay
    alone = overlay.get("based_on", "") is None
    overlay = {key: value for key, value in overlay.items() if not (alone and key == "based_on")}
    plain = isinstance(base, dict) and not any(map(settings.annotated, (base, overlay)))
    if alone or not plain or not overlay or overlay.get("kind", base.get("kind")) != base.get("kind"):
        base = {}
    return {**base, **{key: _laid_over(base.get(key), value) for key, value in overlay.items()}}


def _kinds_first(pairs):
    """``pairs`` (dotted key, ...), those before that say which kind a section is."""
    return sorted(pairs, key=lambda pair: not pair[0].endswith(".kind"))


def _override(document, stages, item):
    key, equals, text = item.partition("=")
    steps = key.split(".")
    if not equals or len(steps) < 2:
        raise ConfigError(f"--set {item}", "stage.key=value", repr(item))
    _change(document, stages, steps, documents.parse_value(text), f"--set {item}")


def _change(document, stages, steps, value, item):
    """Set the value at ``steps`` of a document in place; a section that becomes another kind loses what only its former
    one had."""
    _set(document, steps, value, item)
    stage = next((each for each in stages if each.name == steps[0]), None)
    if steps[-1] == "kind" and stage is not None and len(steps) > 2:
        node = document
        for step in steps[:-1]:
            node = _step(node, step, item)
        for key in settings.foreign(stage.settings, steps[1:-1], node):
            del node[key]


def _set(document, steps, value, item):
    """Set the value at ``steps`` of a document in place; ``item`` says in errors who asked for it."""
    node = document
    for step in steps[:-1]:
        inner = _step(node, step, item)
        if settings.annotated(inner):       # what is overridden is no longer what was annotated
            inner = node[int(step) if isinstance(node, list) else step] = inner["value"]
        node = inner
    last = int(steps[-1]) if isinstance(node, list) and steps[-1].isdigit() else steps[-1]
    try:
        node[last] = value
    except (IndexError, TypeError):
        raise ConfigError(item, f"a mapping that can hold '{steps[-1]}'", repr(node)[:60]) from None


def _step(node, step, item):
    if isinstance(node, dict):
        if node.get(step) is None:
            node[step] = {}
        return node[step]
    if isinstance(node, list) and step.isdigit() and int(step) < len(node):
        return node[int(step)]
    raise ConfigError(item, f"a mapping that holds '{step}'", repr(node)[:60])


def _check_keys(path, document, stages):
    known = [*HEAD, *(s.name for s in stages)]
    for key in document:
        if key not in known:
            near = get_close_matches(str(key), known, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(known)}"
            raise ConfigError(f"{path}: {key}: unknown section; {hint}")
    if document.get("solver", "auto") not in SOLVERS:
        raise ConfigError(f"{path}: solver", f"one of {', '.join(SOLVERS)}", repr(document["solver"]))
    for key in ("title", "description", "based_on"):
        if not isinstance(document.get(key, ""), str):
            raise ConfigError(f"{path}: {key}", "text", repr(document[key]))
