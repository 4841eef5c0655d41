"""Mathematics of a diagnosis, independent of what is modelled: fits, evidence, decision, location."""

from pipeline.environment import own_compiled_code

own_compiled_code()
