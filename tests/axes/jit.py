"""Numba's compiler where it is installed (Debian: python3-numba); without it the same functions run as plain Python,
about a hundred times slower and with the same results."""

import os

try:
    import numba

    COMPILED = True

    def compiled(function):
        """Compiles at the first call; keeps the result where NUMBA_CACHE_DIR names a folder for it."""
        return numba.njit(function, cache="NUMBA_CACHE_DIR" in os.environ)
except ImportError:
    COMPILED = False

    def compiled(function):
        """Leaves the function as it is."""
        return function
