"""Numba's compiler without checks for division by zero, for the innermost functions; plain Python without Numba."""

import os

try:
    import numba

    def compiled(function):
        """Compiles at the first call; keeps the result where NUMBA_CACHE_DIR names a folder for it."""
        return numba.njit(function, cache="NUMBA_CACHE_DIR" in os.environ, error_model="numpy")
except ImportError:
    def compiled(function):
        """Leaves the function as it is."""
        return function
