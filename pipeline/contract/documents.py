"""YAML documents in: strict, with the line of every mistake. The one door of yaml."""

from pathlib import Path

import yaml

from pipeline.contract.errors import ConfigError

_MERGE = "tag:yaml.org,2002:merge"
#: characters shown of an error of a library
_LONGEST = 200


class _StrictLoader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
    """SafeLoader that refuses a key given twice."""

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


def read_yaml(path):
    """The YAML document at ``path`` as plain Python values; {} when it is empty.

    Raises ConfigError with file and line when it is missing, unreadable or not YAML.
    """
    path = Path(path)
    try:
        with path.open(encoding="utf-8") as stream:
            document = yaml.load(stream, _StrictLoader)
            return {} if document is None else _unshared(document)
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


def _unshared(value):
    """``value`` with a copy of each list or mapping that the document repeats by an alias."""
    if isinstance(value, dict):
        return {key: _unshared(inner) for key, inner in value.items()}
    return [_unshared(inner) for inner in value] if isinstance(value, list) else value


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
        return yaml.load(text, _StrictLoader)
    except (yaml.YAMLError, ValueError, TypeError, AttributeError, RecursionError) as error:
        raise ConfigError(f"--set ...={text}", "a YAML value", getattr(error, "problem", None) or str(error)) from None
