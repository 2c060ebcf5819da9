"""Compares the zero-phase filters with scipy: the recipe's two, an odd order, an edge as low as 16 kHz logs need; and the
derivatives with the central differences of 11 points that are exact for polynomials of the tenth degree.

usage: filter_oracle.py FILTER_RESPONSE      the program that filters standard input
"""
import subprocess
import sys

import numpy as np
from scipy import signal, special

# Kind, order, edge, padding.
CASES = [
    ("butterworth", 4, 0.2, 12),
    ("butterworth", 3, 0.05, 9),
    ("chebyshev", 8, 0.08, 24),
    ("chebyshev", 5, 0.3, 15),
    ("chebyshev", 8, 0.005, 384),
    ("butterworth", 4, 0.2, 0),
]


POINTS = 11  # of a derivative


def printed_by(program, kind, order, edge, padding, values):
    text = "\n".join(f"{v:.17g}" for v in values)
    answer = subprocess.run([program, kind, str(order), str(edge), str(padding)], input=text, check=True,
                            capture_output=True, text=True).stdout
    return np.array(answer.split(), dtype=float)


def central_weights(derivative):
    """Weights of the POINTS values around one: those for which every power up to the tenth has its own derivative."""
    places = np.arange(POINTS) - POINTS // 2
    powers = np.vander(places, increasing=True).T.astype(float)
    wanted = np.zeros(POINTS)
    wanted[derivative] = special.factorial(derivative)
    return np.linalg.solve(powers, wanted)


def derivatives_agree(program, values):
    """Against scipy's correlation with these weights, and against i w of sines up to three tenths of the rate."""
    step, good = 2e-3, True
    extended = np.concatenate([2 * values[0] - values[POINTS // 2:0:-1], values,
                               2 * values[-1] - values[-2:-POINTS // 2 - 1:-1]])
    # What filter.hpp says of their errors, at shares of the rate.
    said = {1: ((0.1, 3.1e-6), (0.24, 1e-2), (0.3, 5.8e-2)), 2: ((0.1, 5.3e-7), (0.24, 2e-3), (0.3, 1.2e-2))}
    for derivative, kind in ((1, "first"), (2, "second")):
        theirs = signal.correlate(extended, central_weights(derivative), mode="valid") / step**derivative
        worst = np.abs(printed_by(program, kind, 0, step, 0, values) - theirs).max() / np.abs(theirs).max()
        good &= worst <= 1e-12
        print(f"{kind} derivative of {POINTS} points: {worst:.2g} (bound 1e-12)")
        for share, bound in said[derivative]:
            w = 2 * np.pi * share / step
            t = step * np.arange(400)
            ours = printed_by(program, kind, 0, step, 0, np.sin(w * t))[50:-50]
            exact = (w * np.cos(w * t) if derivative == 1 else -w * w * np.sin(w * t))[50:-50]
            error = np.abs(ours - exact).max() / w**derivative
            good &= error <= bound
            print(f"{kind} derivative of a sine at {share:g} of the rate: {error:.2g} (bound {bound:g})")
    return good


def main():
    random = np.random.default_rng(1)
    values = np.cumsum(random.standard_normal(2000)) + 5.0
    good = derivatives_agree(sys.argv[1], values)
    for kind, order, edge, padding in CASES:
        ours = printed_by(sys.argv[1], kind, order, edge, padding, values)
        sections = (signal.butter(order, edge, output="sos") if kind == "butterworth"
                    else signal.cheby1(order, 0.05, edge, output="sos"))
        theirs = signal.sosfiltfilt(sections, values, padtype="odd" if padding else None, padlen=padding)
        worst = np.abs(ours - theirs).max() / np.abs(values).max()
        # Sections in another order round differently; the poles of the lowest edge amplify that by 1e5.
        bound = 1e-12 if edge > 0.01 else 1e-8
        good &= worst <= bound
        print(f"{kind:<12} order {order} edge {edge:<6} padding {padding:<4} {worst:.2g} (bound {bound:.2g})")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
