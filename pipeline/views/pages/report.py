"""The report page: one self-contained HTML file, sections in the order of the chain."""

from functools import partial

from pipeline.views.chapters import (
    comparison,
    complex_modes,
    convergence,
    friction,
    friction_descriptions,
    limit_cycle,
    pad_motion,
    probability,
    structure,
    surface,
    vibration,
)
from pipeline.views.chapters.bench import (
    bench,
    diagnosis,
    line_evidence,
    measured_friction,
    modal_test,
    model_update,
    noise_events,
    orders,
    recording,
    response_functions,
)
from pipeline.views.chapters.chapter import Figure
from pipeline.views.chapters.models import (
    beam_on_beam,
    countermeasures,
    design_search,
    lock_in,
    lumped,
    matrix_modes,
    noise_matrix,
    rupture,
    sensitivities,
    transient,
)
from pipeline.views.figures import complex_modes as stability_pictures
from pipeline.views.figures import vibration as sound_pictures
from pipeline.views.figures.models import rupture as rupture_pictures
from pipeline.views.pages import case_settings as case_view
from pipeline.views.pages.limits import limits
from pipeline.views.pages.summary import published_squeal, verdict
from pipeline.views.pages.system import system
from pipeline.views.pages.template import template
from pipeline.views.pages.to_measure import statement, to_measure

#: what a chapter may be given besides products: the squeal frequencies among the published facts
_PUBLISHED = "published squeal"
#: product -> what writes its chapter, and which other products that reads
CHAPTERS = {
    "surface": (surface.chapter, ()),
    "micro_friction": (friction.micro, ()),
    "friction_map": (friction.friction_map, ("probability",)),
    "interface_law": (lock_in.interface_law, ()),
    "friction_descriptions": (friction_descriptions.chapter, ()),
    "structure": (structure.chapter, ("complex_modes",)),
    "pin_on_disc": (lock_in.pin_on_disc, ()),
    "beam_on_beam": (beam_on_beam.beams, ("complex_modes", "comparison")),
    "lumped": (lumped.chapter, ("transient",)),
    "matrices": (matrix_modes.system, ()),
    "matrix_modes": (matrix_modes.chapter, ()),
    "complex_modes": (complex_modes.chapter, ("reduced_model", _PUBLISHED)),
    "convergence": (convergence.chapter, ()),
    "limit_cycle": (limit_cycle.chapter, ()),
    "probability": (probability.chapter, ()),
    "sensitivities": (sensitivities.chapter, ("convergence",)),
    "design_search": (design_search.chapter, ()),
    "countermeasures": (countermeasures.chapter, ()),
    "multibody": (pad_motion.chapter, ()),
    "transient": (transient.chapter, ()),
    "lock_in": (lock_in.lock_in, ()),
    "motion_scatter": (beam_on_beam.scatter, ("comparison",)),
    "beam_geometry": (beam_on_beam.geometry, ()),
    "response": (vibration.response, (_PUBLISHED,)),
    "squeal": (vibration.squeal, (_PUBLISHED,)),
    "rupture": (rupture.chapter, ()),
    "recording": (recording.chapter, ()),
    "noise_events": (noise_events.chapter, ()),
    "orders": (orders.chapter, ()),
    "response_functions": (response_functions.chapter, ()),
    "modal_test": (modal_test.chapter, ()),
    "model_update": (model_update.chapter, ()),
    "line_evidence": (line_evidence.chapter, ()),
    "noise_matrix": (noise_matrix.chapter, ()),
    "friction_update": (measured_friction.chapter, ()),
    "bench": (bench.chapter, ()),
    "diagnosis": (diagnosis.chapter, ()),
    "comparison": (comparison.chapter, ()),
}
#: the chapter whose pictures move, which takes longest
LONGEST = "complex_modes"
#: products without a chapter, and where the page shows what they hold
NO_CHAPTER = {"effects": "the settings", "reduced_model": "the chapter of complex_modes", "report": "the page itself"}


