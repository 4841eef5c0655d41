"""Stage effects: effects of the catalogue that a case adds to its model."""

from pipeline.case_models import effect_block
from pipeline.case_models.effect_block import Settings
from pipeline.contract import Context, stage
from pipeline.products import Effects


@stage(check=effect_block.check_locations)
def effects(settings: Settings, context: Context) -> Effects:
    """Add effects of the catalogue to the model.

    Method:
    Effects of the catalogue were added at the locations and with the values stated in the case, if any.
    """
    added = effect_block.product(settings)
    for name, location in zip(added.effect, added.place, strict=True):
        context.log(f"{name} at {location}")
    return added
