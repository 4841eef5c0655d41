"""Friction of the rough pair: computed, mapped, and as a law of the interface."""

from pipeline.contract import Array, count, parts, product, quantity, text


@product(version=6)
class MicroFriction:
    """Friction, real contact area and wear of the rough pair over pressure, speed and sliding distance."""

    settings: Array = text("", "the section of the case that describes it, as JSON")
    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure")
    speed: Array = quantity("m/s", "speed", "sliding speed")
    disc_speed: Array = quantity("rad/s", "speed", "disc speed with this sliding speed at the effective radius")
    distance: Array = quantity("m", "distance", "sliding distance")
    friction: Array = quantity("1", "pressure speed distance", "coefficient of friction, shear over normal force")
    friction_std: Array = quantity("1", "pressure speed distance", "standard error of the friction coefficient: over pairs of surfaces, of one pair over its positions")
    pair_friction: Array = quantity("1", "pair pressure speed distance", "coefficient of friction of each pair of surfaces")
    real_area: Array = quantity("1", "pressure speed distance", "real over nominal contact area, perimeter-corrected")
    yielding_area: Array = quantity("1", "pressure speed distance", "share of the nominal area that yields, at the hardness of the softer body")
    wear_depth: Array = quantity("m", "pressure speed distance", "approach of both mean planes by wear, at equal load")
    largest_wear: Array = quantity("m", "pressure speed distance", "largest wear of one surface node")
    normal_stiffness: Array = quantity("Pa/m", "pressure speed distance", "interface stiffness dp/d(approach) without the"
                                       " uniform compliance of the blocks")
    block_compliance: Array = quantity("m/Pa", "", "uniform compliance of both blocks, which the stiffness leaves out")
    flash_temperature: Array = quantity("K", "pressure speed distance", "mean flash temperature rise of the contact spots")
    full_slip_distance: Array = quantity("m", "pressure speed distance", "displacement at which every contact node slips")
    shear_limit: Array = quantity("Pa", "", "shear limit at reference speed and temperature")
    limit_at_speed: Array = quantity("Pa", "pressure speed distance", "shear limit at speed and flash temperature")
    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    contact_pressure: Array = quantity("Pa", "distance y x", "contact pressure of the first pair, middle pressure")
    pad_wear: Array = quantity("m", "distance y x", "wear of its pad nodes, middle pressure")
    disc_wear: Array = quantity("m", "distance y x", "wear of its disc nodes, middle pressure")
    bearing_share: Array = quantity("1", "bearing_share", "share of the area above a height")
    pad_bearing: Array = quantity("m", "distance bearing_share", "that height of the pad, from the mean plane when new")
    disc_bearing: Array = quantity("m", "distance bearing_share", "that height of the disc, from the mean plane when new")
    stress_depth: Array = quantity("m", "stress_depth", "depth under the mean plane of the pad")
    stress: Array = quantity("Pa", "stress_depth x", "von Mises stress in the pad under pressure and shear of the new surfaces, middle pressure and speed, section along sliding through the largest, by the half-space")
    stress_largest: Array = quantity("Pa", "stress_depth", "its largest value at each depth")
    stress_row: Array = quantity("m", "", "y of the section")
    presliding_displacement: Array = quantity("m", "pressure presliding", "displacement from rest, without the uniform shear of the blocks")
    presliding_friction: Array = quantity("1", "pressure presliding", "shear over normal force there; new surfaces of the first pair, middle speed")
    tangential_stiffness: Array = quantity("Pa/m", "pressure", "interface stiffness along sliding at rest, all spots sticking; 0 where friction from rest is not asked for")
    nodes_per_wavelength: Array = quantity("1", "", "nodes per shortest wavelength of the study itself")
    refinement: Array = quantity("1", "refinement", "nodes per shortest wavelength of the convergence study")
    refinement_area: Array = quantity("1", "refinement", "perimeter-corrected real over nominal area at middle pressure")
    area_limit: Array = quantity("1", "", "the same on an infinitely fine grid, extrapolated from the last three")
    area_limit_error: Array = quantity("1", "", "error of the extrapolation; of two grids what the last refinement changes")
    area_order: Array = quantity("1", "", "order at which it approaches that; 0 where fewer than three grids tell none")


