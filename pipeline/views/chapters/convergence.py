"""Chapter: do unstable modes stay where they are on finer meshes, without reduction?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures import convergence as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity

TWO_PI = 2.0 * np.pi
#: refinement -> what it is called
WORDS = {"contact": "contact points", "pad_mesh": "mesh of the pads", "disc_mesh": "mesh of the disc",
         "caliper_mesh": "mesh of the caliper", "bracket_mesh": "mesh of the bracket",
         "piston_mesh": "mesh of the piston", "bases": "bases of the reduced model"}
#: cause -> what it is called
CAUSES = WORDS | {"model": "finite elements in their own sliding state"}


def chapter(convergence, look):
    """Chapter of the product Convergence."""
    there = f"{quantity(convergence.pressure, 'Pa', 3)} and {quantity(convergence.speed, 'rad/s')}"
    return Chapter(
        "convergence", "Convergence of the unstable modes",
        f"{_refined(convergence)} at {there}. {_left_out(convergence)}Elements through the thickness of disc and"
        " backplates, friction map, interface law and joints stay the same: their errors are not judged here.",
        statement(convergence), _figures(convergence), _tables(convergence))


def _refined(convergence):
    meshes = [WORDS[str(name)] for name in convergence.refinement if name != "bases"]
    if not meshes:
        return ("Finite elements of the meshes of this case beside its reduced model: meshes and contact points were"
                " not refined")
    others = plural(len(convergence.near_root), "further mode")
    return (f"Refined at once: {_listed(meshes)}, {_size(convergence.refined_freedoms, convergence.refined_contacts)}"
            f" instead of {_size(convergence.freedoms, convergence.contacts)}. The finer model has no modes or bases;"
            f" every unstable mode, and {others} that nearly grow, were followed into it from their shapes,")


def _size(freedoms, contacts):
    return f"{int(freedoms):,} degrees of freedom and {int(contacts):,} contact points"


def _left_out(convergence):
    """What was not refined and why; empty where all was."""
    reasons = dict(zip(map(str, convergence.left_out), map(str, convergence.left_out_reason), strict=True))
    parts = [f"the {WORDS[name]}, which {reason}" for name, reason in reasons.items()]
    return f"Not refined: {_listed(parts)}. " if parts else ""


def _listed(words):
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def statement(convergence):
    """One or two sentences: converged and how far, or not and where; what moved most; what was not refined."""
    allowed = (f"{percent(convergence.frequency_tolerance, 2)} of a frequency, and"
               f" {percent(convergence.growth_tolerance)} or {quantity(convergence.neutral, '1/s')} of a growth rate")
    differences = list(_differences(convergence))
    if differences:
        times = f"the error estimated as {number(convergence.error_factor, 2)} times the change by finer meshes"
        return (f"Not converged within {allowed}, {times}: {'; '.join(differences)}.{_mover(convergence)}"
                f"{_unjudged(convergence)}")
    on = "without the reduction" if list(convergence.refinement) == ["bases"] else "in the finer model"
    if not len(convergence.root):
        stay = f"no mode is unstable {on} either"
    else:
        stay = (f"the same modes are unstable {on}, their frequencies within"
                f" {percent(convergence.frequency_change, 2)} and growth rates within {_growth(convergence)}")
    if convergence.converged.item():
        where = f"{quantity(convergence.pressure, 'Pa', 3)} and {quantity(convergence.speed, 'rad/s')}"
        return f"Converged at {where}, where it was tried: {stay}.{_error(convergence)}"
    return (f"Not shown to be converged: {unrefined(convergence)}. {stay[0].upper()}{stay[1:]}."
            f"{_unjudged(convergence)}")


def _growth(convergence):
    """Largest change of a growth rate; as a share too, unless only its size made it pass."""
    change = quantity(convergence.growth_change, "1/s", 2)
    share = convergence.growth_share
    return f"{percent(share, 2)} ({change})" if share <= convergence.growth_tolerance else change


def unrefined(convergence):
    """In short, what the comparison leaves unjudged: all meshes, some of them, or so many."""
    names = [WORDS[str(name)] for name in convergence.left_out]
    if not any(str(name) != "bases" for name in convergence.refinement):
        return "no mesh was refined"
    if len(names) > 2:
        return f"{len(names)} of {len(names) + len(convergence.refinement)} parts were not refined"
    return f"{_listed(names)} {'was' if len(names) == 1 else 'were'} not refined"


def _error(convergence):
    """What the changes by finer meshes say of the meshes of the case."""
    if not len(convergence.root):
        return ""
    change = convergence.refined_root - convergence.root
    growth = convergence.error_factor * abs(change.real)
    frequency = convergence.error_factor * abs(change.imag) / convergence.root.imag
    return (f" By extrapolation at second order, frequencies are within {percent(frequency.max(), 2)} and growth rates"
            f" within {quantity(growth.max(), '1/s', 2)} of those on meshes refined without limit.")


def _unjudged(convergence):
    """That what was not refined may be in error."""
    names = [WORDS[str(name)] for name in convergence.left_out]
    return f" Not refined, and of unknown error: {_listed(names)}." if names else ""


def unjudged(convergence):
    """Whether nothing speaks against convergence, and not everything was refined."""
    return not convergence.converged.item() and not any(_differences(convergence))


def _differences(convergence):
    """What the finer model changes beyond the tolerances."""
    lost = [k for k in range(len(convergence.root)) if not convergence.held[k]]
    yield from (_difference(convergence, k) for k in lost[:3])
    if len(lost) > 3:
        yield f"{plural(len(lost) - 3, 'more mode')} changed"
    if convergence.added.item():
        yield f"the finer model has {plural(int(convergence.added), 'further unstable mode')}"


def _difference(convergence, mode):
    root, reduced, refined = (getattr(convergence, name)[mode] for name in ("root", "reduced_root", "refined_root"))
    where = quantity(root.imag / TWO_PI, "Hz")
    if not convergence.found[mode]:
        return f"{where} is gone"
    if refined == root:
        return f"{where}: {number(reduced.real, 3)} 1/s in the reduced model, {number(root.real, 3)} without reduction"
    stable = ", stable" if refined.real <= 0 else ""
    return f"{where}: {number(root.real, 3)} becomes {number(refined.real, 3)} 1/s{stable}"


def _mover(convergence):
    """What moved the modes most; empty where that was not asked."""
    if not len(convergence.cause):
        return ""
    size = abs(convergence.cause_change.real).max(axis=1)
    most = int(np.argmax(size))
    return f" What moved them most: {CAUSES[str(convergence.cause[most])]}, {quantity(size[most], '1/s', 2)}."


def _figures(convergence):
    if not len(convergence.root):
        return ()
    return (Figure(pictures.growth_changes(convergence),
                   "Growth rate of each unstable mode in this case (line), in its reduced model and in the finer one"
                   f" (marks); band: {percent(convergence.growth_tolerance)} or"
                   f" {quantity(convergence.neutral, '1/s')}."),)


def _tables(convergence):
    tables = []
    if len(convergence.root):
        rows = [(quantity(root.imag / TWO_PI, "Hz", 5), quantity(root.real, "1/s", 3), _change(root - reduced, root),
                 _change(refined - root, root) if seen else "gone")
                for root, reduced, refined, seen in zip(convergence.root, convergence.reduced_root,
                                                        convergence.refined_root, convergence.found, strict=True)]
        title = "Unstable modes, and how they change: frequency in %, growth rate in 1/s"
        head = ("frequency", "growth rate", "without reduction", "finer model")
        tables.append(Table(head, tuple(rows), title, (1, 2, 3)))
    if len(convergence.near_root):
        rows = [(quantity(root.imag / TWO_PI, "Hz", 5), quantity(root.real, "1/s", 3), _change(new - root, root))
                for root, new in zip(convergence.near_root, convergence.near_refined, strict=True)]
        tables.append(Table(("frequency", "growth rate", "finer model"), tuple(rows),
                            "Modes that nearly grow in the reduced model, followed too", (1, 2)))
    if len(convergence.cause):
        head = ("refined by itself", *(quantity(root.imag / TWO_PI, "Hz", 5) for root in convergence.moved_root))
        rows = [(CAUSES[str(name)], *(_change(change, root) if change else "\N{EN DASH}" for change, root in zip(
            changes, convergence.moved_root, strict=True)))
                for name, changes in zip(convergence.cause, convergence.cause_change, strict=True)]
        tables.append(Table(head, tuple(rows), "What moves the modes that do not stay: frequency in %, growth rate in"
                            " 1/s", tuple(range(1, len(head)))))
    return tuple(tables)


def _change(change, root):
    return f"{100 * change.imag / root.imag:+.2f} %, {change.real:+.1f}".replace("-", "\N{MINUS SIGN}")
