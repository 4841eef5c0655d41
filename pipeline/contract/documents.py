"""YAML documents in: strict, with the line of every mistake. The one door of yaml."""

import io
import os
import re
from functools import lru_cache
from pathlib import Path

import yaml

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.files import read_regular
from pipeline.contract.received.yaml_limits import BYTES, refuse_excess

_MERGE = "tag:yaml.org,2002:merge"
#: characters shown of an error of a library
_LONGEST = 200
#: digits of a whole number
_DIGITS = 300
#: numbers to the base 60, as 12:30:45, which YAML 1.2 does not know any more: text here
_SEXAGESIMAL = re.compile(r"[-+]?[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?")


class _StrictLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
    """SafeLoader that refuses a key given twice; 12:30 is a text and no number to the base 60."""

    def construct_scalar(self, node):
        """The text of a scalar; numbers too long to be one are refused with their line."""
        if node.tag == "tag:yaml.org,2002:int" and isinstance(node.value, str) and len(node.value) > _DIGITS:
            raise ConfigError(f"{node.start_mark.name}:{node.start_mark.line + 1}", f"a number of at most {_DIGITS}"
                              " digits", f"{len(node.value)}")
        return super().construct_scalar(node)

    def construct_mapping(self, node, deep=False):
        lines = {}
        for key_node, _ in node.value:
            key, line = key_node.value, key_node.start_mark.line + 1
            if key in lines and key_node.tag != _MERGE:
                raise ConfigError(f"{node.start_mark.name}:{line}", f"'{key}' once",
                                  f"it again (first in line {lines[key]})", "keep one of the two")
            lines[key] = line
        return super().construct_mapping(node, deep)

    def construct_object(self, node, deep=False):
        """The value of a node; of one that is not what its tag says, as ``!!bool 3 m/s``, an error with its line."""
        try:
            return super().construct_object(node, deep)
        except (KeyError, ValueError, TypeError, AttributeError, OverflowError) as error:
            if not isinstance(node, yaml.ScalarNode):
                raise
            why = f" ({error})" if isinstance(error, ValueError) else ""
            raise ConfigError(f"{node.start_mark.name}:{node.start_mark.line + 1}",
                              f"a {node.tag.rpartition(':')[2]}", f"{node.value!r}{why}"[:_LONGEST],
                              "correct it, or quote it if it is a text") from None


def _without_sexagesimal(table):
    """The ``table`` of implicit tags, {first letter: [(tag, pattern)]}, of YAML 1.1 without numbers to the base 60."""
    plain = re.compile(rf"(?!(?:{_SEXAGESIMAL.pattern})\Z)")
    return {letter: [(tag, re.compile(plain.pattern + f"(?:{pattern.pattern})", pattern.flags)
                      if tag.endswith((":int", ":float")) else pattern) for tag, pattern in pairs]
            for letter, pairs in table.items()}


_StrictLoader.yaml_implicit_resolvers = _without_sexagesimal(_StrictLoader.yaml_implicit_resolvers)


def read_yaml(path):
    """The YAML document at ``path`` as plain Python values; {} when it is empty.

    Raises ConfigError with file and line when it is missing, unreadable or not YAML.
    """
    path = Path(path)
    try:
        document = _document(path, state(path))
        return {} if document is None else unshared(document)
    except FileNotFoundError:
        raise ConfigError(path, "a YAML file", "none", "check the path") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(path, "a readable YAML file", str(error)) from None
    except (ValueError, TypeError, AttributeError, RecursionError) as error:     # of a value, such as a 13th month
        raise ConfigError(path, "values that YAML can hold", f"{type(error).__name__}: {error}"[:_LONGEST]) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"{path}:{mark.line + 1}" if mark else path
        raise ConfigError(where, "valid YAML", getattr(error, "problem", None) or str(error)) from None


def state(path):
    """What changes with the file at ``path``: its number, size and times; None where there is none."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


@lru_cache(16)
def _document(path, _):
    """The document at ``path`` in the state that the second argument stands for: variants read the same files."""
    return _loaded(read_regular(path, BYTES).decode("utf-8"), str(path))


def _loaded(text, name):
    """The document of a ``text``; ``name``: of its file, in the marks of errors."""
    refuse_excess(text, name, _StrictLoader)
    loader = _StrictLoader(_Named(text, name))
    try:
        return loader.get_single_data()
    finally:
        loader.dispose()


class _Named(io.StringIO):
    """Text with the name that errors give it."""

    def __init__(self, text, name):
        super().__init__(text)
        self.name = name


def unshared(value):
    """``value`` with a copy of each list or mapping that the document repeats by an alias."""
    if isinstance(value, dict):
        return {key: unshared(inner) for key, inner in value.items()}
    return [unshared(inner) for inner in value] if isinstance(value, list) else value


def yaml_text(document):
    """The document as YAML, keys in their order, long texts folded."""
    return yaml.dump(_plain(document), sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)


def _plain(value):
    """``value`` in plain types only."""
    if isinstance(value, dict):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return str(value) if isinstance(value, str) else value


def parse_value(text):
    """One YAML value from the command line: ``--set key=TEXT``."""
    try:
        return _loaded(text, "--set")
    except (yaml.YAMLError, ValueError, TypeError, AttributeError, RecursionError) as error:
        raise ConfigError(f"--set ...={text}", "a YAML value", getattr(error, "problem", None) or str(error)) from None