@product(version=1)
class FrictionOverTemperature:
    """The friction map at other temperatures of the bodies, by the softening of the shear limit."""

    temperature: Array = quantity("K", "temperature", "temperature of both bodies above that of reference")
    friction: Array = quantity("1", "temperature pressure speed distance", "coefficient of friction at the points of the map")


@product(version=5)
class FrictionMap:
    """mu(pressure, speed, distance) of the interface and its normal stiffness."""

    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure")
    speed: Array = quantity("m/s", "speed", "sliding speed")
    distance: Array = quantity("m", "distance", "sliding distance")
    friction: Array = quantity("1", "pressure speed distance", "coefficient of friction")
    friction_std: Array = quantity("1", "pressure speed distance", "standard error of the coefficient of friction")
    best_pressure: Array = quantity("Pa", "distance", "pressure of the smallest standard error; of one pair of surfaces errors of level and slope are uncorrelated there")
    pressure_slope_std: Array = quantity("1", "distance", "standard error of dmu / d ln(pressure) there")
    speed_slope_std: Array = quantity("1", "distance", "standard error of dmu / d ln(speed) there, errors at the computed speeds being independent")
    error_correlation: Array = quantity("1", "distance term other", "correlation of the errors of level, slope over pressure and slope over speed there, by the pairs of surfaces; of one pair none")
    normal_stiffness: Array = quantity("Pa/m", "pressure distance", "interface stiffness, mean over speed")
    computed_pressure: Array = quantity("Pa", "computed_pressure", "pressures at which micro_friction ran")
    computed_speed: Array = quantity("m/s", "computed_speed", "speeds at which micro_friction ran")
    bulk_temperature: Array = quantity("K", "", "temperature of both bodies above that of reference")
    over_temperature: dict[str, FrictionOverTemperature] = parts("'bodies' where temperatures were asked for", empty=True)


@product(version=1)
class InterfaceLaw:
    """Normal and tangential law of a rough interface from its summits, and the three descriptions of its friction."""

    source: Array = text("", "source of the summits")
    summit_density: Array = quantity("1/m^2", "", "summits per area")
    summit_mean: Array = quantity("m", "", "mean height of the summits above the mean plane")
    summit_spread: Array = quantity("m", "", "standard deviation of their heights, Gaussian")
    summit_curvature: Array = quantity("1/m", "", "median of their curvatures")
    curvature_spread: Array = quantity("1", "", "standard deviation of the logarithm of the curvatures")
    curvature_correlation: Array = quantity("1", "", "correlation of that logarithm and the height")
    shear_limit: Array = quantity("Pa", "", "yield stress in shear of the contact spots")
    gap: Array = quantity("m", "gap", "distance of the mean planes, falling")
    gap_pressure: Array = quantity("Pa", "gap", "nominal contact pressure at the gap")
    real_area: Array = quantity("1", "gap", "real over nominal contact area at the gap")
    normal_stiffness: Array = quantity("Pa/m", "gap", "interface stiffness at the gap")
    pressure: Array = quantity("Pa", "pressure", "nominal contact pressures of the shear law")
    displacement: Array = quantity("m", "displacement", "tangential displacement from rest")
    shear: Array = quantity("Pa", "pressure displacement", "shear stress of the summits")
    evolution_shear: Array = quantity("Pa", "pressure displacement", "shear stress of the fitted evolution rule")
    elastic_shear: Array = quantity("Pa", "pressure displacement", "shear stress of the fitted elastic stick")
    tangential_stiffness: Array = quantity("Pa/m", "pressure", "tangential stiffness at rest, c_t")
    limit: Array = quantity("Pa", "pressure", "shear stress in full slip, tau_max")
    exponent: Array = quantity("1", "pressure", "exponent m of dtau/dv = c_t (1 - tau / tau_max)^m")
    elastic_stiffness: Array = quantity("Pa/m", "pressure", "stiffness of the elastic stick of the same energy")
    friction: Array = quantity("1", "pressure", "coefficient of friction, tau_max over pressure")


