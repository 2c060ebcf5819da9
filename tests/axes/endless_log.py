#!/usr/bin/env python3
"""The phase that the programme writes of an endless axis, against exact fractions of the counts in the same log.

usage: endless_log.py PROGRAMME
  The table behind a gear of 355/113 turns forth, stops and turns farther back; its log has the position of the encoder
  in rad, of which the counts are the nearest whole number of increments. Status 1 where a phase differs in its last
  digit.
"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
from fractions import Fraction

MACHINE = pathlib.Path(__file__).resolve().parent / "machines/endless_355_113_cascade.toml"
COUNTS, RATIO = 10000, Fraction(355, 113)  # of the file
PERIOD = 1e-3  # s


def set_points():
    """(t, x_set) of a motion over several turns forth and more back, with a continuous velocity."""
    for k in range(6000):
        t = k * PERIOD
        yield t, 9.0 * (1.0 - math.cos(1.1 * t)) - 6.0 * (t - math.sin(1.1 * t) / 1.1)


def columns(file):
    """Name of each column, without axis, to its values; and the text of the header."""
    with file.open(encoding="utf-8", newline="") as opened:
        rows = list(csv.reader(line for line in opened if not line.startswith("#")))
    return {name.rpartition(".")[2]: [row[at] for row in rows[1:]] for at, name in enumerate(rows[0])}


def differences(found):
    """Rows whose phase is not the exact one, rounded down to 2^-32 turns."""
    turn = COUNTS * RATIO  # counts a turn of the axis
    for row, (x, phase) in enumerate(zip(found["x[rad]"], found["phase[deg]"])):
        count = round(float(x) / (2 * math.pi) * COUNTS * 355 / 113)
        exact = Fraction(count) / turn
        part = exact - exact.__floor__()
        if Fraction(float(phase)) != Fraction(math.floor(part * 2**32) * 360, 2**32):
            yield f"row {row + 1}: count {count}: found {phase} deg; expected {float(360 * part):.17g} deg"


def run(programme, *arguments):
    done = subprocess.run([programme, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: status {done.returncode}\n{done.stderr}")
    return done.stdout


def main():
    programme = sys.argv[1]
    checked = json.loads(run(programme, "machine", "check", MACHINE, "--json"))["axes"][0]["endless"]
    if checked != {"encoder_on": "motor", "counts_numerator": 3550000, "counts_denominator": 113}:
        sys.exit(f"machine check --json: found {checked}; expected 3550000/113 counts of the motor's encoder")
    if "3550000/113" not in run(programme, "machine", "--check", MACHINE):
        sys.exit("machine --check: found no 3550000/113; expected it among the values of the axis")
    wrong, rows, turns = [], 0, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        wanted = folder / "wanted.csv"
        wanted.write_text("t[s],x_set[rad],x[rad],u[V]\n" +
                          "".join(f"{t!r},{x!r},{x!r},0\n" for t, x in set_points()), encoding="utf-8")
        for signals in ("fixed", "double"):
            log = folder / f"{signals}.csv"
            run(programme, "simulate", "replay", "--from", wanted, "--machine", MACHINE, "--signals", signals, "--log", log)
            found = columns(log)
            wrong += [f"replay --signals {signals}: {each}" for each in differences(found)]
            rows += len(found["phase[deg]"])
            turns.append(max(map(float, found["x[rad]"])) - min(map(float, found["x[rad]"])))
            run(programme, "inspect", log, "--machine", MACHINE)  # which ignores the column
        records = folder / "records"
        # Its controller follows the starts of the records by more than the usual 5.7 deg.
        run(programme, "simulate", "commissioning", "--machine", MACHINE, "--out", records, "--set",
            "axis.R.supervision.following_error=30 deg")
        for log in sorted(records.glob("*.csv")):
            found = columns(log)
            wrong += [f"{log.name}: {each}" for each in differences(found)]
            rows += len(found["phase[deg]"])
    if min(turns) < 4 * 2 * math.pi:
        sys.exit(f"found a motion over {min(turns):.3g} rad; expected four turns")
    print(f"phase of an endless axis: {rows} samples, {len(wrong)} of them off")
    if wrong:
        print("\n".join(wrong[:10]))
        sys.exit(1)


if __name__ == "__main__":
    main()
