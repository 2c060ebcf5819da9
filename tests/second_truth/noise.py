"""Noise of a record: force on the carriage, current sensor, encoder; random spectra.

Source: shaping filters of stationary noise, Astrom 1970, chapters 2 and 4. Units: N or N m, A, m or rad.
"""

import numpy as np
from scipy.signal import lfilter

DRIFT = 0.5  # Hz; corner of the slow part of the current's error


def slow(rng, n, tick, corner):
    """First-order Markov noise of unit variance with a corner frequency in Hz, n samples."""
    pole = np.exp(-2 * np.pi * corner * tick)
    start = rng.normal()
    drive = rng.normal(size=n) * np.sqrt(1 - pole**2)
    return lfilter([1.0], [1.0, -pole], drive, zi=[pole * start])[0]


def resonant(rng, n, tick, frequency, damping):
    """Noise of unit variance with a peak at a frequency in Hz."""
    radius, angle = np.exp(-2 * np.pi * frequency * damping * tick), 2 * np.pi * frequency * tick
    raw = lfilter([1.0], [1.0, -2 * radius * np.cos(angle), radius**2], rng.normal(size=n + 4000))[4000:]
    return raw / np.std(raw)


def slow_covariance(lags, corner):
    """Autocovariance of slow() at lags in s."""
    return np.exp(-2 * np.pi * corner * lags)


def resonant_covariance(ticks, tick, frequency, damping):
    """Autocovariance of resonant() at lags in ticks: that of an autoregression of second order with complex poles."""
    radius, angle = np.exp(-2 * np.pi * frequency * damping * tick), 2 * np.pi * frequency * tick
    sine = (1 - radius**2) / (1 + radius**2) / np.tan(angle)
    return radius**ticks * (np.cos(ticks * angle) + sine * np.sin(ticks * angle))


class Noise:
    """The levels and spectra of one case, the same for all of its logs."""

    def __init__(self, rng, machine):
        self.force = machine.coulomb * rng.uniform(0.006, 0.02)  # rms, N
        self.shares = rng.dirichlet([1.5, 1.5, 1.0])
        self.corners = (np.exp(rng.uniform(np.log(0.1), np.log(3.0))), np.exp(rng.uniform(np.log(10.0), np.log(150.0))))
        self.peak, self.damping = rng.uniform(15.0, 140.0), rng.uniform(0.05, 0.6)
        self.with_speed = rng.uniform(0.5, 2.0) if rng.random() < 0.25 else 0.0
        self.current = machine.coulomb / machine.force_constant * rng.uniform(0.002, 0.012)  # rms, A
        self.current_slow = rng.uniform(0.0, 0.3)
        self.encoder = machine.increment * rng.uniform(0.0, 0.7) * (rng.random() < 0.7)  # rms, m
        self.speed = machine.speed

    def level(self, sets):
        """Factor of the force on the carriage at each row of set-points."""
        return 1 + self.with_speed * np.abs(sets[:, 1]) / self.speed

    def on_carriage(self, rng, sets, tick):
        """Force at each tick, N."""
        n = len(sets)
        parts = (slow(rng, n, tick, self.corners[0]), slow(rng, n, tick, self.corners[1]),
                 resonant(rng, n, tick, self.peak, self.damping))
        return self.force * self.level(sets) * sum(np.sqrt(s) * part for s, part in zip(self.shares, parts))

    def carriage_covariance(self, ticks, tick):
        """Autocovariance of the force on the carriage at level 1 and at lags in ticks, N^2."""
        parts = (slow_covariance(ticks * tick, self.corners[0]), slow_covariance(ticks * tick, self.corners[1]),
                 resonant_covariance(ticks, tick, self.peak, self.damping))
        return self.force**2 * sum(s * part for s, part in zip(self.shares, parts))

    def of_encoder(self, rng, n):
        """Error of position at each tick, m or rad; the controller sees it."""
        return self.encoder * rng.normal(size=n) if self.encoder > 0.0 else np.zeros(n)

    def of_current(self, rng, n, period):
        """Error of the recorded current at each row, A; the controller does not see it."""
        white, drift = rng.normal(size=n), slow(rng, n, period, DRIFT)
        return self.current * (np.sqrt(1 - self.current_slow) * white + np.sqrt(self.current_slow) * drift)

    def current_covariance(self, lags):
        """Autocovariance of the current's error at lags in s, which are multiples of the rows' period, A^2."""
        return self.current**2 * ((1 - self.current_slow) * (lags == 0.0)
                                  + self.current_slow * slow_covariance(lags, DRIFT))

    def facts(self):
        """What truth.json says of it."""
        return {"force_rms": self.force, "current_rms_A": self.current, "encoder_rms": self.encoder,
                "with_speed": self.with_speed}
