#!/usr/bin/env python3
"""The whole turns and the rest that the firmware keeps of an endless axis, against the exact fractions of
tests/axes/endless.py.

usage: endless_oracle.py PROGRAM      PROGRAM: endless_phase_steps
"""

import pathlib
import subprocess
import sys
from fractions import Fraction

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "axes"))
import endless

# Edges a motor turn, turns of the longest way, ratio: that of the shipped table, one below 1, and a long decimal.
CASES = [(10000, 10**9, endless.RATIO), (4, 10**12, Fraction(22, 7)), (2**20, 10**9, Fraction(113, 355)),
         (16384, 10**9, Fraction("3.14159265358979"))]


def main():
    program = sys.argv[1]
    rows = 0
    for counts, turns, ratio in CASES:
        truth = list(endless.rows(counts, turns, ratio))
        turn = ratio * counts
        kept = subprocess.run([program, str(turn.numerator), str(turn.denominator)], check=True, text=True,
                              input="".join(f"{row['moved[counts]']}\n" for row in truth), capture_output=True)
        lines = kept.stdout.splitlines()
        if len(lines) != len(truth):
            sys.exit(f"found {len(lines)} lines; expected {len(truth)}, one a way")
        for line, row in zip(lines, truth):
            whole, rest, phase = map(int, line.split())
            exact = Fraction(row["phase_numerator"], row["phase_denominator"])
            found = (whole, Fraction(rest, turn.numerator), phase)
            expected = (row["whole[turns]"], exact, exact.numerator * 2**32 // exact.denominator)
            if found != expected:
                sys.exit(f"{counts} edges, ratio {ratio}, {row['total[counts]']} counts: found {found}; "
                         f"expected {expected}")
            rows += 1
    print(f"endless axes: {rows} ways of up to {max(case[1] for case in CASES):.0e} turns equal to the last digit")


if __name__ == "__main__":
    main()
