"""Materials, orientations and solid sections of an Abaqus or CalculiX deck."""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.keywords import number, numbers
from pipeline.decks.meshes.material import Material

#: numbers of *ELASTIC at each temperature, by its type
_COUNTS = {"ISO": 2, "ISOTROPIC": 2, "ENGINEERING CONSTANTS": 9}


@dataclass
class Materials:
    """What the keywords of materials have said so far."""

    current: str = ""       # name of the material that *ELASTIC and *DENSITY belong to
    orientations: dict = field(default_factory=dict)    # (part, name) -> axes (3, 3), or why there are none
    sections: list = field(default_factory=list)        # (part, Block, set of elements, material, orientation or "")

    def takes(self, block, draft):
        """Whether ``block`` is one of these keywords, which is then read into the draft or kept."""
        handler = {"MATERIAL": self._material, "ELASTIC": self._elastic, "DENSITY": self._density,
                   "ORIENTATION": self._orientation, "SOLID SECTION": self._section}.get(block.name)
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
            axes = self._axes(block, draft.materials[material], (scope, orientation))
            for first, turn in parts.copied(scope):
                draft.sections.append((np.array(sets[name], np.int64) + first, material,
                                       _turned(axes, turn, draft.materials[material])))

    def _axes(self, block, material, orientation):
        axes = self.orientations.get(orientation)
        if isinstance(axes, str) and material.young is not None and not material.isotropic:
            raise ConfigError(block.where, "an orientation with fixed Cartesian axes", f"{orientation[1]}, {axes}",
                              "give the material along fixed axes")
        return None if isinstance(axes, str) or material.isotropic else axes

    def _material(self, block, draft):
        self.current = block.need("NAME").upper()
        if self.current in draft.materials:
            raise ConfigError(block.where, "each material once", f"{self.current} again", "leave one of them out")
        draft.materials[self.current] = Material(self.current)

    def _elastic(self, block, draft):
        kind = block.given.get("TYPE", "ISOTROPIC").upper()
        if kind not in _COUNTS:
            draft.unread[f"*ELASTIC of type {kind} (material {self.current})"] += 1
            return
        values, count = numbers(block.rows, _COUNTS[kind], block.name), _COUNTS[kind]
        material = self._named(block, draft)
        if count == 2:
            material = material.with_isotropic(*values[:2])
        else:
            e1, e2, e3, nu12, nu13, nu23, g12, g13, g23 = values[:9]
            material = replace(material, young=(e1, e2, e3), poisson=(nu23, nu13, nu12), shear=(g23, g13, g12))
        draft.materials[self.current] = material
        self._note_temperatures(block, draft, len(values) > count + 1)

    def _density(self, block, draft):
        value = numbers(block.rows, 1, block.name)[0]
        draft.materials[self.current] = replace(self._named(block, draft), density=value)
        self._note_temperatures(block, draft, len(block.rows) > 1)

    def _note_temperatures(self, block, draft, several):
        if several:
            draft.notes.append(f"*{block.name} of {self.current} depends on temperature: its first line is taken")

    def _named(self, block, draft):
        if not self.current:
            raise ConfigError(block.where, f"*MATERIAL before *{block.name}", "none")
        return draft.materials[self.current]

    def _orientation(self, block, draft):
        name, system = block.need("NAME").upper(), block.given.get("SYSTEM", "RECTANGULAR").upper()
        definition = block.given.get("DEFINITION", "COORDINATES").upper()
        if system not in ("RECTANGULAR", "R") or definition != "COORDINATES":
            self.orientations[draft.scope, name] = f"whose system is {system} by {definition}"
            return
        values = [number(text, block.rows[0][0], 0.0) for text in block.rows[0][1] if text] if block.rows else []
        if len(values) not in (6, 9):
            raise ConfigError(block.where, "two points, or three, of *ORIENTATION", f"{len(values)} numbers")
        turned = numbers(block.rows[1:2], 0, block.name)[1:2]
        self.orientations[draft.scope, name] = ("which is turned by a further angle" if turned and turned[0] else
                                   _through(np.array(values + [0.0] * (9 - len(values))), block))

    def _section(self, block, draft):
        self.sections.append((draft.scope, block, block.need("ELSET").upper(), block.need("MATERIAL").upper(),
                              block.given.get("ORIENTATION", "").upper()))


def _turned(axes, turn, material):
    """Axes (3, 3) of a material, None for those of the deck, in an instance that is turned by ``turn`` (3, 3)."""
    if np.array_equal(turn, np.eye(3)) or material.young is None or material.isotropic:
        return axes
    return (np.eye(3) if axes is None else axes) @ turn.T


def _through(values, block):
    """Axes (3, 3) through a point on the first one, one in the plane of the first two, and the origin."""
    first, second = values[:3] - values[6:], values[3:6] - values[6:]
    third = np.cross(first, second)
    if not np.linalg.norm(third) > 0:
        raise ConfigError(block.where, "points that span a plane", "points on one line")
    rows = np.array([first, np.cross(third, first), third])
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)
