"""Chapters: friction and wear of the rough pair, and the friction map."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure
from pipeline.views.figures import contact_spots, friction
from pipeline.views.figures.number_format import number, percent, quantity, span


def micro(product, look):
    """Chapter of the product MicroFriction."""
    middle = (len(product.pressure) // 2, len(product.speed) // 2)
    point = f"{quantity(product.pressure[middle[0]], 'Pa', 3)}, {quantity(product.speed[middle[1]], 'm/s', 3)}"
    new, worn = product.real_area[middle][[0, -1]]
    gain = product.friction[:, :, -1].mean() - product.friction[:, :, 0].mean()
    return Chapter(
        "micro_friction", "Friction and wear of the rough pair",
        f"Both rough solids pressed and slid against each other over {quantity(product.distance[-1], 'm', 3)} at"
        f" {span(product.pressure, 'Pa')} and {span(product.speed, 'm/s')}. The shear stress of a contact spot is"
        f" limited to {quantity(product.shear_limit, 'Pa', 3)}; friction is total shear force over total normal force.",
        f"The coefficient of friction is {span(product.friction, '1')}; wear flattens the peaks, the real contact area"
        f" grows, and friction {'rises' if gain > 0 else 'falls'} by {number(abs(gain), 2)} on average. In full slip"
        " friction is shear limit times real contact area over pressure: the shear limit sets its level and should be"
        f" measured first.{_yielded(product)}",
        (*_spots(product, look, point, new, worn), *_curves(product)))


def _yielded(product):
    """What of the real contact area yields, in a sentence; '' where nothing does."""
    share = (product.yielding_area / product.real_area).max()
    return f" Up to {percent(share)} of the real contact area is at the hardness of the softer body." if share else ""


def _spots(product, look, point, new, worn):
    wear = product.largest_wear.max()
    return (
        Figure(contact_spots.contact_spots(product, 0, look.dpi),
               f"Contact spots, new surfaces, {point}: {percent(new)} of the area carries the whole load."),
        Figure(contact_spots.contact_spots(product, -1, look.dpi),
               f"The same after {quantity(product.distance[-1], 'm', 3)} of sliding: {percent(worn)}."),
        Figure(contact_spots.wear_map(product, "pad", look.dpi),
               f"Wear of the pad, {point}; largest wear of one node in the whole study {quantity(wear, 'm', 3)}."),
        Figure(contact_spots.wear_map(product, "disc", look.dpi),
               f"Wear of the disc, {point}: largest {quantity(product.disc_wear.max(), 'm', 3)}."),
        *_moving(product, look),
        Figure(contact_spots.stress(product, look.dpi),
               f"Von Mises stress in the pad, new, section along sliding at y = {quantity(product.stress_row, 'm', 3)}:"
               f" largest {quantity(product.stress_largest.max(), 'Pa', 3)}, {_depth_of_largest(product)}."),
        Figure(friction.bearing(product), f"Bearing curves, {point}; dashed: new. The highest {percent(_UPPER)} of the"
               f" pad wear down by {quantity(_worn_off(product), 'm', 2)} on average."))


#: dots per inch of the animations, at most, and the share of the area whose wear the bearing curves tell
_MOVING, _UPPER = 80, 0.1


def _moving(product, look):
    """Contact spots and wear of the pad over the recorded distances, in motion."""
    return tuple(Figure(contact_spots.over_cycles(product, what, min(look.dpi, _MOVING)),
                        f"{title} over {len(product.distance)} recorded distances to"
                        f" {quantity(product.distance[-1], 'm', 3)}, animated; the distance is written above.")
                 for what, title in (("spots", "Contact spots"), ("pad", "Wear of the pad")))


def _depth_of_largest(product):
    """Where the von Mises stress is largest, in words."""
    depth = product.stress_depth[product.stress_largest.argmax()]
    return f"{quantity(depth, 'm', 2)} deep" if depth > 0.0 else "on the surface"


def _worn_off(product):
    """Mean loss of height in m of the upper part of the pad."""
    upper = product.bearing_share <= _UPPER
    return (product.pad_bearing[0] - product.pad_bearing[-1])[upper].mean()


def _curves(product):
    first, last = product.real_area[:, :, 0].mean(axis=1), product.real_area[:, :, -1].mean(axis=1)
    scatter = product.friction_std.max(axis=(1, 2))
    speed = abs(product.friction[:, -1] - product.friction[:, 0]).max()
    return (
        Figure(friction.over_distance(product, "real_area"),
               f"Real contact area grows from {span(100 * first, '1')} % to {span(100 * last, '1')} %"
               f" ({span(product.pressure, 'Pa')})."),
        Figure(friction.over_distance(product, "wear_depth"),
               f"Approach of the two bodies by wear: {span(product.wear_depth[:, :, -1], 'm')} at the end."),
        Figure(friction.over_distance(product, "friction"),
               f"Coefficient of friction over sliding distance; band: standard error over {_drawn(product)}, up"
               f" to {number(scatter.max(), 2)}, at {quantity(product.pressure[scatter.argmax()], 'Pa', 3)}."),
        Figure(friction.over_pressure(product),
               "Coefficient of friction over pressure at three sliding distances. Over the computed speeds it varies"
               f" by at most {number(speed, 2)}."),
        *_from_rest(product), *_convergence(product))


def _from_rest(product):
    if not product.presliding_displacement.size:
        return ()
    return (Figure(friction.from_rest(product), "Friction from rest, new surfaces: all spots slip after"
                   f" {span(product.full_slip_distance[:, :, 0], 'm')}. At rest the interface is"
                   f" {span(product.tangential_stiffness, 'Pa/m')} stiff along sliding,"
                   f" {span(product.tangential_stiffness / product.normal_stiffness[:, 0, 0], '1')} of its normal"
                   " stiffness."),)


def _drawn(product):
    """What the standard errors of a MicroFriction are taken over."""
    pairs = len(product.pair_friction)
    return f"{pairs} pairs of surfaces" if pairs > 1 else "positions of the patches"


def _convergence(product):
    if len(product.refinement_area) < 2:
        return ()
    return (Figure(friction.convergence(product), f"Real contact area at the middle pressure over grid refinement."
                   f" {grid_sentence(product)}"),)


def grid_sentence(product):
    """How far the real area, and with it friction, is from that of an infinitely fine grid; product MicroFriction."""
    used = product.refinement_area[np.argmin(abs(product.refinement - product.nodes_per_wavelength))]
    above = used / product.area_limit - 1
    unsure = product.area_limit_error / product.area_limit
    if product.area_order == 0:
        return (f"The last refinement changes it by {percent(unsure, 2)}; two grids tell no limit. Friction is"
                " proportional to it.")
    return (f"On {number(product.nodes_per_wavelength, 2)} nodes a shortest wavelength it is {percent(abs(above), 2)}"
            f" {'above' if above > 0 else 'below'} its limit, {percent(product.area_limit, 3)} ±"
            f" {percent(product.area_limit_error, 1)}, extrapolated at the observed order"
            f" {number(product.area_order, 2)}. Friction is proportional to it.")


#: share of the contact force outside the computed pressures from which on it is told
_TOLD = 0.01
#: pressures below this share of the largest bear too little to be asked for
_LEAST = 0.02


def outside_computed(products):
    """Sentence on contact force at pressures at which friction was not computed; '' where there is next to none."""
    law, modes, model = (products.get(name) for name in ("friction_map", "complex_modes", "reduced_model"))
    if law is None or modes is None or model is None or modes.operating_force.shape[1] != len(model.contact_area):
        return ""
    pressure, computed = modes.operating_force / model.contact_area, law.computed_pressure
    beyond = (pressure < computed.min()) | (pressure > computed.max())
    share = ((modes.operating_force * beyond).sum(axis=1) / modes.operating_force.sum(axis=1)).max()
    if share < _TOLD:
        return ""
    return (f"Up to {percent(share, 2)} of the contact force acts at pressures outside {span(computed, 'Pa')}, where"
            f" friction was not computed. {_wider(computed, pressure[modes.operating_force > 0])}")


def _wider(computed, needed):
    """The pressures in Pa that also reach the ``needed`` ones, as a setting; from the outermost on in steps of two."""
    low, high, asked = max(needed.min(), _LEAST * needed.max()), needed.max(), [*computed]
    while asked[0] > low:
        asked.insert(0, _two_digits(max(low, asked[0] / 2.0), np.floor))
    while asked[-1] < high:
        asked.append(_two_digits(min(high, 2.0 * asked[-1]), np.ceil))
    return f"To widen it: --set micro_friction.pressures='[{', '.join(f'{1e-6 * p:g} MPa' for p in asked)}]'."


def _two_digits(value, rounding):
    scale = 10.0 ** (np.floor(np.log10(value)) - 1.0)
    return rounding(value / scale) * scale


def slopes(product):
    """The slopes of a FrictionMap over pressure and speed with their errors, first new, then worn; '' of one point."""
    return " ".join(filter(None, (_over_pressure(product), _over_speed(product))))


def _over_pressure(product):
    """The slope over pressure at the lowest, middle and highest computed one, mean over speed, and its error."""
    computed = product.computed_pressure
    if len(computed) < 2:
        return ""
    rises, ends = np.gradient(product.friction, np.log(product.pressure), axis=0).mean(axis=1), []
    shown = dict.fromkeys((computed[0], computed[len(computed) // 2], computed[-1]))
    for when, k in _ends(product):
        values = [f"{number(np.interp(p, product.pressure, rises[:, k]), 2)} at {quantity(p, 'Pa', 3)}" for p in shown]
        ends.append(f"{', '.join(values)} {when} (± {number(product.pressure_slope_std[k], 1)} where it is"
                    f" known best, at {quantity(product.best_pressure[k], 'Pa', 2)})")
    return f"Slope over pressure, p dmu/dp: {'; '.join(ends)}."


def _over_speed(product):
    """The slope over speed at the pressure where its error is known, mean over speed; its sign counts as known from two
    standard errors on."""
    if len(product.computed_speed) < 2:
        return ""
    rises, ends = np.gradient(product.friction, np.log(product.speed), axis=1).mean(axis=1), []
    for when, k in _ends(product):
        value = np.interp(product.best_pressure[k], product.pressure, rises[:, k])
        doubt = "" if abs(value) > 2 * product.speed_slope_std[k] else " (sign unknown)"
        ends.append(f"{number(value, 2)} ± {number(product.speed_slope_std[k], 1)} {when}{doubt}")
    return f"Over speed, v dmu/dv: {', '.join(ends)}."


def _ends(product):
    """((in words, index)) of the first and the last distance of a FrictionMap."""
    return ("new", 0), (f"after {quantity(product.distance[-1], 'm', 3)}", -1)


def what_slope_decides(probability):
    """Share of the draws that squeal where friction rises less and more with pressure than usual; '' without draws."""
    sources = [] if probability is None else list(map(str, probability.source))
    if "friction_over_pressure" not in sources or len(probability.value) < 2:
        return ""
    slope = probability.value[:, sources.index("friction_over_pressure")]
    heard = abs(probability.root) >= 2 * np.pi * probability.squeal_from       # as the stage counts them
    squeals = np.isin(np.arange(len(slope)), probability.root_draw[heard])
    low, high = (percent(squeals[half].mean()) for half in (slope <= np.median(slope), slope > np.median(slope)))
    return (f"Within this error the slope over pressure decides as follows: of the draws with the lower half of the"
            f" slopes {low} squeal at some operating point, of those with the upper half {high}.")


def friction_map(product, probability, look):
    """Chapter of the product FrictionMap, with what its slope does to the Probability, where there is one."""
    last = product.friction[:, :, -1]
    return Chapter(
        "friction_map", "Friction map",
        f"Coefficient of friction over sliding speed and pressure after {quantity(product.distance[-1], 'm', 3)} of"
        " sliding. Orange lines: computed. Hatched: outside the computed range, extrapolated as a constant.",
        f"The brake model evaluates this map patch by patch: {span(last, '1')} here, standard error up to"
        f" {number(product.friction_std.max(), 2)}. Interface stiffness {span(product.normal_stiffness, 'Pa/m')}."
        f" {' '.join(filter(None, (slopes(product), what_slope_decides(probability))))}"
        " Results that rest on the hatched part are not reliable; the chapter on pad motion states the fraction of"
        " evaluations that fell there.",
        (Figure(friction.friction_map(product), f"Friction map: {span(last, '1')} over"
                f" {span(product.computed_pressure, 'Pa')} and {span(product.computed_speed, 'm/s')}."),
         Figure(friction.map_error(product), f"Its standard error: {span(product.friction_std[:, :, -1], '1')}.")))
