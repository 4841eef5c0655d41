"""The report page: one self-contained HTML file, sections in the order of the chain."""

from functools import partial

from pipeline.views.chapters import (
    comparison,
    complex_modes,
    friction,
    friction_descriptions,
    pad_motion,
    structure,
    surface,
    vibration,
)
from pipeline.views.chapters.bench import bench, diagnosis, recording
from pipeline.views.chapters.chapter import Figure
from pipeline.views.chapters.models import beam_on_beam, lock_in, lumped, rupture, transient
from pipeline.views.figures import vibration as sound_pictures
from pipeline.views.figures.models import rupture as rupture_pictures
from pipeline.views.pages import case_settings as case_view
from pipeline.views.pages.limits import limits
from pipeline.views.pages.summary import published_squeal, verdict


def plan(products, look):
    """Functions without arguments, one per chapter whose product is there, in chain order."""
    lines = published_squeal(products.get("comparison"))
    model, modes, moved, facts = map(products.get, ("reduced_model", "complex_modes", "transient", "comparison"))
    known = (("surface", surface.chapter, ()), ("micro_friction", friction.micro, ()),
             ("friction_map", friction.friction_map, ()), ("interface_law", lock_in.interface_law, ()),
             ("friction_descriptions", friction_descriptions.chapter, ()),
             ("structure", structure.chapter, (modes,)), ("pin_on_disc", lock_in.pin_on_disc, ()),
             ("beam_on_beam", beam_on_beam.beams, (modes, facts)), ("lumped", lumped.chapter, (moved,)),
             ("complex_modes", complex_modes.chapter, (model, lines)), ("multibody", pad_motion.chapter, ()),
             ("transient", transient.chapter, ()), ("lock_in", lock_in.lock_in, ()),
             ("motion_scatter", beam_on_beam.scatter, (facts,)), ("beam_geometry", beam_on_beam.geometry, ()),
             ("response", vibration.response, (lines,)), ("squeal", vibration.squeal, (lines,)),
             ("rupture", rupture.chapter, ()), ("recording", recording.chapter, ()),
             ("bench", bench.chapter, ()), ("diagnosis", diagnosis.chapter, ()),
             ("comparison", comparison.chapter, ()))
    return [partial(write, products[name], *more, look) for name, write, more in known
            if products.get(name) is not None]


def page(chapters, products, case, look):
    """HTML text of the report; the same arguments give the same bytes."""
    facts = products.get("comparison")
    return template().render(
        case=case, chapters=chapters, verdict=verdict(products, case_view.tuned(case)),
        key_figure=_key_figure(products, look), key_tables=() if facts is None else comparison.tables(facts),
        stages=case_view.stages(case), methods=case_view.methods(case), limits=limits(products))


def _key_figure(products, look):
    if products.get("diagnosis") is not None:
        return diagnosis.key_figure(products["diagnosis"])
    squeal, broken = products.get("squeal"), products.get("rupture")
    if squeal is None and broken is not None:
        return Figure(rupture_pictures.slip_profiles(broken), rupture.headline(broken))
    if squeal is None:
        return None
    if len(squeal.pressure) == 1 and products.get("transient") is not None:
        return transient.loudest(products["transient"], squeal, look)
    return Figure(sound_pictures.occurrence(squeal, look.dpi), vibration.occurrence_caption(squeal))


def template():
    """The template of every page."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(loader=PackageLoader("pipeline.views"), autoescape=True, undefined=StrictUndefined,
                              trim_blocks=True, lstrip_blocks=True)
    return environment.get_template("report.html.j2")
