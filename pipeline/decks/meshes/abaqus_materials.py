"""Materials, orientations and solid sections of an Abaqus or CalculiX deck."""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.axes import Axes, in_elements, through
from pipeline.decks.meshes.keywords import number, numbers
from pipeline.decks.meshes.material import BY_COLUMNS, Material, Unread, symmetric

#: numbers of *ELASTIC at each temperature, by its type
_COUNTS = {"ISO": 2, "ISOTROPIC": 2, "ENGINEERING CONSTANTS": 9, "ORTHO": 9, "ORTHOTROPIC": 9, "ANISO": 21,
           "ANISOTROPIC": 21}
#: numbers in a line of data, and the strains that 11, 22, 33, 12, 13 and 23 are among xx, yy, zz, yz, xz, xy
_PER_LINE, _STRAINS = 8, (0, 1, 2, 5, 4, 3)
#: places of D1111, D1122, ... of an orthotropic material among the 21 of an anisotropic one
_ORTHOTROPIC = (0, 1, 2, 3, 4, 5, 9, 14, 20)
#: other elastic laws of a material, which *ELASTIC would have to stand for
_LAWS = ("HYPERELASTIC", "ANISOTROPIC HYPERELASTIC", "HYPERFOAM", "HYPOELASTIC", "POROUS ELASTIC", "USER MATERIAL",
         "LOW DENSITY FOAM", "FABRIC", "MOHR COULOMB", "UMAT")
_WRITE = "write *ELASTIC, TYPE=ISOTROPIC, ENGINEERING CONSTANTS, ORTHOTROPIC or ANISOTROPIC"


