"""Blocks of the chapter on stability: why each unstable mode grows, with its path over friction and its contacts."""

import re

import numpy as np

from pipeline.products.motion import COUPLING, FALLING, OF_BODY, OF_JOINTS
from pipeline.views.chapters.chapter import Block, Figure
from pipeline.views.figures import friction_paths
from pipeline.views.figures.number_format import number, quantity, span

TWO_PI = 2.0 * np.pi
#: parts of the growth rate below this share of the largest are not listed
_SMALL = 0.05
_PATH_CAPTION = ("Path over friction in the reduced model, at the contact forces of the operating point: the dot is its"
                 " root there. From the dotted line on the mode is unstable.")


def distinct_unstable(modes, count):
    """Indices of unstable modes, most unstable first, each frequency once (within 0.5 %)."""
    return list(np.flatnonzero(modes.unstable_first == np.arange(len(modes.unstable_first)))[:count])


def squealing(modes):
    """True (g,) for the unstable modes that are squeal, by their frequency."""
    return modes.unstable_root.imag >= TWO_PI * modes.squeal_from


def below_squeal(modes):
    """One sentence on unstable modes below squeal; empty without any."""
    low = np.flatnonzero(~squealing(modes))
    if not len(low):
        return ""
    pressure = np.unique(modes.operating_pressure[modes.unstable_operating[low]])
    frequency = modes.unstable_root[low].imag / TWO_PI
    return (f"Below squeal, {span(frequency, 'Hz')} grows at {span(pressure, 'Pa')} (groan or moan, by up to"
            f" {quantity(modes.unstable_root[low].real.max(), '1/s', 3)}).")


def blocks(modes, model, pictures, look):
    """A Block for each followed mode; ``pictures`` (index of the mode -> animation) of some of them."""
    return tuple(_block(modes, model, f, pictures.get(index), look) for f, index in enumerate(modes.followed_mode))


def mechanism(modes, index):
    """Why unstable mode ``index`` grows, in words for a label; None if it was not followed over friction."""
    follow = np.flatnonzero(modes.followed_mode == index)
    return str(modes.followed_mechanism[follow[0]]) if len(follow) else None


def pair(modes, index):
    """The two modes without friction that ``index`` is made of: ((frequency Hz, body name, diameters or None), ...).

    The second is left out where no other is met, or where it could not be followed that far; () if not followed.
    """
    if mechanism(modes, index) is None:
        return ()
    follow = int(np.flatnonzero(modes.followed_mode == index)[0])
    members = zip(modes.pair_root[follow], modes.pair_body[follow], modes.pair_diameters[follow], strict=True)
    known = tuple((root.imag / TWO_PI, str(modes.body_name[body]), int(lines) if lines >= 0 else None)
                  for root, body, lines in members if body >= 0)
    return known if mechanism(modes, index) == COUPLING else known[:1]


def critical_friction(modes, index):
    """Friction coefficient from which on mode ``index`` is unstable; None if it was not followed."""
    follow = np.flatnonzero(modes.followed_mode == index)
    return float(modes.followed_critical[follow[0]]) if len(follow) else None


def _block(modes, model, follow, animation, look):
    index = int(modes.followed_mode[follow])
    root, point = modes.unstable_root[index], modes.unstable_operating[index]
    title = (f"{quantity(root.imag / TWO_PI, 'Hz', 4)}, growth rate {quantity(root.real, '1/s', 3)}, at"
             f" {quantity(modes.operating_pressure[point], 'Pa', 3)} and"
             f" {quantity(modes.operating_speed[point], 'rad/s')}")
    other = "the mode it meets" if mechanism(modes, index) == COUPLING else "the mode most like it"
    figures = [Figure(friction_paths.path(modes, follow, other), _PATH_CAPTION, small=True)]
    if _mappable(modes, model):
        figures.append(_contacts(modes, model, index, look))
    if animation is not None:
        figures.append(Figure(animation, "One period of the mode, strongly enlarged and slowed down; colour: axial"
                              " displacement.", small=True))
    return Block(title, f"{explanation(modes, index)} {budget(modes, index)}", tuple(figures))


