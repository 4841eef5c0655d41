"""Compiled kernels: numba's ``njit``, with numba loaded and the kernel made when it is first called.

Modules with kernels are then imported in no time, and what is never called is never compiled. Compiled code is cached
(see ``compiled_cache``), except in a process whose sources were edited after it had started: what it has loaded is no
longer what the files hold.
"""

import time
from functools import cache, cached_property, update_wrapper
from types import FunctionType

from pipeline import sources

#: before any module with kernels was loaded, s since the epoch
_STARTED = time.time()


def njit(function=None, **options):
    """Decorator: ``@njit`` or ``@njit(error_model="numpy")``, with the options of ``numba.njit``."""
    if function is None:
        return lambda kernel: Kernel(kernel, options)
    return Kernel(function, options)


def borrowing(function=None, **options):
    """``njit`` for kernels that make no arrays: references to those that they are handed are not counted, which costs
    more than the work of small ones."""
    return njit(function, _nrt=False, **options)


class Kernel:
    """A function that numba compiles, at its first call, for the types of the arguments."""

    def __init__(self, function, options):
        update_wrapper(self, function)
        self._function, self._options = function, options

    @cached_property
    def dispatcher(self):
        """numba's object for calls from Python."""
        return self._made(self._function)

    @cached_property
    def inner(self):
        """numba's object for calls from other kernels, without the entry from Python, which costs compile time."""
        f = self._function
        function = update_wrapper(FunctionType(f.__code__, f.__globals__, f.__name__, f.__defaults__, f.__closure__), f)
        function.__qualname__ = f"{f.__qualname__}.inner"       # names the file of the cache
        return self._made(function, no_cpython_wrapper=True, no_cfunc_wrapper=True)

    def _made(self, function, **more):
        current = not sources.changed_since(self.__module__, _STARTED)
        return _numba().njit(cache=current, **self._options, **more)(function)

    def __call__(self, *arguments):
        return self.dispatcher(*arguments)

    def __getattr__(self, name):
        if name.startswith("_"):        # copy and pickle ask for these before there is a function
            raise AttributeError(name)
        return getattr(self.dispatcher, name)

    def __reduce__(self):
        return self.__qualname__


@cache
def _numba():
    """numba, with the type of a Kernel that another kernel names or takes as an argument."""
    import numba

    numba.extending.typeof_impl.register(Kernel)(lambda kernel, _: numba.types.Dispatcher(kernel.inner))
    return numba
