"""Kernels: numba is loaded at the first call; a kernel is called by Python and by other kernels as numba's own is."""

import pickle
import subprocess
import sys

import numba
import numpy as np
import pytest

from pipeline.physics.numerics.compiled import njit


@njit
def _reciprocal(x):
    return 1.0 / x


@njit(inline="always")
def _square(x):
    return x * x


@njit(error_model="numpy")
def _reciprocal_square(x):
    return 1.0 / _square(x)


@njit
def _sum_of_reciprocals(values):
    total = 0.0
    for value in values:
        total += _reciprocal(value)
    return total


@njit
def _cube(x):
    return x**3


@njit
def _sum_of_cubes(values):
    total = 0.0
    for value in values:
        total += _cube(value)
    return total


@njit
def _applied(kernel, x):
    return kernel(x)


def test_numba_is_loaded_at_the_first_call():
    ask = ("import sys, pipeline.physics.friction.friction_table as t; print('numba' in sys.modules);"
           "t.friction_at.dispatcher; print('numba' in sys.modules)")
    done = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]


def test_kernels_call_kernels():
    assert _sum_of_reciprocals(np.array([1.0, 2.0, 4.0])) == 1.75
    assert _applied(_reciprocal, 4.0) == 0.25, "a kernel is an argument too"
    assert _sum_of_reciprocals.py_func(np.array([2.0])) == 0.5


def test_a_kernel_that_only_kernels_call_gets_no_entry_from_python():
    assert _sum_of_cubes(np.array([1.0, 2.0])) == 9.0 and _cube(2.0) == 8.0
    assert numba.typeof(_cube).dispatcher is _cube.inner, "what a kernel that names it is compiled with"
    assert _cube.inner.targetoptions["no_cpython_wrapper"]
    assert "no_cpython_wrapper" not in _cube.dispatcher.targetoptions


def test_options_reach_numba():
    assert _reciprocal_square(0.0) == np.inf
    with pytest.raises(ZeroDivisionError):
        _reciprocal(0.0)


def test_a_kernel_keeps_the_name_of_its_function_and_travels_by_it():
    assert _square.__name__ == "_square" and _square.__module__ == __name__
    assert pickle.loads(pickle.dumps(_square)) is _square
    assert not hasattr(_square, "no_such_attribute")
