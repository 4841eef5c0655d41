"""The report page of a case."""

from pipeline.contract import Context, Section, option, stage
from pipeline.products import (
    BeamGeometry,
    BeamOnBeam,
    Comparison,
    ComplexModes,
    FrictionMap,
    InterfaceLaw,
    LockIn,
    Lumped,
    MicroFriction,
    MotionScatter,
    Multibody,
    PinOnDisc,
    ReducedModel,
    Report,
    Response,
    Rupture,
    Squeal,
    Structure,
    Surface,
    Transient,
)


class Settings(Section):
    """Pictures of the report."""

    dots_per_inch: int = option(150, "resolution of the pictures that are not line drawings", ge=50, le=600)
    mode_pictures: int = option(6, "mode shapes drawn of the disc and of the unstable brake, each", ge=0, le=40)


@stage(companions=lambda product: {"report.html": product.html.item()}, reads_case=True)
def report(surface: Surface | None, micro_friction: MicroFriction | None, friction_map: FrictionMap | None,
           structure: Structure | None, model: ReducedModel | None, complex_modes: ComplexModes | None,
           multibody: Multibody | None, response: Response | None, squeal: Squeal | None,
           lumped: Lumped | None, transient: Transient | None, rupture: Rupture | None,
           interface_law: InterfaceLaw | None, pin_on_disc: PinOnDisc | None, lock_in: LockIn | None,
           beam_on_beam: BeamOnBeam | None, motion_scatter: MotionScatter | None, beam_geometry: BeamGeometry | None,
           comparison: Comparison | None, settings: Settings, context: Context) -> Report:
    """Write one HTML page with pictures, tables, settings and methods.

    Method:
    Pictures are drawn from the data products alone ({dots_per_inch} dots per inch, up to {mode_pictures} mode shapes
    of a kind); every number on this page is read from a product or from the settings.
    """
    from pipeline.views.chapter import Look
    from pipeline.views.page import page, plan

    products = {"surface": surface, "micro_friction": micro_friction, "friction_map": friction_map,
                "structure": structure, "lumped": lumped, "model": model, "complex_modes": complex_modes,
                "multibody": multibody, "response": response, "transient": transient, "squeal": squeal,
                "rupture": rupture, "interface_law": interface_law, "pin_on_disc": pin_on_disc, "lock_in": lock_in,
                "beam_on_beam": beam_on_beam, "motion_scatter": motion_scatter, "beam_geometry": beam_geometry,
                "comparison": comparison}
    look = Look(settings.dots_per_inch, settings.mode_pictures)
    chapters = []
    builders = plan(products, look)
    with context.progress("chapters", len(builders)) as progress:
        for build in builders:
            chapters.append(build())
            progress.advance()
    return Report(html=page(chapters, products, context.case, look))
