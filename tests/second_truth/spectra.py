"""What an observer who is told machine and noise knows of a residual's noise: its spectrum and its level at each row.

S(f) = S_0(f) P(f) / P_0(f). S_0: the spectrum of the part that noise.py gives in closed form, force on the carriage and
error of the current, in the band of the residual. P and P_0: Welch's periodograms (Welch 1967) of the noise of a few
nulls and of that part of the same nulls. Their ratio adds what the encoder and the steps do through acceleration,
contact and controller; of the same random numbers, it is all but exact where the part in closed form prevails, as among
slow noise, of which a few records tell little. The spectrum is that of the noise over its level, which follows the
speed (Noise.level) and what comes and goes. The mean of the nulls is no noise: who knows their distribution knows it.
Units: N or N m, Hz.
"""

import paths  # noqa: F401
import numpy as np
from scipy.signal import welch

import residuals
from machines import TICK

RATE = 250.0  # Hz, of the rows of an oracle
PERIOD = 64.0  # s, of the grid of frequencies; noise of 0.1 Hz is forgotten in half of it
SEGMENT = 500  # rows of a periodogram, 2 s: steps of 0.5 Hz
SLOW, NEAR = 30.0, 0.1  # Hz, s: above SLOW the encoder's noise in the acceleration is steady; NEAR: a reversal


def thinned(values, rate):
    """Rows at RATE of signals in the band, along the last axis."""
    return values[..., ::max(1, round(rate / RATE))]


def closed_form(machine, noise, channel):
    """Frequencies, and the spectra at the record's rate of the force on the carriage at level 1 and of the current's
    error, in the band of a channel."""
    rate = machine.rate
    n = round(PERIOD * rate)
    rows = np.minimum(np.arange(n), n - np.arange(n))
    frequencies = np.arange(n // 2 + 1) / PERIOD
    carriage = noise.carriage_covariance(rows * round(1 / rate / TICK), TICK) if channel == "force" else np.zeros(n)
    current = machine.force_constant**2 * noise.current_covariance(rows / rate)
    band = residuals.passed(frequencies, rate, channel)
    return frequencies, *(np.maximum(np.fft.rfft(part).real, 0.0) * band for part in (carriage, current))


def ratio(noises, parts, frequencies):
    """P / P_0, means over 1 Hz or 8 % of the frequency to either side; noises, parts: nulls by rows, of each log."""
    power = []
    for signals in (noises, parts):
        spectra = [len(s.T) * welch(s - np.mean(s, axis=0), RATE, nperseg=SEGMENT, detrend=False)[1].sum(axis=0)
                   for s in signals]
        power.append(np.sum(spectra, axis=0))
    at = np.arange(SEGMENT // 2 + 1) * RATE / SEGMENT
    near = np.abs(at - at[:, None]) <= np.maximum(1.0, 0.08 * at)[:, None]
    return np.interp(frequencies, at, (near @ power[0]) / (near @ power[1]))


def levels(told, counts, noises, parts):
    """Root of the mean square of the slow noise at each row of each log: of the part in closed form (told, one array a
    log), and of the rest of the nulls within NEAR seconds. The rest comes and goes: an encoder's noise becomes force
    through the file's contact near reversals and at rest."""
    out, width = [], np.ones(2 * round(NEAR * RATE) + 1)
    around = lambda values: np.convolve(values, width, "same")
    for power, count, noise, part in zip(told, counts, noises, parts):
        rest = (noise - part - np.mean(noise - part, axis=0)) * count
        slow = np.array([residuals.low_passed(r, RATE, SLOW) for r in rest])
        square = np.sum(slow**2, axis=0) / (len(slow) - 1)
        out.append(np.sqrt(power + around(square * count) / np.maximum(around(count), 1)))
    return out


def known(machine, noise, channel, sets, counts, noises, parts):
    """Autocovariance at lags in rows, and the level at each row of each log, of a mean square of 1.

    sets: set-points of each log; counts: rows that count; noises, parts: nulls by rows of each log; all at RATE."""
    frequencies, carriage, current = closed_form(machine, noise, channel)
    slow = frequencies <= SLOW
    factors = [noise.level(s) for s in sets]
    told = [factor**2 * np.mean(carriage * slow) + np.mean(current * slow) for factor in factors]
    weights = levels(told, counts, noises, parts)
    mean = np.sqrt(np.mean(np.concatenate([w[c] for w, c in zip(weights, counts)]) ** 2))
    weights = [w / mean for w in weights]
    factor, weight = (np.concatenate([x[c] for x, c in zip(part, counts)]) for part in (factors, weights))
    spectrum = carriage * np.mean((factor / weight) ** 2) + current * np.mean(weight**-2.0)
    even = lambda signals: [s * c / w for s, c, w in zip(signals, counts, weights)]
    spectrum *= ratio(even(noises), even(parts), frequencies)
    if channel == "command":
        # Nothing is told below half of the high-pass's corner, where the noise vanishes in the band.
        least = np.searchsorted(frequencies, residuals.LEAST / 2)
        spectrum[:least] = spectrum[least]
    return thinned(np.fft.irfft(spectrum), machine.rate), weights
