"""Contact patches: every contact in one patch of its face, none too large, stiffness and resultants kept."""

import numpy as np
import pytest

from pipeline.physics.sliding_motion.patches import contact_patches


@pytest.fixture
def face():
    rng = np.random.default_rng(4)
    position = rng.uniform(0, [0.1, 0.03, 0.0], (90, 3))
    return position, rng.uniform(0, 1e7, 90), np.repeat([3, 7], [50, 40])


@pytest.mark.parametrize("largest", [1, 4, 12, 100])
def test_every_contact_is_in_one_small_patch_of_its_face(face, largest):
    position, stiffness, group = face
    patches = contact_patches(position, stiffness, group, largest)
    assert sorted(patches.member) == list(range(90))
    for begin, end in zip(patches.first[:-1], patches.first[1:], strict=True):
        members = patches.member[begin:end]
        assert 1 <= len(members) <= largest and len(set(group[members])) == 1
    assert np.diff(patches.first).max() > largest / 2 - 1


def test_a_finer_mesh_of_a_face_has_no_more_patches(face):
    position, stiffness, group = face
    patches = contact_patches(position, stiffness, group, 2, 8)
    sizes = np.diff(patches.first)
    assert sizes.max() <= 7 and np.array_equal(np.unique(group[patches.member[patches.first[:-1]]],
                                                         return_counts=True)[1], [8, 8])


def test_a_patch_moves_as_the_mean_of_its_contacts_weighted_by_stiffness(face):
    position, stiffness, group = face
    patches = contact_patches(position, stiffness, group, 9)
    moved = np.random.default_rng(5).standard_normal(90)
    np.testing.assert_allclose(patches.summed(stiffness) * (patches.mean @ moved), patches.summed(stiffness * moved),
                               rtol=1e-4)
    np.testing.assert_allclose(patches.mean.sum(axis=1), 1.0)


def test_single_contacts_move_for_themselves(face):
    position, stiffness, group = face
    patches = contact_patches(position, 0 * stiffness, group, 1)
    np.testing.assert_array_equal(patches.mean[:, patches.member], np.eye(90))
