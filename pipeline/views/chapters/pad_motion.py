"""Chapter: motion of the pads under friction that varies from patch to patch."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure
from pipeline.views.figures import pad_motion as pictures
from pipeline.views.figures.number_format import THIN, number, percent, plural, quantity, span


def chapter(multibody, look):
    """Chapter of the product Multibody."""
    low, high = extremes(multibody)
    decided = multibody.growth_decided > 0
    growing, points = int((decided & (multibody.growth_rate > 0)).sum()), len(decided)
    figures = [_motion(multibody, low, look), _motion(multibody, high, look), _forces(multibody, low, look),
               _forces(multibody, high, look),
               Figure(pictures.growth(multibody, look.dpi), "Growth rate fitted to the envelope of the pad oscillation"
                      f" along sliding: {span(multibody.growth_rate, '1/s')}; negative: damped.")]
    figures += [_stability(multibody, operating, look) for operating in (low, high)]
    return Chapter(
        "multibody", "Pad motion on the patchy disc",
        "Flexible pads on a disc made of four rigid sub-discs of friction patches; the friction of each patch"
        f" comes from the map. {len(multibody.pressure)} operating points, {quantity(multibody.time[-1], 's', 3)} each;"
        " shown are the lowest and the highest load, as in Figures 13 to 16 of the paper.",
        f"The oscillation is damped at {decided.sum() - growing}, grows at {growing} and is undecided (within two"
        f" standard errors of zero) at {points - decided.sum()} of {points} operating points."
        f" The mean friction was {span(multibody.mean_friction, '1')};"
        f" contact was lost for {span(100 * multibody.separated_share, '1', 2)} % of the samples, and"
        f" {span(100 * multibody.outside_map_share, '1', 2)} % of the friction evaluations fell outside the computed"
        " map. The support stiffnesses of caliper and abutments decide the result: see the stability map, whose most"
        f" unstable roots lie at {span(multibody.stability_root, 'Hz')}. {_energy(multibody)}",
        tuple(figures))


#: error of the energy balance above which the page warns
_OPEN = 0.01


def open_balance(multibody):
    """Sentence on energy that is missing from the pad motion, or that nothing has fed; '' where next to none is."""
    if multibody is None or not (multibody.imbalance > _OPEN).any():
        return ""
    share, points = multibody.imbalance, plural(len(multibody.pressure), "operating point")
    return (f"The energy balance of the pad motion is open by up to {percent(share.max(), 2)} of the energy exchanged,"
            f" by more than {percent(_OPEN, 1)} at {(share > _OPEN).sum()} of {points}: shorten multibody.step, or"
            " lower multibody.record_every.")


def _energy(multibody):
    """Where the energy of the highest load goes, and whether the balance closes."""
    _, high = extremes(multibody)
    heat, fed, lost = (getattr(multibody, name)[high] for name in ("sliding_loss", "friction_work", "damping_loss"))
    closes = open_balance(multibody) or f"The energy balance closes within {percent(multibody.imbalance.max(), 2)}."
    return (f"At {point(multibody, high)}, friction turns {quantity(heat, 'J', 3)} into heat and does"
            f" {quantity(fed, 'J', 2)} of work on the pads; pads, caliper and joints lose {quantity(lost, 'J', 2)},"
            f" {percent(multibody.added_loss[high], 2)} of it in the damping of static answers. {closes}")


def extremes(product):
    """Operating points of lowest and highest load (pressure, then speed)."""
    order = np.lexsort((product.speed, product.pressure))
    return int(order[0]), int(order[-1])


def point(product, operating):
    """'3 MPa, 12 rad/s'."""
    return f"{quantity(product.pressure[operating], 'Pa', 3)}, {quantity(product.speed[operating], 'rad/s')}"


def rate_in_words(multibody, operating):
    """'8 ± 2 1/s', or '3 ± 4 1/s (sign undecided)'."""
    rate, deviation = multibody.growth_rate[operating], multibody.growth_rate_std[operating]
    undecided = "" if multibody.growth_decided[operating] else " (sign undecided)"
    return f"{number(rate, 3)} ± {quantity(deviation, '1/s', 2)}{undecided}"


def _motion(multibody, operating, look):
    second = multibody.pad_motion[operating, :, 0, len(multibody.time) // 2:]
    return Figure(pictures.pad_motion(multibody, operating, look.dpi),
                  f"Pad motion along sliding at {point(multibody, operating)}: growth rate"
                  f" {rate_in_words(multibody, operating)} at"
                  f" {quantity(multibody.oscillation_frequency[operating], 'Hz')};"
                  f" {quantity(np.ptp(second, axis=1).max(), 'm', 3)} peak to peak in the second half.")


def _forces(multibody, operating, look):
    mean = multibody.patch_force[operating, 0].sum(axis=0).mean()
    return Figure(pictures.patch_forces(multibody, operating, 0, look.dpi),
                  f"Normal forces of the four sub-discs on the {multibody.pad_name[0]} pad at"
                  f" {point(multibody, operating)}; together {quantity(mean, 'N', 3)} on average. A sub-disc carries"
                  " load while its patches pass under the pad.")


def _stability(multibody, operating, look):
    values = multibody.stability[operating]
    unstable = percent((values > 0).mean(), 2)
    return Figure(pictures.stability_map(multibody, operating, look.dpi),
                  f"Stability of the linearised pads over caliper and abutment stiffness at"
                  f" {point(multibody, operating)}: largest growth rates {number(values.min(), 3)} to"
                  f" {number(values.max(), 3)}{THIN}1/s, {unstable} of the map unstable (orange). Star: this case;"
                  " black line: the limit.")
