"""What a stage, a data product and a settings section are. Knows no physics."""

from pipeline.contract.context import Context
from pipeline.contract.errors import BrakechainError, ConfigError, ConvergenceError, ProductError
from pipeline.contract.product import Array, count, part, parts, product, quantity, text
from pipeline.contract.settings import (
    InputFile,
    NamedFile,
    Names,
    OneOf,
    Quantities,
    Quantity,
    Section,
    option,
    restored,
    section,
    stored,
)
from pipeline.contract.stage import Products, Sections, Stage, Variants, stage

__all__ = ["Array", "BrakechainError", "ConfigError", "Context", "ConvergenceError", "InputFile", "NamedFile", "Names",
           "ProductError", "OneOf", "Products", "Quantities", "Quantity", "Section", "Sections", "Stage",
           "Variants", "count", "option", "part",
           "parts", "product", "quantity", "restored", "section", "stage", "stored", "text"]
