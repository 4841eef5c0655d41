"""Chapter: frequency responses of a modal test."""

import numpy as np

from pipeline.views.chapters.bench.hypotheses import sentence
from pipeline.views.chapters.chapter import Chapter, Figure
from pipeline.views.figures.bench import response_functions as pictures
from pipeline.views.figures.number_format import number, plural, quantity

#: what the averages of a method are
_AVERAGED = {"blows": "blow", "lasting force": "segment", "motions alone": "length of the correlations"}
_MOST_TOLD = 6


def chapter(product, look):
    """Chapter of the product ResponseFunctions."""
    figures = tuple(Figure(pictures.responses(test, look.dpi), f"Test {name}: sizes of"
                           f" {plural(len(test.response), 'response')} (grey) and their root mean square (blue)"
                           + ("; below, their coherence with the force, median (blue) and lowest (grey)."
                              if len(test.coherence) else ".")) for name, test in product.tests.items())
    return Chapter("response_functions", "Frequency responses",
                   "What moves how much for each newton, over frequency: from the files, or estimated from records.",
                   " ".join(_sentence(name, test) for name, test in product.tests.items()), figures, ())


def remarks(product):
    """What was changed of given responses, or cannot be told of them, over all tests, in sentences; '' of nothing."""
    every = [(name, str(one)) for name, test in product.tests.items() for one in test.remark]
    named = len(product.tests) > 1
    return " ".join(sentence(f"test {name}: {one}" if named else one) for name, one in every)


def _sentence(name, test):
    step, method = test.line[1] - test.line[0], str(test.method)
    told = [f"Test {name}: {plural(len(test.response), 'response')}, lines {quantity(step, 'Hz', 3)} apart, "
            + ("as given" if method == "given" else f"from {method}")]
    if method in _AVERAGED:
        told.append(f", {plural(int(test.averages.sum()), _AVERAGED[method])}")
    if test.decay:
        told.append(f"; windows that add {number(test.decay, 3)} 1/s to every decay rate, which the modes are rid of")
    elif method == "given":
        told.append(", without a window; where the front end weighed its records by an exponential one,"
                    " response_functions.window_decay takes it off the damping ratios")
    told.append("." + "".join(f" {sentence(one)}" for one in test.remark))
    if len(test.coherence):
        strong = np.sqrt(np.mean(abs(test.response) ** 2, axis=0)) >= np.median(abs(test.response))
        told.append(f" Where they are strong, their coherence is {number(np.median(test.coherence[:, strong]), 3)}.")
    if len(test.left_out):
        first, rest = list(map(str, test.left_out[:_MOST_TOLD])), len(test.left_out) - _MOST_TOLD
        told.append(f" Left out: {'; '.join(first)}{f'; and {rest} more' if rest > 0 else ''}.")
    return "".join(told)
