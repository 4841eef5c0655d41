"""Operating points that a rough pair cannot be computed at, refused before anything long runs."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.numerics.memory import refuse_beyond_memory
from pipeline.physics.rough.contact.normal_contact import full_contact_pressure, solve_normal_contact

#: bytes per surface node that the condensation of a block takes at its peak, measured from 64^2 to 256^2 nodes
NODE_BYTES = 850
#: fewer touching nodes show the grid, not the roughness
FEWEST_NODES = 2


def refuse_large_grid(nodes, where):
    """ConfigError at ``where`` if a block of ``nodes`` x ``nodes`` surface nodes does not fit into memory."""
    refuse_beyond_memory(NODE_BYTES * nodes ** 2, f"a block of {nodes} x {nodes} surface nodes", where, "lower it")


def refuse_beyond_limits(rubbing, pressures, speeds):
    """ConfigError where a Rubbing cannot be computed at rising ``pressures`` (Pa) and ``speeds`` (m/s).

    The rate term must leave a positive shear limit at every speed, the highest pressure must lie below the hardness and
    leave nodes of the new surfaces open, and the lowest must press more than one node.
    """
    _refuse_vanishing_limit(rubbing.shearing, speeds)
    pair, lowest, highest = rubbing.pair, pressures[0], pressures[-1]
    if highest >= pair.hardness:
        raise ConfigError(f"rough pair: {pair.yielding}.hardness", f"above the highest pressure, {highest:.3g} Pa",
                          f"{pair.hardness:.3g} Pa", "state that of its surface, or lower the pressures")
    gap, compliance = -pair.pad_height - pair.disc_height, pair.compliance.normal
    flat = full_contact_pressure(gap, compliance)
    if highest >= flat:
        raise ConfigError("rough pair: pressures", f"below {flat:.3g} Pa, which flattens the surfaces",
                          f"{highest:.3g} Pa", "lower them, or raise the modulus of the pad or the roughness")
    touching = np.count_nonzero(solve_normal_contact(gap, compliance, lowest, **vars(rubbing.solving)).pressure)
    if touching < FEWEST_NODES:
        raise ConfigError("rough pair: pressures", f"a load on at least {FEWEST_NODES} nodes",
                          f"{touching} of {gap.size} touching at {lowest:.3g} Pa", "raise it, or surface.nodes")


def _refuse_vanishing_limit(shearing, speeds):
    factor = 1.0 + shearing.rate * np.log(np.asarray(speeds) / shearing.reference_speed)
    if factor.min() <= 0.0:
        raise ConfigError("rough pair: rate_coefficient", "a shear limit above 0 at every speed",
                          f"{factor.min():.3g} times the declared one at {min(speeds):.3g} m/s",
                          "lower it, or bring reference_speed and disc_speeds closer")
