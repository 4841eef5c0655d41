"""The surface under a group of contacts: where each contact sits along the sliding, waves under it, and its wear."""

from dataclasses import replace

import numpy as np

from pipeline.physics.time_stepping.elements import Waviness


def sliding_angle(contacts, members):
    """Angles (k,) in rad about the axis of the drive at which the contacts ``members`` (k,) sit, about their mean."""
    turned = np.exp(1j * _angle(contacts)[members])
    return np.angle(turned / (turned.sum() or 1.0))


def with_wave(bench, group, amplitude, order, phase, growth=0.0):
    """The bench with amplitude cos(order (theta - theta_i) - phase) added to the gaps of ``group``.

    ``amplitude`` (k,) or one value in m; ``growth`` s, as of a Waviness; theta_i is the angle of contact i.
    """
    contacts, members = bench.model.contacts, bench.contacts(group)
    angle = _angle(contacts)
    waves = tuple(Waviness(int(i), float(a), order, order * float(angle[i]) + phase, growth=growth)
                  for i, a in zip(members, np.broadcast_to(amplitude, len(members)), strict=True))
    changed = replace(contacts, waviness=(*contacts.waviness, *waves))
    return replace(bench, model=replace(bench.model, contacts=changed))


def with_wear(bench, group, rate):
    """The bench whose contacts of ``group`` recede by ``rate`` (k,) m^2/N times pressure and sliding way."""
    contacts, members = bench.model.contacts, bench.contacts(group)
    wear = np.array(np.broadcast_to(contacts.wear, len(contacts.area)), float)
    wear[members] += rate / contacts.area[members]
    return replace(bench, model=replace(bench.model, contacts=replace(contacts, wear=wear)))


def _angle(contacts):
    return np.arctan2(contacts.position[:, 1], contacts.position[:, 0])
