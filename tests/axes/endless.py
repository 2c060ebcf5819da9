#!/usr/bin/env python3
"""The exact phase of an endless axis behind a gear of 355/113, far beyond what a double's digits hold.

A motor encoder counts C edges a motor turn. The output turns 113/355 as often, so that n counts are n*113/(355*C) turns,
a fraction that no whole number of counts a turn can express: whoever adds up a rounded modulus drifts. The table holds
the exact fraction after long ways forth and back.

usage: endless.py [--counts 10000] [--turns 1000000000] [--out FILE]
columns: moved[counts] of this row, total[counts] since the start, whole[turns] of the output (floor), phase_numerator and
  phase_denominator (exact fraction of a turn in 0..1), phase[deg] and phase[rad] (rounded once, to the nearest double).
"""

import argparse
import csv
import sys
from fractions import Fraction

RATIO = Fraction(355, 113)  # motor turns per output turn
# pi to 50 digits, for one rounding only. Source: OEIS A000796.
PI = Fraction("3.14159265358979323846264338327950288419716939937510")


def rows(counts, turns, ratio=RATIO):
    """Dictionaries of the columns. counts: edges per motor turn; turns: output turns of the longest way."""
    per_turn = ratio * counts  # counts in a turn of the output, a fraction
    far = int(per_turn * turns)
    ways = [0, 1, -1, -1, 1, int(per_turn), 1, -int(per_turn) - 1, far, -far, far, 12345, -far - 12345]
    ways += [-far, far, far // 7, -(far // 3), far // 7 * 5, -(far // 7 * 6 - far // 3)]
    # All whole multiples of the numerator end at the phase where they began.
    ways += [ratio.numerator * counts * (turns // ratio.denominator), 1, -1]
    total = 0
    for way in ways:
        total += way
        angle = Fraction(total) / per_turn
        whole = angle.numerator // angle.denominator
        phase = angle - whole
        yield {"moved[counts]": way, "total[counts]": total, "whole[turns]": whole,
               "phase_numerator": phase.numerator, "phase_denominator": phase.denominator,
               "phase[deg]": f"{float(360 * phase):.17g}", "phase[rad]": f"{float(2 * PI * phase):.17g}"}


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("--counts", type=int, default=10000)
    parser.add_argument("--turns", type=int, default=10**9)
    parser.add_argument("--out", default="-")
    options = parser.parse_args()
    made = list(rows(options.counts, options.turns))
    with (sys.stdout if options.out == "-" else open(options.out, "w", encoding="utf-8", newline="")) as file:
        writer = csv.DictWriter(file, made[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(made)


if __name__ == "__main__":
    main()
