"""What a record can tell: Fisher information of mass, viscous friction, Coulomb friction and offset.

The equation of a sample is  F = m a + c v + F_C s + o + e, with s = (Coulomb part of friction) / F_C. In the noise e
  - the effort sensor's noise is white, K_F sigma_i;
  - the process force is first-order noise of 100 Hz, sampled;
  - the position's noise, increment/sqrt(12) and the encoder's own together, comes through the double derivative:
    m (2 pi f)^2 and c (2 pi f) times its white spectrum;
  - what the best band-limited derivative of the noise-free samples leaves (a quintic spline through them) is noise as
    well: at low rates it is the motion between the samples that nobody can know.
Weighting each frequency by its noise is the best band there is. THE DEFINITION: a parameter is identifiable where its
Cramer-Rao bound is at most 10 % of its true value (of the offset: 10 % of the Coulomb friction).
"""

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal.windows import tukey

IDENTIFIABLE = 0.10
NAMES = ("mass_kg", "viscous_N_s_per_m", "coulomb_N", "constant_force_N")  # as `stiction identify --json` has them


def reconstruction(t, x):
    """Speed and acceleration from samples: derivatives of the quintic spline through them."""
    spline = make_interp_spline(t, x, k=5)
    return spline(t, 1), spline(t, 2)


def smooth(power):
    """A periodogram averaged over neighbours."""
    width = max(9, len(power) // 200) | 1
    padded = np.pad(power, width // 2, mode="reflect")
    sums = np.cumsum(np.insert(padded, 0, 0.0))
    return (sums[width:] - sums[:-width]) / width


def noise_spectrum(f, axis, rate, effort_noise, force_noise):
    """Variance of each discrete Fourier coefficient's noise over the number of samples, at f in Hz."""
    sigma_x2 = axis.increment**2 / 12 + axis.noise**2
    omega = 2 * np.pi * f
    motion = (axis.mass * omega**2) ** 2 + (axis.viscous * omega) ** 2
    rho = np.exp(-2 * np.pi * 100.0 / rate)
    process = force_noise**2 * (1 - rho**2) / np.abs(1 - rho * np.exp(-1j * omega / rate)) ** 2
    return sigma_x2 * motion + (axis.force_constant * effort_noise) ** 2 + process


def information(t, truth, axis, effort_noise, force_noise, rows=None):
    """The Fisher matrix in the order of NAMES; t the times of the samples, truth as `simulate` returns it.

    rows: mask of the samples that count (neither saturated nor missing), all when None.
    """
    v, a = reconstruction(t, truth["x_true"])
    s = truth["f"] / axis.coulomb
    rate = (len(t) - 1) / (t[-1] - t[0])
    window = tukey(len(t), 0.05) * (1.0 if rows is None else rows)
    left = axis.mass * (truth["a"] - a) + axis.viscous * (truth["v"] - v)
    columns = np.stack([a, v, s, np.ones_like(t)]) * window
    spectra = np.fft.rfft(columns)
    f = np.fft.rfftfreq(len(t), 1 / rate)
    noise = noise_spectrum(f, axis, rate, effort_noise, force_noise)
    noise = noise + smooth(np.abs(np.fft.rfft(left * window)) ** 2) / len(t)
    twice = np.where((f == 0) | ((len(t) % 2 == 0) & (np.arange(len(f)) == len(f) - 1)), 1.0, 2.0)
    return np.real((spectra * (twice / noise)) @ spectra.conj().T) / len(t)


def bounds(matrix):
    """Cramer-Rao bounds (standard errors); infinite where the record does not tell the parameter from the others."""
    out = np.empty(len(matrix))
    for k in range(len(matrix)):
        rest = [j for j in range(len(matrix)) if j != k]
        scale = np.sqrt(np.maximum(np.diag(matrix)[rest], 1e-300))
        inner = matrix[np.ix_(rest, rest)] / np.outer(scale, scale)
        cross = matrix[k, rest] / scale
        left = matrix[k, k] - cross @ np.linalg.pinv(inner, rcond=1e-9, hermitian=True) @ cross
        out[k] = 1 / np.sqrt(left) if left > 1e-9 * matrix[k, k] > 0 else np.inf
    return out


def told(matrix, true):
    """{name: {"true", "bound", "identifiable"}} from the information of a record, or the sum of several records', and
    the true values in the order of NAMES."""
    scales = (true[0], true[1], true[2], true[2])
    return {name: {"true": value, "bound": error, "identifiable": bool(error <= IDENTIFIABLE * scale)}
            for name, value, error, scale in zip(NAMES, true, bounds(matrix), scales)}
