"""The two rough surfaces."""

from pipeline.contract import Array, product, quantity, text


@product(version=2)
class Surface:
    """Pairs of rough surfaces on one periodic lateral grid, with the depth grading of their solids.

    Statistics and spectra are means over the pairs.
    """

    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    disc_height: Array = quantity("m", "pair y x", "disc surface height, positive out of the solid, zero mean")
    pad_height: Array = quantity("m", "pair y x", "pad surface height, positive out of the solid, zero mean")
    disc_depth: Array = quantity("m", "disc_layer", "depth of the FE layer boundaries of the disc block, from 0")
    pad_depth: Array = quantity("m", "pad_layer", "depth of the FE layer boundaries of the pad block, from 0")
    body: Array = text("body", "body the statistics belong to")
    source: Array = text("body", "file or generator of the height map")
    rms_height: Array = quantity("m", "body", "Sq, root mean square height")
    mean_height: Array = quantity("m", "body", "Sa, arithmetic mean deviation")
    peak_to_valley: Array = quantity("m", "body", "Sz, highest peak to deepest valley")
    skewness: Array = quantity("1", "body", "Ssk, skewness of heights")
    kurtosis: Array = quantity("1", "body", "Sku, kurtosis of heights (3 = Gaussian)")
    rms_slope: Array = quantity("1", "body", "Sdq, root mean square slope")
    outlier_share: Array = quantity("1", "body", "fraction of samples removed as outliers")
    filled_share: Array = quantity("1", "body", "fraction of samples filled")
    shortest_wavelength: Array = quantity("m", "body", "shortest wavelength retained")
    nodes_per_wavelength: Array = quantity("1", "body", "grid nodes on the shortest wavelength")
    wavenumber: Array = quantity("rad/m", "wavenumber", "radial wavenumber of the power spectrum")
    power_spectrum: Array = quantity("m^4", "body wavenumber", "isotropic (radially averaged) power spectrum")
