"""Mathematics of a diagnosis, independent of what is modelled: fits, evidence, decision, location."""

from pipeline.environment import use_compiled_cache

use_compiled_cache()
