"""Which effect acts in which analysis, as a table of the documents; 'python -m tests.stages.effect_table' writes it."""

from functools import cache

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.steady_sliding import posed
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import ASPERITIES
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.friction.state_kernels import settles
from pipeline.physics.friction.state_variables import state_kernel
from pipeline.physics.stability.linearisation import maxwell_branches
from pipeline.physics.time_stepping.element_forces import FRICTION
from pipeline.physics.time_stepping.elements import alone
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.commands import ROOT
from tests.stages.effects_on_a_brake import SMALL, acting
from tests.stages.small_structure import small_structure

FILE = ROOT / "docs" / "effects_and_analyses.md"
ROW = "| `{}` | {} | {} | {} | {} |"


def table():
    """Lines of the table of all physics effects outside asperities."""
    rows = [("effect", "location", "small motions", "matrices", "limit cycle"), ("---",) * 5]
    lines = ["| " + " | ".join(cells) + " |" for cells in rows]
    listed = (e for e in CATALOGUE if e.kind == "physics" and e.location != ASPERITIES)
    for effect in sorted(listed, key=lambda e: e.name):
        seen = effect.name in SMALL
        lines.append(ROW.format(effect.name, effect.location, _word(seen),
                                _word(seen and not remembers(effect.name)), _word(seen and cycles(effect.name))))
    return lines


def _word(there):
    return "yes" if there else "no"


@cache
def reduced():
    """Product ReducedModel of the brake of a few elements."""
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


def at_a_brake(name):
    """Posed of the brake of a few elements with an effect."""
    effects = acting(name)
    return posed(reduced(), 0, 10.0, 10.0, physics_terms(effects), conditions(effects))


def remembers(name):
    """Whether an effect has states of its own beside small motions."""
    case = at_a_brake(name)
    states = state_kernel(case.friction(constant(0.4)), case.bench.model.contacts.area)
    return bool(settles(states).any()) or len(maxwell_branches(case.bench.model)[1]) > 0


def cycles(name):
    """Whether the limit cycle takes an effect."""
    case = at_a_brake(name)
    return all(alone((each,)).kind[0] not in FRICTION for each in case.bench.model.elements)


def page():
    """The document with the table as it has to be, which is its end."""
    text = FILE.read_text(encoding="utf-8")
    return text[:text.index("| effect")] + "\n".join(table()) + "\n"


if __name__ == "__main__":
    FILE.write_text(page(), encoding="utf-8")
