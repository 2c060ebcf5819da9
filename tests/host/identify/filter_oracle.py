"""Compares the zero-phase filters with scipy: the recipe's two, an odd order, an edge as low as 16 kHz logs need.

usage: filter_oracle.py FILTER_RESPONSE      the program that filters standard input
"""
import subprocess
import sys

import numpy as np
from scipy import signal

# Kind, order, edge, padding.
CASES = [
    ("butterworth", 4, 0.2, 12),
    ("butterworth", 3, 0.05, 9),
    ("chebyshev", 8, 0.08, 24),
    ("chebyshev", 5, 0.3, 15),
    ("chebyshev", 8, 0.005, 384),
    ("butterworth", 4, 0.2, 0),
]


def main():
    random = np.random.default_rng(1)
    values = np.cumsum(random.standard_normal(2000)) + 5.0
    good = True
    for kind, order, edge, padding in CASES:
        text = "\n".join(f"{v:.17g}" for v in values)
        printed = subprocess.run([sys.argv[1], kind, str(order), str(edge), str(padding)], input=text, check=True,
                                 capture_output=True, text=True).stdout
        ours = np.array(printed.split(), dtype=float)
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
