"""Files that the decks of finite-element programs include: within the folder of the deck, and followed to their end."""

import re
from pathlib import Path

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.files import open_regular
from pipeline.contract.received.names import within

#: endings of decks whose includes are followed
SUFFIXES = (".inp", ".bdf", ".nas", ".fem", ".dat")
#: files within files at most
DEPTH = 8
#: INPUT=name on a keyword line of Abaqus, and INCLUDE 'name' of Nastran, whose name may go on in the next line
_NAMED = re.compile(rb"""^[ \t]*(?:\*(?!\*)[^\r\n]*?\bINPUT[ \t]*=[ \t]*"?(?P<abaqus>[^",\r\n]+)|"""
                    rb"""INCLUDE[ \t]+(?:'(?P<quoted>[^']+)'|"(?P<double>[^"]+)"|(?P<bare>[^\s'"$]+)))""",
                    re.IGNORECASE | re.MULTILINE)


def included(path, folder, where):
    """Path of the file ``path`` names within ``folder``, that of the deck.

    Raises ConfigError, beginning with ``where``, for one that leads out of the folder or does not exist.
    """
    try:
        file = within(folder, str(path))
    except ConfigError:
        raise ConfigError(where, f"an include within {folder}, the folder of the deck", repr(str(path)),
                          "copy it there, and write its name without a path") from None
    if not file.is_file():
        raise ConfigError(where, "a file to include", f"none at {file}", "copy it into the folder of the deck")
    return file


def opened_in(path, name, parents, where):
    """Path of the include ``name`` of the deck at ``path``; ``parents``: files that are open, outermost first.

    Raises ConfigError as ``included``, and for files that include each other or lie too deep.
    """
    file = included(name, Path(path).parent, where)
    if file.resolve() in parents or len(parents) > DEPTH:
        raise ConfigError(where, f"includes that end, at most {DEPTH} within each other", f"{file.name} within itself"
                          if file.resolve() in parents else "more")
    return file


def read_lines(path):
    """Lines of a regular text file, ends of lines left out; ConfigError for others."""
    try:
        with open_regular(path) as stream:
            return stream.read().decode("utf-8", errors="replace").splitlines()
    except OSError as error:
        raise ConfigError(f"mesh file {path}", "a text file that can be read", error.strerror or str(error)) from None


def joined_name(text):
    """A name that goes on in the next lines, in one."""
    return "".join(line.strip() for line in text.splitlines())


def following(path):
    """Paths of all files that the deck at ``path`` includes, those that exist and lie in its folder; in order."""
    path = Path(path)
    if path.suffix.lower() not in SUFFIXES:
        return ()
    found, waiting = {}, [path]
    while waiting:
        current = waiting.pop()
        try:
            with open_regular(current) as stream:
                names = [next(filter(None, match.groups())) for match in _NAMED.finditer(stream.read())]
        except OSError:
            continue
        for name in names:
            try:
                file = included(joined_name(name.decode(errors="replace")), path.parent, "")
            except ConfigError:
                continue
            if file.resolve() not in found:
                found[file.resolve()] = file
                waiting.append(file)
    return tuple(found.values())
