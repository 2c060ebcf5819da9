"""Compares the drive's notch with scipy: impulse response and frequency response of (3.19), bilinear with prewarping.

usage: notch_oracle.py NOTCH_RESPONSE      the program that prints the impulse response
"""
import subprocess
import sys

import numpy as np
from scipy import signal

RATE = 16000.0  # Hz, the fast tick
AMPLITUDE = 1000.0  # A
TICKS = 16000
COEFFICIENT_BIT = 2.0**-28
CURRENT_BIT = 2.0**-20

# Frequency in Hz, dampings of numerator and denominator. The first is the cross table's.
NOTCHES = [(2000, 0.05, 0.7), (2000, 0.0, 0.7), (700, 0.1, 0.5), (50, 0.05, 0.7), (50, 0.0, 0.2), (7000, 0.1, 1.0)]


def oracle(frequency, zeta_1, zeta_2):
    """Coefficients of the digital filter. Prewarping replaces the frequency by the one that the bilinear transform
    maps onto it."""
    omega = 2.0 * RATE * np.tan(np.pi * frequency / RATE)
    return signal.bilinear([1 / omega**2, 2 * zeta_1 / omega, 1], [1 / omega**2, 2 * zeta_2 / omega, 1], RATE)


def analogue(frequency, zeta_1, zeta_2, at):
    """|G| of (3.19) at the frequencies (Hz) that the bilinear transform's tangent stretches."""
    s = 1j * np.tan(np.pi * at / RATE) / np.tan(np.pi * frequency / RATE)
    return np.abs((s**2 + 2 * zeta_1 * s + 1) / (s**2 + 2 * zeta_2 * s + 1))


def check(name, worst, bound):
    print(f"{name:<52} {worst:.3g} (bound {bound:.3g})")
    return worst <= bound


def main():
    good = True
    impulse = np.zeros(TICKS)
    impulse[0] = AMPLITUDE
    for notch in NOTCHES:
        arguments = [str(value) for value in (*notch, AMPLITUDE, TICKS)]
        printed = subprocess.run([sys.argv[1], *arguments], check=True, capture_output=True, text=True).stdout
        fixed, real = np.array([line.split() for line in printed.splitlines()], dtype=float).T
        b, a = oracle(*notch)
        expected = signal.lfilter(b, a, impulse)
        label = f"notch {notch[0]} Hz, {notch[1]}/{notch[2]}: "

        # Double: some 1e-16 of the amplitude per tick, summed by the slowest pole's memory (below 1000 ticks).
        good &= check(label + "double, impulse", np.abs(real - expected).max(), 1e-10)

        # Fixed: each of five coefficients is off by half a bit, which acts like an error at the input of 1/A; each output
        # is rounded by half a bit, whose difference (the remainder is carried on) enters there too.
        poles = signal.lfilter([1.0], a, np.eye(1, TICKS)[0])
        carried = signal.lfilter([1.0, -1.0], a, np.eye(1, TICKS)[0])
        signals = np.abs(impulse) + np.abs(expected)
        per_tick = signal.lfilter(np.ones(3), [1.0], signals) * COEFFICIENT_BIT / 2
        bound = signal.lfilter(np.abs(poles), [1.0], per_tick).max() + np.abs(carried).sum() * CURRENT_BIT / 2
        good &= check(label + "fixed, impulse", np.abs(fixed - expected).max(), 1.01 * bound)

        # The frequency response of both, over what the impulse response holds: it has died away by the last tick.
        at = np.array([1, 10, 30, 50, 70, 100, 300, 1000, 1700, 1900, 2000, 2100, 3000, 5000, 7000, 7900.0])
        kernel = np.exp(-2j * np.pi * np.outer(at, np.arange(TICKS)) / RATE)
        magnitude = analogue(*notch, at)
        good &= check(label + "double, |G|", np.abs(np.abs(kernel @ real) / AMPLITUDE - magnitude).max(), 1e-10)
        # Coefficients: numerator and denominator by up to 3 and 2 half bits over |A|. Rounding: half bits of unrelated
        # sign, so that a second of them sums to its root.
        _, a_response = signal.freqz(a, [1.0], worN=2 * np.pi * at / RATE)
        allowed = (3 + 2 * magnitude) * COEFFICIENT_BIT / 2 / np.abs(a_response)
        allowed += np.sqrt(TICKS) * CURRENT_BIT / 2 / AMPLITUDE
        excess = np.abs(np.abs(kernel @ fixed) / AMPLITUDE - magnitude) / allowed
        good &= check(label + "fixed, |G|, of its bound", excess.max(), 1.0)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
