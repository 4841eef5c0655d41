"""How large a YAML document may be: bytes, depth, and nodes once each alias is written out. Counted before it is built.

An alias repeats what it names, and aliases of aliases multiply: a few lines may stand for more than any memory holds.
Deep nesting ends the C library that reads it.
"""

import yaml

from pipeline.contract.errors import ConfigError

#: bytes of a document; nested lists and mappings; values, those that aliases repeat included
BYTES, DEPTH, NODES = 2_000_000, 50, 200_000


def refuse_excess(text, name, loader):
    """Refuse a YAML ``text`` beyond these limits, or with an alias within what it names; ``name``: of its file.

    Raises ConfigError, and yaml.YAMLError of a text that is no YAML.
    """
    if len(text.encode(errors="replace")) > BYTES:
        raise ConfigError(name, f"at most {BYTES / 1e6:g} MB of YAML", f"{len(text) / 1e6:.3g} MB")
    sizes, open_nodes = {}, [[None, 0]]     # anchor -> nodes; [anchor, nodes so far] of each open list
    for event in _events(text, name, loader):
        where = f"{name}:{event.start_mark.line + 1}"
        if isinstance(event, yaml.AliasEvent):
            if event.anchor in sizes and sizes[event.anchor] is None:
                raise ConfigError(where, "an alias of what is complete", f"*{event.anchor} within itself")
            open_nodes[-1][1] += sizes.get(event.anchor) or 1
        elif isinstance(event, yaml.ScalarEvent):
            open_nodes[-1][1] += 1
            _note(sizes, event.anchor, 1)
        elif isinstance(event, yaml.CollectionStartEvent):
            open_nodes.append([event.anchor, 1])
            _note(sizes, event.anchor, None)
            if len(open_nodes) > DEPTH:
                raise _too_deep(where)
        elif isinstance(event, yaml.CollectionEndEvent):
            anchor, count = open_nodes.pop()
            open_nodes[-1][1] += count
            _note(sizes, anchor, count)
        if open_nodes[-1][1] > NODES:
            raise ConfigError(where, f"at most {NODES} values, those repeated by aliases included", "more")


def _events(text, name, loader):
    """Events of a text; where a newer libyaml stops at a depth of its own, it is told as beyond ours."""
    try:
        yield from yaml.parse(text, loader)
    except yaml.MarkedYAMLError as error:
        if "nesting depth" in (error.problem or ""):
            raise _too_deep(f"{name}:{error.problem_mark.line + 1}") from None
        raise


def _too_deep(where):
    return ConfigError(where, f"at most {DEPTH} lists and mappings within each other", "more")


def _note(sizes, anchor, count):
    if anchor is not None:
        sizes[anchor] = count
