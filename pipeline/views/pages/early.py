"""Pages of a run that is under way: the first screen, marked, with the parts that are to come."""

from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.number_format import number, quantity
from pipeline.views.pages import case_settings
from pipeline.views.pages.report import early_page, unfinished
from pipeline.views.pages.summary import first_look, verdict
from pipeline.views.pages.verdict_file import verdict_text


def first_page(modes, case, ahead):
    """(sentence, HTML) of a first look: ComplexModes of the case on coarse grids and meshes at one operating point.

    ``ahead``: names of the stages that are to come, all of them.
    """
    told = first_look(modes)
    load = f"{quantity(modes.operating_pressure[0], 'Pa')} and {quantity(modes.operating_speed[0], 'rad/s')}"
    friction = number(modes.operating_friction[0], 2)
    note = (f"A first look, at {load} alone, on grids and elements about twice as coarse as those of the case and in"
            f" the reduced model; friction, {friction}, is that of rough surfaces on such a grid. None of it has been"
            f" checked, and the run replaces all of it. {_to_come(ahead)} The chapters follow at the end.")
    sentence = f"{told.headline} ({load}, coarse meshes, friction {friction} from a coarse contact)"
    return sentence, early_page(told, {"complex_modes": modes}, case, note)


def later_page(products, case, ahead):
    """(sentence, HTML) of what ``products`` (name -> product) say, while the stages ``ahead`` are to come."""
    told = verdict(products, case_settings.tuned(case), ahead)
    note = f"This page is not complete. {_to_come(ahead)} The chapters follow at the end."
    return f"{told.headline}. {_to_come(ahead)}", early_page(told, products, case, note, Look())


def unfinished_page(products, case, errors, left, figures):
    """(HTML, text of verdict.json) of what ``products`` say where stages failed: ``errors`` {stage: sentence}.

    ``left``: names of the stages that were not begun; ``figures``: settings of the stage report.
    """
    parts = [f"The stage {_words(name)} could not be finished: {sentence}." for name, sentence in errors.items()]
    parts += [f"Not computed: {', '.join(map(_words, left))}."] * bool(left)
    note = " ".join(["This report is not complete.", *(part.replace("..", ".") for part in parts)])
    told = verdict(products, case_settings.tuned(case))
    look = Look(figures.dots_per_inch, figures.mode_pictures)
    return unfinished(told, products, case, look, note), verdict_text(told, products, parts)


def _words(name):
    return name.replace("_", " ")


def _to_come(ahead):
    return f"Being computed: {', '.join(map(_words, ahead))}."
