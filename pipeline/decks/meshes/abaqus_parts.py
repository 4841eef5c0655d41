"""Parts of an Abaqus deck and their instances: each instance is a copy in the whole, with numbers of its own.

Sets and surfaces of a part are those of every instance under ``INSTANCE.NAME``, and of all of them together under
``NAME``; an instance is a set of elements of its name.
"""

from dataclasses import dataclass, field

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.deck import Draft, whole
from pipeline.decks.meshes.keywords import number, numbers


@dataclass
class Parts:
    """The draft of the whole deck, that of the part that is being read, and all parts and instances so far."""

    whole: Draft
    current: Draft = None
    drafts: dict = field(default_factory=dict)      # name of a part -> Draft
    copies: dict = field(default_factory=dict)      # name of a part -> [(first number, (3, 3) turn)]
    offsets: dict = field(default_factory=dict)     # name of an instance -> first number
    points: Draft = None                            # reference points of the assembly, which no body has
    step: int = 0

    def __post_init__(self):
        self.current = self.whole

    def takes(self, block):
        """Whether ``block`` is a keyword of parts and instances, which is then acted on."""
        handler = {"PART": self._part, "END PART": self._end, "ASSEMBLY": self._assembly, "END ASSEMBLY": self._end,
                   "INSTANCE": self._instance}.get(block.name)
        if handler is not None:
            handler(block)
        return handler is not None

    def copied(self, scope):
        """[(first number, turn)] of the instances of a part; of ``""``, the deck without parts, the deck itself."""
        return self.copies.get(scope, []) if scope else [(0, np.eye(3))]

    def draft(self, scope):
        """The Draft of a part, or of the deck without parts."""
        return self.drafts[scope] if scope else self.whole

    def first_number(self, block, instance=""):
        """What is added to numbers of the INSTANCE of ``block``; ConfigError for one that is not there."""
        instance = instance or block.given.get("INSTANCE", "").upper()
        if not instance or not self.offsets:
            return 0
        if instance not in self.offsets:
            raise ConfigError(block.where, f"one of the instances {', '.join(self.offsets)}", instance)
        return self.offsets[instance]

    def members(self, text, kind, block, where):
        """Numbers that a number or the name of a set of ``kind`` (nodes or elements) stands for, also INSTANCE.NAME."""
        held = self.current.node_sets if kind == "nodes" else self.current.element_sets
        instance, _, name = text.strip('"').upper().rpartition(".")
        first, instance = self.first_number(block, instance), instance or block.given.get("INSTANCE", "").upper()
        if name.isdigit():
            point = self.current is self.points and not instance
            return [] if point else [whole(name, where) + first]
        key = next((each for each in (f"{instance}.{name}", name) if each in held), None)
        if key is None:
            raise ConfigError(where, f"a number, or one of the sets {', '.join(list(held)[:8]) or 'before it: none'}",
                              repr(text)[:60], "define the set before it is used")
        return list(held[key])

    def _part(self, block):
        name = block.need("NAME").upper()
        if name in self.drafts:
            raise ConfigError(block.where, "each part once", f"{name} again", "leave one of them out")
        shared = {key: getattr(self.whole, key) for key in ("materials", "unread", "notes", "ties")}
        self.current = self.drafts[name] = Draft(self.whole.where, scope=name, **shared)

    def _end(self, block):
        self.current = self.whole

    def _assembly(self, block):
        """Sets of the assembly belong to the whole; its nodes are reference points, whose numbers stand for no body."""
        shared = {key: getattr(self.whole, key) for key in (
            "materials", "unread", "notes", "ties", "node_sets", "element_sets", "surfaces",
            "spring_elements", "spring_values")}
        self.current = self.points = Draft(self.whole.where, **shared)
        for draft in self.drafts.values():
            known = [*draft.label, *(n for rows in draft.elements.values() for n, _ in rows)]
            self.step = max(self.step, 10 ** len(str(max(known, default=0))))

    def _instance(self, block):
        name, part = block.need("NAME").upper(), block.need("PART").upper()
        if part not in self.drafts or name in self.offsets:
            raise ConfigError(block.where, f"an instance of one of the parts {', '.join(self.drafts) or '(none)'},"
                              " each name once", f"{name} of {part}")
        first, (shift, turn) = self.step * len(self.offsets), _placed(block)
        self.offsets[name] = first
        self.copies.setdefault(part, []).append((first, turn))
        _add(self.drafts[part], self.whole, name, first, shift, turn)


def _placed(block):
    """(function of positions (n, 3), turn (3, 3)) of the data lines of *INSTANCE: a shift, then a turn."""
    rows = [[number(text, where, 0.0) for text in fields] for where, fields in block.rows]
    shift = np.array([*(rows[0] if rows else ()), 0.0, 0.0, 0.0][:3])
    if len(rows) < 2:
        return lambda position: position + shift, np.eye(3)
    values = np.array(numbers(block.rows[1:2], 7, block.name))
    begin, end, angle = values[:3], values[3:6], values[6]
    axis = (end - begin) / max(np.linalg.norm(end - begin), np.finfo(float).tiny)
    if not np.linalg.norm(axis) > 0.5:
        raise ConfigError(block.rows[1][0], "an axis through two points", "the same point twice")
    turn = np.deg2rad(angle)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    matrix = np.eye(3) + np.sin(turn) * cross + (1 - np.cos(turn)) * cross @ cross
    return lambda position: (position + shift - begin) @ matrix.T + begin, matrix


def _add(part, into, name, first, move, turn):
    """Copy the Draft of a part into that of the whole as the instance ``name``."""
    into.label.extend(label + first for label in part.label)
    if part.position:
        into.position.extend(map(tuple, move(np.array(part.position))))
    everything = []
    for kind, rows in part.elements.items():
        into.elements.setdefault(kind, []).extend((n + first, [k + first for k in nodes]) for n, nodes in rows)
        everything += [n + first for n, _ in rows]
    into.element_sets.setdefault(name, []).extend(everything)
    for source, target in ((part.node_sets, into.node_sets), (part.element_sets, into.element_sets)):
        for each, members in source.items():
            shifted = [n + first for n in members]
            target[f"{name}.{each}"] = shifted
            target.setdefault(each, []).extend(shifted)
    for each, parts in part.surfaces.items():
        shifted = tuple((n + first, side) for n, side in parts)
        into.surfaces[f"{name}.{each}"] = shifted
        into.surfaces[each] = into.surfaces.get(each, ()) + shifted