def plan(products, look):
    """{name: function without arguments} of each chapter whose product is there, in chain order.

    A chapter is None where its product has nothing to say.
    """
    published = published_squeal(products.get("comparison"))

    def given(name):
        return published if name == _PUBLISHED else products.get(name)

    return {name: partial(write, products[name], *map(given, others), look)
            for name, (write, others) in CHAPTERS.items() if products.get(name) is not None}


def page(chapters, products, case, look):
    """HTML text of the report; the same arguments give the same bytes."""
    return _rendered(chapters, products, case, verdict(products, case_view.tuned(case)), _key_figures(products, look))


def early_page(told, products, case, note, look=None):
    """HTML text of the first screen while a chain runs: a Verdict with a ``note`` on what it stands on; no chapters.

    ``look``: how its key figure is drawn; None: it has none.
    """
    return _rendered((), products, case, told, _key_figures(products, look) if look else (), note)


def unfinished(told, products, case, look, note):
    """HTML text of a report whose chain did not end: a Verdict with a ``note`` on what failed, and the chapters of the
    ``products`` that are there."""
    chapters = [chapter for chapter in (write() for write in plan(products, look).values()) if chapter is not None]
    return _rendered(chapters, products, case, told, _key_figures(products, look), note, list(products))


def _rendered(chapters, products, case, told, key_figures, note="", done=None):
    """``done``: names of the stages whose methods are printed; None: all, none on a page with a ``note``."""
    facts = products.get("comparison")
    silent = set(CHAPTERS) & set(products) - {chapter.anchor for chapter in chapters}
    methods = tuple((stage, text) for stage, text in case_view.methods(case) if stage not in silent and (
        not note if done is None else stage in done))
    return template().render(
        case=case, chapters=chapters, verdict=told, note=note, system=system(products),
        key_figures=key_figures, key_tables=() if facts is None else comparison.tables(facts),
        measure=to_measure(case, products), measure_note=statement(case, products), stages=case_view.stages(case),
        methods=methods, limits=limits(products))


def _key_figures(products, look):
    """Figures of the first screen: the answer, and what a simulated brake sounds like."""
    if products.get("diagnosis") is not None and products.get("line_evidence") is None:
        return diagnosis.key_figures(products["diagnosis"])
    if products.get("noise_matrix") is not None:
        return (noise_matrix.key_figure(products["noise_matrix"]),)
    if products.get("friction_update") is not None:
        return (measured_friction.key_figure(products["friction_update"]),)
    if products.get("model_update") is not None:
        return (model_update.key_figure(products["model_update"]),)
    if products.get("matrix_modes") is not None:
        return (matrix_modes.key_figure(products["matrix_modes"], look),)
    if products.get("modal_test") is not None:
        return (modal_test.key_figure(products["modal_test"], look),)
    if products.get("noise_events") is not None and products.get("complex_modes") is None:
        heard = noise_events.key_figure(products["noise_events"], look)
        return tuple(filter(None, [heard or orders.key_figure(products.get("orders"), look)]))
    answer, cycle = _key_figure(products, look), products.get("limit_cycle")
    return tuple(f for f in (answer, cycle and limit_cycle.key_figure(cycle)) if f)


def _key_figure(products, look):
    if products.get("line_evidence") is not None:
        return line_evidence.key_figure(products["line_evidence"])
    squeal, broken = products.get("squeal"), products.get("rupture")
    if squeal is None and broken is not None:
        return Figure(rupture_pictures.slip_profiles(broken), rupture.headline(broken))
    if squeal is None:
        modes = products.get("complex_modes") if products.get("convergence") is not None else None
        return modes and Figure(stability_pictures.operating_growth(modes, look.dpi), complex_modes.MAP_CAPTION)
    if len(squeal.pressure) == 1 and products.get("transient") is not None:
        return transient.loudest(products["transient"], squeal, look)
    return Figure(sound_pictures.occurrence(squeal, look.dpi), vibration.occurrence_caption(squeal))