def explanation(modes, index):
    """Sentences on mechanism and pair of a followed mode."""
    follow = int(np.flatnonzero(modes.followed_mode == index)[0])
    point, kind = modes.unstable_operating[index], mechanism(modes, index)
    names = [_named(*member) for member in pair(modes, index)]
    start = (f"Unstable from friction {number(critical_friction(modes, index), 3)} on"
             f" ({number(modes.operating_friction[point], 3)} at the operating point).")
    near = modes.followed_nearest[follow]
    apart = f"come within {quantity(near, 'Hz', 2)}" if near else "become equal"
    alike = number(modes.followed_alike[follow], 2)
    if kind == COUPLING:
        other = names[1] if len(names) > 1 else "a mode that could not be followed down to no friction"
        return (f"Mode coupling: with rising friction, {names[0]} meets {other}. Their frequencies {apart}, their"
                f" shapes come to a MAC of {alike}. {start}")
    reason = ("Friction that falls with slip speed feeds it most" if kind == FALLING
              else "Friction feeds a single mode")
    return (f"{reason}: without friction it is {names[0]}, and no other comes close in shape on the way (largest MAC"
            f" {alike}). {start}")


def _named(frequency, body, lines):
    """'7.49 kHz of the inner pad', '7.55 kHz of the disc with 7 nodal diameters'."""
    shape = f" with {lines} nodal diameter{'' if lines == 1 else 's'}" if body == "disc" and lines is not None else ""
    return f"{quantity(frequency, 'Hz', 3)} of the {words(body)}{shape}"


def budget(modes, index):
    """Sentence: what feeds the mode and what dissipates its energy, largest first."""
    growth = modes.unstable_growth[index]
    order, limit = np.argsort(-abs(growth), kind="stable"), _SMALL * abs(growth).max()
    parts = [[f"{words(modes.growth_term[k])} {signed(growth[k])}" for k in order
              if sign * growth[k] > limit] for sign in (1, -1)]
    fed, taken = (", ".join(p) or "nothing" for p in parts)
    return f"Parts of the growth rate in 1/s, small ones left out: fed by {fed}; dissipated by {taken}."


def summed(modes, index):
    """(names, values 1/s) of the terms of the growth rate, those of bodies and joints as one."""
    growth, inside = modes.unstable_growth[index], np.isin(modes.growth_owner, (OF_BODY, OF_JOINTS))
    names = [str(term) for term, hidden in zip(modes.growth_term, inside, strict=True) if not hidden]
    return [*names, "bodies, joints"], [*growth[~inside], growth[inside].sum()]


def losses(modes, index):
    """{'bodies': {name: part of the growth rate in 1/s}, 'joints': ...} of what bodies and joints dissipate."""
    values = list(zip(map(str, modes.growth_owner), map(str, modes.growth_part), modes.unstable_growth[index],
                      strict=True))
    return {name: {part: float(value) for owner, part, value in values if owner == of}
            for name, of in (("bodies", OF_BODY), ("joints", OF_JOINTS))}


def _mappable(modes, model):
    """Whether there are enough contacts for a map, and the model that says where they are."""
    return model is not None and len(model.contact_area) == modes.unstable_contact.shape[1] > 3 * len(
        np.unique(model.contact_body)) and (model.contact_area > 0).all()


def _contacts(modes, model, index, look):
    body = np.asarray(model.contact_body)
    names = [words(modes.body_name[b]) for b in np.unique(body)]
    picture = friction_paths.contact_maps(model.contact_position, model.contact_area, body,
                                          modes.unstable_contact[index], names, look.dpi)
    return Figure(picture, "Growth rate by contact, friction and contact damping together: orange feeds the mode,"
                  " purple dissipates. Seen along the axis of the disc, which turns anticlockwise.", small=True)


def words(name):
    """A name of a body, or of a term with one, as words: 'pad_inner' is 'inner pad'."""
    return re.sub(r"\bpad (\w+)", r"\1 pad", str(name).replace("_", " "))


def signed(value):
    """A growth rate with its sign, in whole 1/s."""
    return f"{value:+.0f}".replace("-", "\N{MINUS SIGN}")
