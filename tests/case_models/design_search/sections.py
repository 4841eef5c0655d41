"""Filled sections of the chain own_brake with a design space, without a file."""

from pipeline.contract import case
from stages import CHAINS, load

SPACE = """
    structure.joints.finger_stiffness: {from: 100 MN/m, to: 1000 MN/m, log: true}
    structure.pad.lining_thickness: {from: 9 mm, to: 12 mm, cost: {price: 2 EUR, mass: 0.1 kg}}
    structure.bracket.kind: {values: [ground, body], cost: {price: 10 EUR}}
"""


def loaded(folder, space=SPACE, more="", rest=""):
    """The CaseFile of a brake with this ``space`` and ``more`` lines in its section, ``rest`` after it."""
    path = folder / "brake.yaml"
    path.write_text(f"chain: own_brake\ndesign_search:\n{more}  space:{space or ' {}'}\n{rest}")
    return case.load(path, CHAINS, load)


def sections(folder, space=SPACE, more="", rest=""):
    return loaded(folder, space, more, rest).sections
