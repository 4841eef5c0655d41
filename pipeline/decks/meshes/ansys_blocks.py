"""Commands of an Ansys archive (.cdb), with the lines of data below each."""

import re
from dataclasses import dataclass, field

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.includes import read_lines
from pipeline.decks.meshes.deck import whole
from pipeline.decks.meshes.keywords import number

#: (3i9,6e21.13e3): whole numbers and their width, then numbers and theirs, or texts (19a9), which are passed over
_FORMAT = re.compile(r"\(\s*(\d+)i(\d+)\s*(?:,\s*\d+(?:[efg](\d+)[\d.e]*|a\d+)\s*)?\)", re.IGNORECASE)


@dataclass
class Command:
    """``name`` in capitals, ``values`` behind it as texts, ``rows`` [(where, line)]; ``where``: 'file:line'."""

    name: str
    values: list
    where: str
    rows: list = field(default_factory=list)

    def get(self, index):
        """Value ``index`` from 0 on; '' where there is none."""
        return self.values[index] if index < len(self.values) else ""

    def table(self):
        """Yield (where, whole numbers, numbers) of each row below the line of the format, to the line of -1.

        Raises ConfigError where that line is missing, or a field is no number.
        """
        match = _FORMAT.match(self.rows[0][1].strip()) if self.rows else None
        if not match:
            raise ConfigError(self.where, f"a format such as (3i9,6e21.13e3) below {self.name}",
                              repr(self.rows[0][1].strip()[:40]) if self.rows else "none")
        width, end, wide = int(match[2]), int(match[1]) * int(match[2]), int(match[3] or 0)
        for where, line in self.rows[1:]:
            if line.strip() == "-1":
                return
            cells = (line[k:k + width].strip() for k in range(0, min(len(line), end), width))
            parts = [line[k:k + wide].strip() for k in range(end, len(line), wide)] if wide else []
            yield where, [whole(cell, where) for cell in cells if cell], [number(part, where, 0.0) for part in parts]


def commands(path):
    """Yield the Commands of the file at ``path``; ConfigError for data before the first one."""
    current = None
    for count, text in enumerate(read_lines(path), 1):
        line, where = text.partition("!")[0].rstrip(), f"mesh file {path}:{count}"
        if not line.strip():
            continue
        if line.strip()[0].isalpha() or line.strip()[0] in "/*":
            if current is not None:
                yield current
            name, *values = (part.strip() for part in line.split(","))
            current = Command(name.upper(), values, where)
        elif current is None:
            raise ConfigError(where, "a command such as /PREP7", repr(line[:60]), "check that this is an Ansys archive")
        else:
            current.rows.append((where, line))
    if current is not None:
        yield current
