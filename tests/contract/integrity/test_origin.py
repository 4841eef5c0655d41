"""What a product says it was computed with."""

import re
from importlib.metadata import version

import numpy as np

from pipeline.contract.integrity.origin import git_commit, kernels, packages


def test_packages_have_their_versions():
    assert packages()["numpy"] == version("numpy") == np.__version__ and "no such package" not in packages()


def test_the_commit_is_one_of_git_or_none():
    assert re.fullmatch(r"([0-9a-f]{40}\+?)?", git_commit())


def test_kernels_are_those_of_linear_algebra():
    assert np.linalg.norm(np.ones(3)) > 0 and all(re.match("openblas|mkl|blis", each) for each in kernels())
