"""The parts of a brake on other meshes, and what these do to its modes."""

import numpy as np

from pipeline.physics.modal.mode_pairing import assurance

#: settings of each section that count elements, and those that state their size
COUNTS = {"disc": ("web_cells", "ring_cells", "angular_cells"), "pad": ("cells_per_patch", "lining_layers"),
          "caliper": ("radial_cells", "angular_cells", "housing_cells", "bridge_cells"), "bracket": ("corner_cells",),
          "piston": ("angular_cells",)}
SIZES = {"bracket": ("element_size",), "piston": ("element_size",)}
#: fewest elements
LEAST = {"web_cells": 2, "angular_cells": 8, "corner_cells": 0}
#: groups of modes within this share of their frequency and with this likeness are the same on both meshes
_NEAR, _ALIKE = 0.1, 0.5


def other_meshes(settings, by):
    """[(section model_update with another mesh, factor)]: the error of the mesh is the factor times what ln f changes.

    All but the disc get ``by`` times as many elements in each direction, the disc, whose matrices are the largest, as
    many times fewer; errors fall with the square of the size of the elements. A mesh from a file stays, and so does
    the disc where it is no part of the test.
    """
    parts = {"disc": (), "assembly": ("pad", "caliper", "bracket", "piston")}.get(settings.body, (settings.body,))
    tested = settings.body == "disc" or settings.pressed.force or any(p.body == "disc" for p in settings.points)
    cases = [(parts, by, 1 / (1 - by ** -2))] * bool(parts) + [(("disc",), 1 / by, -1 / (by ** 2 - 1))] * bool(tested)
    changed = [{name: _meshed(name, getattr(settings, name), times) for name in names} for names, times, _ in cases]
    return [(settings.model_copy(update=each), factor) for each, (*_, factor) in zip(changed, cases, strict=True)]


def _meshed(name, part, times):
    """A part with ``times`` as many elements in each direction, within what its settings allow."""
    counts = {key: max(_multiple(name, times * getattr(part, key)), LEAST.get(key, 1)) for key in COUNTS.get(name, ())
              if hasattr(part, key)}
    sizes = {key: getattr(part, key) / times for key in SIZES.get(name, ()) if hasattr(part, key)}
    return part.model_copy(update=counts | sizes)


def _multiple(name, count):
    """Whole number of elements, of a piston a multiple of four."""
    step = 4 if name == "piston" else 1
    return step * int(np.ceil(count / step - 1e-9))


def off_by_mesh(modes, groups, seen, other_modes, other_groups, other_seen):
    """(g,) ln f of each group on another mesh less that on the first one; 0 of groups that only one of them has.

    ``modes``: ModelModes, ``groups`` [(k,)] of them, ``seen``: what points show of shapes, of both meshes.
    """
    frequency, other = (np.exp([np.log(m.frequency[k]).mean() for k in each]) for m, each in (
        (modes, groups), (other_modes, other_groups)))
    first = np.array([seen(modes.shown[:, k])[:, 0] for k in groups])
    likeness = assurance(first, [other_seen(other_modes.shown[:, k]) for k in other_groups])
    off = np.log(other / frequency[:, None])
    likeness = np.where(abs(off) < _NEAR, likeness, 0.0)
    best = likeness.argmax(axis=1)
    row = np.arange(len(groups))
    return np.where(likeness[row, best] > _ALIKE, off[row, best], 0.0)
