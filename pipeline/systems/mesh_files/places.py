"""Groups of meshes from files that say where the joints of a brake act."""

import numpy as np
import scipy

from pipeline.physics.fem.face_averages import face_mean

_ENDS, _LEVELS = ("LEADING", "TRAILING"), ("INNER", "OUTER")
#: names of groups that say where a joint acts
PLACES = {"PRESSED", "PRESSED_OUTER_PAD", *(f"ABUTMENT_{level}" for level in _LEVELS)} | {
    f"{kind}{of}{last}" for kind, words in (("PISTON_RIM", [45 * k for k in range(8)]), ("SEAL", _ENDS + _LEVELS))
    for of in ("", "_OUTER_PAD", *(f"{side}_{end}" for side in ("", "_OUTER_PAD") for end in _ENDS))
    for last in ("", *(f"_{word}" for word in words))} | {
    f"{kind}_{end}{last}" for end in _ENDS for kind, words in (
        ("FINGER", _LEVELS), ("PISTON", _LEVELS), ("PISTON_OUTER_PAD", _LEVELS), ("MOUNT", _LEVELS),
        ("BOLT", ("FRONT", "REAR")), ("GUIDE_PIN", ("FRONT", "REAR")), ("ABUTMENT_INNER", ()), ("ABUTMENT_OUTER", ()))
    for last in ("", *(f"_{word}" for word in words))}


def named_mean(mesh, name):
    """(1, n) sparse: mean displacement of the group ``name`` of a mesh, of faces over their area; None without one.

    A group without the last word of the name, as FINGER_LEADING, stands for all of those names.
    """
    for key in (name, name.rpartition("_")[0]):
        group = (mesh.groups or {}).get(key.upper(), ())
        if len(group) and group.shape[1] == 1:
            return scipy.sparse.csr_matrix((np.full(len(group), 1 / len(group)), (np.zeros(len(group), int),
                                                                                 group.ravel())), (1, len(mesh.node)))
        if len(group):
            return face_mean(mesh.node, group)
    return None