@product(version=1)
class FrictionDescriptions:
    """The three descriptions of friction in an implicit scheme: cost of each, and their agreement."""

    description: Array = text("description", "evolution, elastic, rigid")
    modulation: Array = quantity("1", "modulation", "amplitude of the pulsating load over its mean; above 1 contact is lost")
    iterations: Array = quantity("1", "tangent modulation description", "Newton iterations per step, mean; first without the unsymmetric term, then with it")
    worst: Array = count("tangent modulation description", "largest number of iterations of one step")
    halvings: Array = count("tangent modulation description", "steps that did not converge and were halved")
    converged: Array = count("tangent modulation description", "1 if no step was abandoned")
    cost: Array = quantity("1", "tangent modulation description", "work of the factorisations over that of the cheapest")
    sliding_share: Array = quantity("1", "tangent modulation description", "fraction of contacts that slide, mean over the steps")
    mean_shift: Array = quantity("m", "tangent modulation description", "mean displacement of the block along sliding, second half")
    curve_error: Array = quantity("1", "description", "deviation from the curve of one Hertz contact over its limit, root mean square")
    step: Array = quantity("s", "", "time step")


@product(version=1)
class FrictionUpdate:
    """Measured friction beside the friction map: where they differ, and which values of the micro scale that asks for."""

    run: Array = text("sample", "run of the recording that a coefficient comes from")
    friction: Array = quantity("1", "sample", "measured coefficient of friction")
    friction_std: Array = quantity("1", "sample", "its standard error as stated; 0 where none is")
    pressure: Array = quantity("Pa", "sample", "nominal contact pressure")
    speed: Array = quantity("m/s", "sample", "sliding speed")
    distance: Array = quantity("m", "sample", "sliding distance")
    temperature: Array = quantity("K", "sample", "temperature")
    outside: Array = count("sample", "1 beyond the range of the map, where it is constant")
    mapped: Array = quantity("1", "sample", "coefficient of the map there")
    updated: Array = quantity("1", "sample", "the same with the terms that are needed")
    unseen: Array = quantity("1", "sample", "the same, these fitted to other groups of samples alone")
    term: Array = text("term", "ways in which the map may be off: level, pressure, speed, distance, temperature")
    tested: Array = count("term", "1 where the samples can tell it")
    fitted: Array = count("term", "1 where the best set of terms holds it")
    needed: Array = count("term", "1 where it is also beyond what other patches of the surfaces may change")
    value: Array = quantity("1", "term", "change of ln(friction) per unit of the term: of level 1, ln(pressure), ln(speed), K; of distance the logarithm of the factor on it")
    value_std: Array = quantity("1", "term", "its standard error; of terms that are not fitted those of all together")
    map_std: Array = quantity("1", "term", "standard error of the map along the term")
    p_value: Array = quantity("1", "term", "probability of such a term by chance, all terms together")
    scatter: Array = quantity("1", "", "relative scatter between tests that the stated errors do not explain, after the update")
    scatter_before: Array = quantity("1", "", "the same beside the map as it is")
    model: Array = text("model", "sets of terms by BIC, the best ten")
    bic: Array = quantity("1", "model", "BIC less that of the map as it is")
    setting: Array = text("setting", "settings of micro_friction that the needed terms change")
    setting_before: Array = quantity("1", "setting", "their values, SI")
    setting_after: Array = quantity("1", "setting", "the values that the samples ask for, SI")
    setting_std: Array = quantity("1", "setting", "standard errors of these, that of the map included")
    verdict: Array = text("", "consistent, chance (of the computed surfaces), values, or tie")
    alike: Array = text("alike", "sets of terms that are not told apart from the best one")
