"""YAML documents in: strict, with the line of every mistake. The one door of yaml."""

from pathlib import Path

import yaml

from pipeline.contract.errors import ConfigError


class _StrictLoader(yaml.SafeLoader):
    """SafeLoader that refuses a key given twice."""

    def construct_mapping(self, node, deep=False):
        self.flatten_mapping(node)
        seen = {}
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            line = key_node.start_mark.line + 1
            if seen.setdefault(str(key), line) != line:
                raise ConfigError(f"{node.start_mark.name}:{line}", f"'{key}' once",
                                  f"it again (first in line {seen[str(key)]})", "keep one of the two")
        return super().construct_mapping(node, deep)


def read_yaml(path):
    """The YAML document at ``path`` as plain Python values; {} when it is empty.

    Raises ConfigError with file and line when it is missing, unreadable or not YAML.
    """
    path = Path(path)
    try:
        with path.open(encoding="utf-8") as stream:
            return yaml.load(stream, _StrictLoader) or {}
    except FileNotFoundError:
        raise ConfigError(path, "a YAML file", "none", "check the path") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(path, "a readable YAML file", str(error)) from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"{path}:{mark.line + 1}" if mark else path
        raise ConfigError(where, "valid YAML", getattr(error, "problem", None) or str(error)) from None


def parse_value(text):
    """One YAML value from the command line: ``--set key=TEXT``."""
    try:
        return yaml.load(text, _StrictLoader)
    except yaml.YAMLError as error:
        raise ConfigError(f"--set ...={text}", "a YAML value", getattr(error, "problem", str(error))) from None


def write_yaml(document):
    """``document`` as YAML text, keys in their order."""
    return yaml.safe_dump(document, sort_keys=False, allow_unicode=True)
