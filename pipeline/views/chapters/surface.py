"""Chapter: the two rough surfaces."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures import surfaces
from pipeline.views.figures.number_format import number, percent, quantity, span


def chapter(surface, look):
    """Chapter of the product Surface."""
    lower, upper = surface.body
    figures = [Figure(surfaces.height_map(surface, i, look.dpi), _map_caption(surface, i, body))
               for i, body in enumerate(surface.body)]
    side = f"{quantity(surface.x[-1], 'm', 3)} × {quantity(surface.y[-1], 'm', 3)}"
    figures += [
        Figure(surfaces.profile(surface), f"Middle section along sliding, {upper} above {lower}; heights are"
               " exaggerated, so real slopes are much gentler."),
        Figure(surfaces.height_distribution(surface), "Heights about the mean plane. A tail to the right means"
               " peaks, which carry load first."),
        Figure(surfaces.power_spectrum(surface), "Isotropic power spectrum. Roughness right of the dotted line"
               f" (wavelength {span(surface.shortest_wavelength, 'm')}) is deliberately filtered out: the real"
               " contact area depends on it."),
    ]
    return Chapter(
        "surface", "The rough surfaces",
        f"Height maps of {lower} and {upper}, {side}, {len(surface.x)} × {len(surface.y)} nodes."
        f" Sources: {', '.join(f'{b}: {s}' for b, s in zip(surface.body, surface.source, strict=True))}.",
        "These heights enter the contact computation node by node; everything below follows from them. With"
        f" {number(surface.nodes_per_wavelength.min(), 3)} nodes per shortest wavelength"
        + (" the contact spots are resolved." if surface.nodes_per_wavelength.min() >= 8 else
           " the contact spots are coarsely resolved: see the convergence of the contact area below."),
        tuple(figures), (_statistics(surface),))


def _map_caption(surface, index, body):
    return (f"{str(body).capitalize()}: Sq {quantity(surface.rms_height[index], 'm', 3)}, peak to valley"
            f" {quantity(surface.peak_to_valley[index], 'm', 3)}, skewness {number(surface.skewness[index], 2)}."
            " Colours end at the 0.2 and 99.8 percentiles.")


def _statistics(surface):
    rows = (("Sq, rms height", surface.rms_height, lambda v: quantity(v, "m")),
            ("Sa, mean deviation", surface.mean_height, lambda v: quantity(v, "m")),
            ("Sz, peak to valley", surface.peak_to_valley, lambda v: quantity(v, "m")),
            ("Ssk, skewness", surface.skewness, lambda v: number(v, 3)),
            ("Sku, kurtosis (Gaussian: 3)", surface.kurtosis, lambda v: number(v, 3)),
            ("Sdq, rms slope", surface.rms_slope, lambda v: number(v, 3)),
            ("outliers removed", surface.outlier_share, percent),
            ("samples filled", surface.filled_share, percent),
            ("shortest wavelength", surface.shortest_wavelength, lambda v: quantity(v, "m")),
            ("nodes per shortest wavelength", surface.nodes_per_wavelength, lambda v: number(v, 3)))
    shown = tuple((name, *(write(v) for v in values)) for name, values, write in rows)
    return Table(("statistic", *map(str, surface.body)), shown, "Statistics of the surfaces",
                 tuple(range(1, len(surface.body) + 1)))
