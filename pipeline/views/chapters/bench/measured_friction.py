"""Chapter: measured friction beside the map of the micro scale, and what it asks to change there."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import measured_friction as pictures
from pipeline.views.figures.number_format import number, percent, plural, span

#: term -> in words
_WORDS = {"level": "its level", "pressure": "how it changes with pressure", "speed": "how it changes with speed",
          "distance": "how fast it changes with sliding distance", "temperature": "how it changes with temperature"}
#: term -> what of the micro scale it tells of
_TELLS = {"level": "the shear limit of the contact spots", "pressure": "the surfaces: their heights and moduli",
          "speed": "the rate of the shear limit", "distance": "wear", "temperature": "softening of the shear limit"}


def chapter(product, look):
    """Chapter of the product FrictionUpdate."""
    runs = plural(len(np.unique(product.run)), "run")
    see = (f"{len(product.friction)} measured coefficients of friction of {runs}, {span(product.friction, '1')}, at"
           f" {span(product.pressure, 'Pa')} and {span(product.speed, 'm/s')}, beside the map at the same conditions.")
    figures = (key_figure(product), Figure(pictures.measured_over_predicted(product), "Measured over predicted."))
    said = (headline(product)[0] + ".", errors(product), asked(product), beyond(product))
    return Chapter("friction_update", "Measured friction beside the map", see, " ".join(filter(None, said)), figures,
                   (_terms(product), _models(product)), limits(product))


def key_figure(product):
    """The figure of the first screen."""
    return Figure(pictures.over_conditions(product), "Measured friction (black), the map (red) and the updated map"
                  " (blue), each group of samples predicted by the others alone.")


def headline(product):
    """(sentence, tone) of the first screen."""
    told = product.fitted if str(product.verdict) == "chance" else product.needed
    named = " and ".join(_WORDS[t] for t in product.term[told > 0])
    said = {"consistent": ("Measured friction agrees with the map", "quiet"),
            "chance": (f"Measured friction differs from the map in {named}, by no more than other patches of the same"
                       " surfaces may", "quiet"),
            "values": (f"Measured friction differs from the map in {named}", "warning"),
            "tie": ("Measured friction differs from the map; these samples do not tell in what", "warning")}
    return said[str(product.verdict)]


def note(product):
    """(question, answer) pairs that the first screen shows."""
    return (("How far off", errors(product)), ("What to change", asked(product)), ("Beyond the map", beyond(product)),
            ("What would tell", would_tell(product)))


def errors(product):
    """The error of the map, of the updated map on samples that it did not see, and the scatter between tests."""
    before, after = (percent(np.sqrt(np.mean(np.log(p / product.friction) ** 2)), 2)
                     for p in (product.mapped, product.unseen))
    scatter = (f" Tests scatter by {percent(product.scatter, 2)} beyond their stated errors." if product.scatter > 1e-3
               else "")
    if not product.fitted.any():
        return f"The map is off by {before} (root mean square).{scatter}"
    return (f"The map is off by {before} (root mean square), with {words(product)} changed by {after} on samples that"
            f" were not fitted.{scatter}")


def words(product):
    """The fitted terms in words."""
    return " and ".join(str(t) for t in product.term[product.fitted > 0])


def asked(product):
    """The settings that the measurements ask to change."""
    if str(product.verdict) == "tie":
        return f"As well as {words(product)} do {', or '.join(map(str, product.alike))}."
    parts = [f"micro_friction.{s} {number(b, 3)} to {number(a, 3)} ± {number(e, 2)}" for s, b, a, e in
             zip(product.setting, product.setting_before, product.setting_after, product.setting_std, strict=True)]
    bare = [str(t) for t in product.term[product.needed > 0] if t == "pressure"]
    said = f"{'; '.join(parts)} (SI)." if parts else ""
    if bare:
        said += " No single setting changes friction over pressure: heights, moduli and hardness of the surfaces do."
    wrong = [str(s) for s, a in zip(product.setting, product.setting_after, strict=True) if a < 0]
    if wrong:
        said += f" {', '.join(wrong)} cannot be negative: another physics makes friction fall there."
    if any(s == "third_body_factor" and a > 1 for s, a in zip(product.setting, product.setting_after, strict=True)):
        said += " A film is no stronger than the disc (third_body_factor of 1): state a higher disc_strength."
    return said.strip()


def beyond(product):
    """How many samples lie beyond the map."""
    count = int(product.outside.sum())
    if not count:
        return ""
    return (f"{count} of {len(product.friction)} samples lie beyond the map, which is constant there: widen"
            " micro_friction.pressures, disc_speeds or recorded_distances.")


def would_tell(product):
    """Which terms the samples cannot tell, and what would."""
    missing = [str(t) for t in product.term[product.tested == 0]]
    return f"Not tried, as these samples hardly vary it: {', '.join(missing)}." if missing else ""


def limits(product):
    """What the comparison can and cannot carry."""
    return ("Each term is a straight line in the logarithm of friction about the means of the samples; its standard"
            " error and that of the map count together. What is left beyond stated errors counts as scatter between"
            " tests.",
            "The map knows no bulk temperature: the term of temperature stands for softening of the shear limit by it.")


def _terms(product):
    every = zip(product.term, product.needed, product.fitted, product.tested, product.value, product.value_std,
                product.map_std, product.p_value, strict=True)
    rows = [(str(t), _TELLS[str(t)], "yes" if n else "chance" if f else "no" if k else "not tested", number(v, 3),
             number(e, 2), number(m, 2), f"{p:.2g}") for t, n, f, k, v, e, m, p in every]
    return Table(("term", "tells of", "needed", "change of ln(mu)", "standard error", "error of the map", "p"),
                 tuple(rows), "Terms by which the map may be off", (3, 4, 5, 6))


def _models(product):
    rows = [(str(m), number(b, 3)) for m, b in zip(product.model, product.bic, strict=True)]
    return Table(("terms", "BIC less that of the map"), tuple(rows), "Sets of terms that were compared", (1,),
                 folded=True)
