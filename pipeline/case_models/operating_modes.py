"""Modes of the operating points of a case: what feeds them, on the full matrices where there are, and their fields.

An outcome is one operating point: ``sliding``, its Steady, and of the modes that grow or nearly do ``near`` (g,) 1/s,
``motion`` (n, g) and ``reduced`` (g,) in the reduced model, ``residual`` (g,), ``terms``, ``contacts`` (g, c) and
``shares`` (g, b); ``root`` (r,) are all roots.
"""

from dataclasses import replace
from functools import partial
from itertools import compress

import numpy as np

from pipeline.case_models.friction_paths import followed, on_surface, path_fields
from pipeline.case_models.matrices.full_matrices import Mode, full_modes
from pipeline.physics.modal.disc_modes import by_plane, describe
from pipeline.physics.stability.constrained_modes import is_hard
from pipeline.physics.stability.friction_path import first_of_each
from pipeline.physics.stability.growth_balance import (
    BODY,
    EFFECTS,
    FRICTION,
    HARD,
    JOINTS,
    SLIP,
    Losses,
    body_shares,
    growth_terms,
)
from pipeline.products.motion import OF_BODY, OF_CONTACTS, OF_EFFECTS, OF_JOINTS

DISC = "disc"
#: arrays of an outcome with one row for each of its modes
_OF_MODES = "contacts", "shares", "reduced", "residual"
#: owners of the terms of the growth rate that begin so
_OWNERS = {BODY: OF_BODY, JOINTS: OF_JOINTS, FRICTION: OF_CONTACTS}


def balances(model, sliding, roots, shapes, losses, viscous, settings):
    """(terms of the growth rate of each root, parts (g, c) of the contacts in it, shares (g, b) of the bodies).

    ``roots`` (g,) and ``shapes`` (n, g) of a SlidingModel about ``sliding``, a Steady; ``losses``: its Losses;
    ``viscous`` (n, g): see ``Losses.parts``, or None; ``settings``: the section ``complex_modes``.
    """
    friction, counts = sliding.acting(settings.friction_slopes), (len(roots), len(model.contacts.area))
    remainder = HARD if is_hard(model) else None if sliding.states is None else EFFECTS
    found = [growth_terms(model, friction, root, shapes[:, k], losses, settings.friction_damping, settings.gyroscopic,
                          None if viscous is None else viscous[:, k], remainder) for k, root in enumerate(roots)]
    shares = [body_shares(model, shape) for shape in shapes.T]
    return (tuple(terms for terms, _ in found), np.reshape([parts for _, parts in found], counts),
            np.reshape(shares, (len(roots), len(model.body_name))))


def growing(outcome, settings):
    """The outcome with those of its modes that grow alone."""
    grows = outcome.near.real > settings.neutral * abs(outcome.near)
    return replace(outcome, near=outcome.near[grows], motion=outcome.motion[:, grows],
                   terms=tuple(compress(outcome.terms, grows)),
                   **{name: getattr(outcome, name)[grows] for name in _OF_MODES})