@dataclass
class Materials:
    """What the keywords of materials have said so far."""

    current: str = ""       # name of the material that *ELASTIC and *DENSITY belong to
    orientations: dict = field(default_factory=dict)    # (part, name) -> Axes, or why there are none
    sections: list = field(default_factory=list)        # (part, Block, set of elements, material, orientation or "")

    def takes(self, block, draft):
        """Whether ``block`` is one of these keywords, which is then read into the draft or kept."""
        handler = {"MATERIAL": self._material, "ELASTIC": self._elastic, "DENSITY": self._density,
                   "ORIENTATION": self._orientation, "SOLID SECTION": self._section,
                   **dict.fromkeys(_LAWS, self._law)}.get(block.name)
        if handler is None:
            return False
        handler(block, draft)
        return True

    def leave(self, draft, parts):
        """Give the draft its sections; ConfigError for sets, materials and orientations that nothing defines."""
        for scope, block, name, material, orientation in self.sections:
            sets = parts.draft(scope).element_sets
            for kind, each, known in (("a set of elements", name, sets), ("a material", material, draft.materials),
                                      ("an orientation", (scope, orientation), {(scope, ""): 0, **self.orientations})):
                if each not in known:
                    raise ConfigError(block.where, f"{kind} that the deck defines", repr(
                        each if isinstance(each, str) else each[1]), "define it, or include the file that does")
            members = np.array(sets[name], np.int64)
            axes = self._axes(block, draft.materials[material], (scope, orientation), parts.draft(scope), members)
            for first, turned in parts.copied(scope):
                draft.sections.append((members + first, material, _turned(axes, turned, draft.materials[material])))

    def _axes(self, block, material, orientation, part, members):
        """Axes (3, 3) of a section, or (k, 3, 3) of each of its elements ``members`` (k,); None: those of the deck."""
        axes = self.orientations.get(orientation)
        if axes is None or material.young is None or material.isotropic:
            return None
        if isinstance(axes, str):
            raise ConfigError(block.where, f"axes of the material {material.name} that are read",
                              f"{orientation[1]}, {axes}",
                              "write *ORIENTATION, SYSTEM=RECTANGULAR or CYLINDRICAL with coordinates")
        return in_elements(axes, part, members, material, orientation[1])

    def _material(self, block, draft):
        self.current = block.need("NAME").upper()
        if self.current in draft.materials:
            raise ConfigError(block.where, "each material once", f"{self.current} again", "leave one of them out")
        draft.materials[self.current] = Material(self.current)

    def _law(self, block, draft):
        """Another law than *ELASTIC: what there is of it is not read."""
        draft.unread[f"*{block.name}"] += 1
        if self.current and draft.materials[self.current].young is None:
            draft.materials[self.current] = replace(draft.materials[self.current], unread=Unread(
                block.where, f"*{block.name}", _WRITE))

    def _elastic(self, block, draft):
        kind = " ".join(block.given.get("TYPE", "ISOTROPIC").upper().split())
        material = self._named(block, draft)
        if kind not in _COUNTS:
            draft.unread[f"*ELASTIC of type {kind} (material {self.current})"] += 1
            if material.young is None:
                shells = ", which holds in a plane only" if kind == "LAMINA" else ""
                draft.materials[self.current] = replace(material, unread=Unread(
                    block.where, f"*ELASTIC, TYPE={kind}{shells}", _WRITE))
            return
        values, temperature = _at_first_temperature(block, _COUNTS[kind])
        if len(values) == 2:
            material = material.with_isotropic(*values)
        elif kind == "ENGINEERING CONSTANTS":
            e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = values
            material = material.with_constants((e1, e2, e3), (nu23, nu13, nu12), (g23, g13, g12))
        else:
            every = np.zeros(len(BY_COLUMNS))
            every[list(_ORTHOTROPIC) if len(values) == len(_ORTHOTROPIC) else slice(None)] = values
            material = material.with_matrix(symmetric(every, BY_COLUMNS, _STRAINS), block.where)
        draft.materials[self.current] = material
        self._note_temperatures(block, draft, -(-len(values) // _PER_LINE), temperature)

    def _density(self, block, draft):
        (value,), temperature = _at_first_temperature(block, 1)
        draft.materials[self.current] = replace(self._named(block, draft), density=value)
        self._note_temperatures(block, draft, 1, temperature)

    def _note_temperatures(self, block, draft, lines, temperature):
        """Say that values at more than one temperature are given, each of them in so many ``lines``."""
        if len(block.rows) > lines:
            at = f", that of temperature {temperature}," if temperature else ""
            draft.notes.append(f"*{block.name} of {self.current} depends on temperature: its first line{at} is taken")

    def _named(self, block, draft):
        if not self.current:
            raise ConfigError(block.where, f"*MATERIAL before *{block.name}", "none")
        return draft.materials[self.current]

    def _orientation(self, block, draft):
        name, system = block.need("NAME").upper(), block.given.get("SYSTEM", "RECTANGULAR").upper()
        self.orientations[draft.scope, name] = _axes_of(block, " ".join(system.split()))

    def _section(self, block, draft):
        self.sections.append((draft.scope, block, block.need("ELSET").upper(), block.need("MATERIAL").upper(),
                              block.given.get("ORIENTATION", "").upper()))


def _at_first_temperature(block, count):
    """(``count`` numbers of the first temperature, that temperature as written) of a block with lines of 8 numbers.

    An empty field between others is 0, as in the programs themselves. ConfigError for lines that end too soon.
    """
    lines, fields = -(-count // _PER_LINE), []
    for where, row in block.rows[:lines]:
        full = min(count, _PER_LINE * (len(fields) // _PER_LINE + 1))
        fields += row[:-1] if row[-1] == "" else row
        if len(fields) < full:
            raise ConfigError(where, f"{count} numbers of *{block.name}", f"{len(fields)}",
                              f"write {_PER_LINE} numbers in each line before the last" if lines > 1 else None)
        fields = fields[:full] + fields[full:] * (full == count)
    if len(fields) < count:
        raise ConfigError(block.where, f"{count} numbers of *{block.name}", f"{len(fields)}")
    where = block.rows[lines - 1][0]
    return [number(text, where, 0.0) for text in fields[:count]], (*fields[count:], "")[0]


def _axes_of(block, system):
    """Axes of *ORIENTATION in a ``system``, or why they are not read."""
    definition = block.given.get("DEFINITION", "COORDINATES").upper()
    if system not in ("RECTANGULAR", "R", "CYLINDRICAL", "C", "Z RECTANGULAR", "Z") or definition != "COORDINATES":
        return f"whose system is {system} by {definition}"
    first = [text for text in block.rows[0][1] if text] if block.rows else []
    if len(first) == 1 and first[0][:1].isalpha():
        return f"a distribution ({first[0]})"
    values = [number(text, block.rows[0][0], 0.0) for text in first]
    if len(values) not in ((6,) if system in ("CYLINDRICAL", "C") else (6, 9)):
        raise ConfigError(block.where, "two points, or three, of *ORIENTATION", f"{len(values)} numbers")
    point = np.array(values + [0.0] * (9 - len(values))).reshape(3, 3)
    turned = numbers(block.rows[1:2], 0, block.name)
    if turned and turned[0] not in (1, 2, 3):
        raise ConfigError(block.rows[1][0], "axis 1, 2 or 3 that a further turn is about", f"{turned[0]:g}")
    further = ((int(turned[0]) - 1, np.deg2rad(turned[1])),) if len(turned) > 1 and turned[1] else ()
    if system in ("CYLINDRICAL", "C"):
        axis = point[1] - point[0]
        return Axes(through(axis, np.eye(3)[np.argmin(abs(axis))], block.where), point[0], True, further)
    one, other = point[0] - point[2], point[1] - point[2]
    if system in ("Z RECTANGULAR", "Z"):
        return Axes(through(one, other, block.where), point[2], False, further)
    return Axes(through(np.cross(one, other), one, block.where), point[2], False, further)


def _turned(axes, turned, material):
    """Axes of a material, None for those of the deck, in an instance that is turned by ``turned`` (3, 3)."""
    if np.array_equal(turned, np.eye(3)) or material.young is None or material.isotropic:
        return axes
    return (np.eye(3) if axes is None else axes) @ turned.T
