"""A deck as read: nodes, solid elements, sets, surfaces, materials, sections, and what was not read."""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from pipeline.contract.errors import ConfigError, first_of

#: solid elements by their number of nodes; bodies have some of them, and the refusal of the others names them
BY_COUNT = {20: "hexahedron20", 27: "hexahedron27", 10: "tetra10", 15: "wedge15", 13: "pyramid13", 8: "hexahedron",
            4: "tetra", 6: "wedge", 5: "pyramid"}
#: side of elements in a surface that has those of their faces that no other element has
FREE = "FREE"
#: largest number of a node or an element, and most of them in a range
_LARGEST, _MOST = 10**15, 50_000_000


@dataclass(frozen=True)
class Spring:
    """A linear spring between two nodes, or of one to the ground, by their numbers or rows.

    ``freedoms``: axis (0, 1, 2) of the displacement of each node; none = along the line through both.
    """

    name: str
    nodes: tuple
    freedoms: tuple
    stiffness: float


@dataclass(frozen=True)
class Deck:
    """Nodes (n, 3) in the units of the deck with their numbers ``label`` (n,), and solid elements.

    ``blocks`` [(kind, numbers (c,), rows of nodes (c, v) in the order of meshio)]; ``node_sets`` and ``element_sets``
    {name: numbers}; ``surfaces`` {name: ((numbers of elements, face as written), ...)}; ``materials`` {name: Material};
    ``sections`` ((numbers of elements, name of the material, axes (3, 3) of all, (k, 3, 3) of each or None), ...);
    ``notes``: sentences on what was not read; ``ties`` ((name, first surface, second surface), ...); ``springs``
    (Spring, ...).
    """

    label: np.ndarray
    node: np.ndarray
    blocks: list
    node_sets: dict
    element_sets: dict
    surfaces: dict
    materials: dict
    sections: tuple
    notes: tuple
    ties: tuple = ()
    springs: tuple = ()


@dataclass
class Draft:
    """What a reader has collected so far; ``where``: beginning of errors; ``scope``: part that it is of."""

    where: str
    label: list = field(default_factory=list)
    position: list = field(default_factory=list)
    elements: dict = field(default_factory=dict)        # kind -> [(number, nodes)]
    node_sets: dict = field(default_factory=dict)       # name -> numbers
    element_sets: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)
    materials: dict = field(default_factory=dict)
    sections: list = field(default_factory=list)
    unread: Counter = field(default_factory=Counter)    # keyword -> times
    notes: list = field(default_factory=list)
    ties: list = field(default_factory=list)            # (where, name, first surface, second surface)
    scope: str = ""
    spring_elements: dict = field(default_factory=dict)     # set -> [(number, type, nodes)]
    spring_values: dict = field(default_factory=dict)       # set -> (degrees of freedom from 1, stiffness)

    def add_element(self, kind, number, nodes):
        """A solid element; ``nodes``: numbers in the order of meshio."""
        self.elements.setdefault(kind, []).append((number, nodes))

    def deck(self):
        """The Deck; ConfigError for numbers that stand twice and for nodes that no line defines."""
        label = np.array(self.label, np.int64)
        _refuse_repeated(self.where, "node", label)
        blocks = [(kind, np.array([number for number, _ in rows], np.int64),
                   np.array([nodes for _, nodes in rows], np.int64)) for kind, rows in self.elements.items()]
        _refuse_repeated(self.where, "element", np.concatenate([numbers for _, numbers, _ in blocks] or [label[:0]]))
        position = np.array(self.position, float).reshape(-1, 3)
        if not np.isfinite(position).all():
            bad = label[~np.isfinite(position).all(axis=1)][0]
            raise ConfigError(self.where, "finite coordinates", f"others of node {bad}")
        order = np.argsort(label)
        blocks = [(kind, numbers, self._rows(label, order, numbers, nodes)) for kind, numbers, nodes in blocks]
        springs = self._springs()
        for name in set(self.spring_elements) - set(self.spring_values):
            for _, kind, _ in self.spring_elements[name]:
                self.unread[f"*ELEMENT of type {kind}"] += 1
        said = [f"{name} ({times} times)" if times > 1 else name for name, times in self.unread.items()]
        notes = [f"not read: {', '.join(said)}"] * bool(said) + self.notes
        sets = ({name: np.unique(np.array(list(each), np.int64)) for name, each in sets.items()}
                for sets in (self.node_sets, self.element_sets))
        return Deck(label, position, blocks, *sets, self.surfaces, self.materials,
                    tuple(self.sections), tuple(notes), tuple(self._tie(*each) for each in self.ties),
                    springs)

    def _springs(self):
        """The Springs whose elements and stiffness the deck holds; what else there is of them counts as not read."""
        springs = []
        for name, (freedoms, stiffness) in self.spring_values.items():
            for label, kind, nodes in self.spring_elements.get(name, ()):
                springs.append(Spring(f"{name}_{label}".lower(), tuple(nodes), () if kind == "SPRINGA" else freedoms,
                                      stiffness))
        return tuple(springs)

    def _tie(self, where, name, *surfaces):
        """A tie; ConfigError for surfaces that nothing defines."""
        for each in surfaces:
            if each not in self.surfaces:
                known = ", ".join(list(self.surfaces)[:8]) or "none"
                raise ConfigError(where, f"surfaces that the deck defines: {known}", repr(each),
                                  "define it, or include the file that does")
        return name, *surfaces

    def _rows(self, label, order, numbers, nodes):
        """Rows of the nodes of elements among ``label``."""
        found = np.searchsorted(label, nodes, sorter=order)
        rows = order[np.minimum(found, len(label) - 1)] if len(label) else np.zeros_like(nodes)
        lacking = np.argwhere((label[rows] != nodes) if len(label) else np.ones(nodes.shape, bool))
        if len(lacking):
            element, vertex = lacking[0]
            raise ConfigError(self.where, "nodes that the deck defines", f"node {nodes[element, vertex]} of element"
                              f" {numbers[element]}, which no line defines",
                              "write the deck with all nodes and includes")
        return rows


def _refuse_repeated(where, kind, numbers):
    values, times = np.unique(numbers, return_counts=True)
    if (times > 1).any():
        raise ConfigError(where, f"one {kind} of each number", f"{kind} {values[times > 1][0]} twice, and"
                          f" {(times > 1).sum() - 1} more", f"renumber, or write each {kind} once")


def listed(name, numbers, most=8):
    """'material 1', 'materials 1, 2' of up to ``most`` numbers, and how many more."""
    texts = [str(number) for number in sorted(numbers)]
    return f"{name}{'s' * (len(texts) > 1)} {first_of(texts, most)}"


def whole(text, where):
    """A whole number of a field; ConfigError for others."""
    try:
        value = int(text)
    except ValueError:
        value = None
    if value is None or abs(value) > _LARGEST:
        raise ConfigError(where, "a whole number", repr(text)[:60])
    return value


def span(first, last, step, where):
    """range from ``first`` to ``last`` inclusive; ConfigError for more numbers than a model can have."""
    if not 0 <= (last - first) / max(step, 1) < _MOST:
        raise ConfigError(where, "a range of numbers: first, last and a step above 0", f"{first}, {last}, {step}")
    return range(first, last + 1, max(step, 1))