def in_full(about, points, outcomes, contact_body, settings, context):
    """The outcomes with roots that grow or nearly do, and what feeds them, on the full finite-element matrices, about
    the steady sliding of these.

    ``about``: see ``full_modes``; ``points``: Posed of each outcome; ``contact_body`` (c,).
    """
    modes = [Mode(number, number // len(settings.speeds), root, motion) for number, o in enumerate(outcomes)
             for root, motion in zip(o.near, o.motion.T, strict=True)]
    models = [o.sliding.about(case.bench.model) for case, o in zip(points, outcomes, strict=True)]
    solved = full_modes(about, models, modes, partial(_full_balances, contact_body, settings), settings, context)
    return [_replaced(o, [s for s, m in zip(solved, modes, strict=True) if m.operating == number])
            for number, o in enumerate(outcomes)]


def _full_balances(contact_body, settings, model, sliding, roots, vectors):
    """``balances`` of a SlidingModel with complex stiffnesses, with all that its imaginary parts dissipate."""
    return balances(model, sliding, roots, vectors, Losses.within(model, contact_body), None, settings)


def _replaced(outcome, solved):
    """The outcome with those of its near modes that were ``solved`` for on the full matrices; None = not."""
    root, near, residual = outcome.root.copy(), outcome.near.copy(), outcome.residual.copy()
    terms, contacts, shares = list(outcome.terms), outcome.contacts.copy(), outcome.shares.copy()
    for k, mode in enumerate(solved):
        if mode is not None:
            root[np.argmin(abs(root - near[k]))] = mode.root
            near[k], residual[k], terms[k] = mode.root, mode.residual, mode.terms
            contacts[k], shares[k] = mode.contacts, mode.shares
    return replace(outcome, root=root, near=near, residual=residual, terms=tuple(terms), contacts=contacts,
                   shares=shares)


def _strongest_first(outcomes):
    """(operating point, its outcome, number of the mode in it) of all growing modes."""
    unstable = [(number, o, k) for number, o in enumerate(outcomes) for k in range(len(o.near))]
    return sorted(unstable, key=lambda mode: -mode[1].near[mode[2]].real)


def unstable_fields(outcomes, model, bodies):
    """Fields of ComplexModes of the modes of ``growing`` outcomes, strongest first: shapes on the surface, what moves
    and what feeds them.

    ``model``: product ReducedModel; ``bodies``: names of all that move, with what effects add to it.
    """
    unstable, names = _strongest_first(outcomes), list(bodies)
    count = len(unstable)
    shapes = on_surface(model, [o.motion[:, k] for _, o, k in unstable])
    shapes = np.array([_normalised(shape) for shape in shapes]).reshape(shapes.shape)
    growth = [o.terms[k] for _, o, k in unstable]
    terms = list(growth[0]) if unstable else []
    owners = [_owner(term) for term in terms]
    roots, reduced, residual = ([getattr(o, name)[k] for _, o, k in unstable]
                                for name in ("near", "reduced", "residual"))
    return {"unstable_operating": [number for number, *_ in unstable], "unstable_root": roots,
            "unstable_reduced": reduced, "unstable_residual": residual, "unstable_shape": shapes,
            "unstable_diameters": diameters(model, shapes), **planes(model, shapes), "body_name": names,
            "unstable_share": np.reshape([o.shares[k] for _, o, k in unstable], (count, len(names))),
            "growth_term": terms, "growth_owner": [owner for owner, _ in owners],
            "growth_part": [part for _, part in owners],
            "unstable_growth": np.reshape([list(g.values()) for g in growth], (count, len(terms))),
            "unstable_contact": np.reshape([o.contacts[k] for _, o, k in unstable], (count, len(model.contact_area))),
            "unstable_first": first_of_each(np.array(roots, complex))}


def _owner(term):
    """(Owner, name of its part or '') of a term of the growth rate."""
    if term == HARD:
        return OF_CONTACTS, ""
    start = next((start for start in _OWNERS if term.startswith(start)), "")
    return (_OWNERS[start], term.removeprefix(start)) if start else (
        OF_EFFECTS if term == EFFECTS else OF_CONTACTS, "")


def path_fields_of(over, points, outcomes, model, settings, context):
    """Fields of ComplexModes of the paths over friction, in the reduced model: of the strongest unstable modes, each
    frequency once.

    ``over(point, outcome)``: OverFriction of one of the ``points``, one for each outcome.
    """
    unstable = _strongest_first(outcomes)
    first = first_of_each(np.array([o.near[k] for _, o, k in unstable], complex))
    chosen = np.unique(first)[:settings.followed]
    modes, tasks = {}, []
    for c in chosen:
        modes.setdefault(unstable[c][0], []).append(c)
    for number, members in modes.items():
        tasks.append((points[number], outcomes[number], [unstable[c][2] for c in members]))
    found = context.map(partial(_paths, over, settings.neutral), tasks, "paths over friction")
    path_of = {c: path for members, paths in zip(modes.values(), found, strict=True)
               for c, path in zip(members, paths, strict=True)}
    friction = np.array([unstable[c][1].mean_friction for c in chosen])
    terms = [outcome.terms[k] for _, outcome, k in (unstable[c] for c in chosen)]
    falling = [max(each, key=each.get) == SLIP for each in terms]
    return path_fields(chosen, [path_of[c] for c in chosen], friction, falling, model, partial(diameters, model))


def _paths(over, neutral, task):
    """A FrictionPath of each of the modes of an operating point that are asked for, by their numbers."""
    point, outcome, numbers = task
    whole = over(point, outcome)
    return [followed(neutral, whole, outcome.reduced[k], outcome.motion[:, k]) for k in numbers]


def diameters(model, shapes):
    """Nodal diameters (g,) of the disc in the ``shapes`` (g, v, 3) on the surface; -1 without a disc."""
    position, motion = _of_disc(model, shapes)
    return describe(position, motion)[0] if len(position) and len(shapes) else np.full(len(shapes), -1)


def planes(model, shapes):
    """Fields of ComplexModes on the motion of the disc in and out of its plane in the ``shapes`` (g, v, 3)."""
    position, motion = _of_disc(model, shapes)
    none = np.full(len(shapes), -1)
    made = by_plane(position, motion) if len(position) and len(shapes) else (none, none, 0.0 * none)
    return dict(zip(("unstable_in_plane", "unstable_out_of_plane", "unstable_axial"), made, strict=True))


def _of_disc(model, shapes):
    """Surface nodes (d, 3) of the disc, none in a system without one, and the shapes (3d, g) there."""
    names = list(model.body_name)
    on_disc = model.visible_body == (names.index(DISC) if DISC in names else -1)
    return model.visible_position[on_disc], shapes[:, on_disc].reshape(len(shapes), 3 * int(on_disc.sum())).T


def _normalised(shape):
    """The shape with its largest component 1, which also fixes its phase."""
    if not shape.size:
        return shape
    return shape / shape.ravel()[abs(shape).argmax()]
