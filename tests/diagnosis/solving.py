"""Problems of a diagnosis solved under other settings of inference."""

from dataclasses import replace

from pipeline.diagnosis.output.product import product


def solved(problem, **settings):
    """Diagnosis of a DiagnosisProblem with other ``settings`` of inference (kept, draws, ...)."""
    return replace(problem, settings=replace(problem.settings, **settings)).solved()


def diagnosis_product(problem, **settings):
    """Its product."""
    return product(problem, solved(problem, **settings))
