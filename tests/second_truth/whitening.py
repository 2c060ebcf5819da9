"""Whitening of the rows of a record that count, by a long autoregression with a given covariance.

The matrix W of a log has in each of its first rows the error of the best prediction from all rows before (Durbin and
Levinson's rule: Brockwell, Davis 1991, section 5.2), so that a record needs no past, and then that of the prediction
from the MEMORY rows before. Rows that do not count are first set to the values with which |W y|^2 is least. Then
(W a).(W b) = a' C^-1 b over the rows that count, with their covariance C, as the inverse of a partitioned matrix shows.
W' W is banded (Siddiqui 1958).
"""

import paths  # noqa: F401
import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.signal import fftconvolve

# Rows of a prediction, 2 s at 250 Hz. Noise of two corners is told apart over the time in which its slow part outgrows
# the other; with the corners and shares of noise.py half as many rows changed the odds by less than 5 %, twice as many
# by 1 %.
MEMORY = 500


def predictors(covariance):
    """Rows 0 .. MEMORY of W, each error scaled to a variance of 1; covariance: at lags of 0 .. MEMORY rows or more."""
    table, weights, error = np.zeros((MEMORY + 1, MEMORY + 1)), np.zeros(0), covariance[0]
    table[0, 0] = 1 / np.sqrt(error)
    for k in range(1, MEMORY + 1):
        partial = (covariance[k] - weights @ covariance[k - 1:0:-1]) / error
        weights = np.append(weights - partial * weights[::-1], partial)
        error *= 1 - partial**2
        table[k, :k], table[k, k] = -weights[::-1], 1.0
        table[k, :k + 1] /= np.sqrt(error)
    return table


class Whitening:
    """W of one log of more than twice MEMORY rows. count: the rows that count; weight: level of the noise at each row,
    as a multiple of that in the covariance of the table of predictors."""

    def __init__(self, table, count, weight):
        self.table, self.count, self.weight = table, count, weight
        self.taps = table[MEMORY, ::-1]
        self.missing = np.flatnonzero(~count)
        self.factor = cholesky_banded(self.bands(), lower=True) if len(self.missing) else None

    def bands(self):
        """W' W between the rows that do not count, as its lower bands."""
        n, at, a = len(self.count), self.missing, self.taps
        sums = np.zeros((MEMORY + 1, MEMORY + 1))
        for lag in range(MEMORY + 1):
            sums[lag, :MEMORY + 1 - lag] = np.cumsum(a[:MEMORY + 1 - lag] * a[lag:])
        out = np.zeros((min(MEMORY + 1, len(at)), len(at)))
        for k in range(len(out)):
            early, late = at[:len(at) - k], at[k:]
            lag = late - early
            near = lag <= MEMORY
            terms = np.minimum(np.minimum(early, n - 1 - late), MEMORY - lag)
            out[k, :len(early)][near] = sums[lag[near], terms[near]]
        return out

    def predicted(self, y):
        """W y."""
        head = MEMORY + 1
        return np.concatenate([self.table @ y[:head], fftconvolve(y, self.taps)[head:len(y)]])

    def returned(self, w):
        """W' w."""
        head = MEMORY + 1
        late = np.concatenate([np.zeros(head), w[head:]])
        out = fftconvolve(late[::-1], self.taps)[:len(w)][::-1]
        out[:head] += self.table.T @ w[:head]
        return out

    def __call__(self, values):
        """The whitened signal of all rows of the log."""
        y = np.where(self.count, values / self.weight, 0.0)
        if len(self.missing):
            y[self.missing] = -cho_solve_banded((self.factor, True), self.returned(self.predicted(y))[self.missing])
        return self.predicted(y)
