"""Friction joints under another normal load than that of the model, as one run has it: the condition ``normal_load``.

Their preloads take its place in proportion. A contact that gives way before it slides gets stiffer along with its load,
as rough contacts do (C. Campana, B. N. J. Persson, M. H. Muser, J. Phys.: Condens. Matter 23 (2011) 085001): it builds
up friction over the same way, whereas a compliant arm gives way in proportion to the load.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import changed

#: name of the condition, in N: the sum over all friction joints
CONDITION = "normal_load"


def loaded(bench, run):
    """The bench as it was loaded in ``run``; itself where nothing is said, and where contacts press on their own.

    ConfigError for a load below 0 and for friction joints without a load.
    """
    fixed = bench.model.contacts.fixed
    if CONDITION not in run.conditions or not (len(fixed) and fixed.all()):
        return bench
    load, contacts = float(run.conditions[CONDITION]), bench.model.contacts
    given = contacts.preload.sum()
    if not (load > 0 and given > 0):
        raise ConfigError(f"run {run.name}: {CONDITION}", "a load above 0 N, of the run and of the model",
                          f"{load:g} N and {given:g} N")
    factor, count = load / given, len(fixed)
    model = replace(bench.model, contacts=replace(contacts, preload=factor * contacts.preload))
    friction = changed(bench.friction, count, range(count), lambda law: _stiffened(law, factor))
    return replace(bench, model=model, friction=friction)


def _stiffened(friction, factor):
    if friction.description == "rigid":
        return friction
    return replace(friction, stiffness=factor * np.asarray(friction.stiffness, float))
