#!/usr/bin/env python3
"""Replays every case with the programme and compares command and positions with the truth.

usage: compare_all.py PROGRAMME [CASE...] [--figures FILE]
  The encoders count picometres, so that no count can fall to either side of a border, and the plant takes so many steps
  that its own error lies below the bounds. A line a case; status 1 where a difference is above its bound.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import cases
import compare
from write_truth import write

INCREMENT = 1e-12  # m or rad
STEPS = 1024  # of the plant in a tick
FINER = {"pendulum_pd_voltage": 4096}  # a friction as steep as its ramp asks for more
MOST_COMMAND, MOST_POSITION = 1e-6, 1e-9


def machine_text(name, text):
    """The case's machine file with as many steps of the plant, and the law that sticks (equations.md, 9, 28)."""
    steps = f"plant_steps = {FINER.get(name, STEPS)}"
    return text.replace("[timing]", f"[timing]\n{steps}", 1).replace("coulomb_viscous", "classical")


def run(programme, name, folder):
    """Whether the programme's command and positions of a case lie within the bounds, which it prints; the difference of
    the command over its rms, and the largest of a position (m or rad)."""
    table, file = write(name, folder, increment=INCREMENT)
    file.write_text(machine_text(name, file.read_text(encoding="utf-8")), encoding="utf-8")
    log = folder / f"{name}_replayed.csv"
    command = [programme, "simulate", "replay", "--from", table, "--machine", file, "--signals", "double", "--log", log]
    done = subprocess.run(command, capture_output=True, text=True)
    print(f"{name}:")
    if done.returncode != 0:
        print(f"  status {done.returncode}: {done.stderr.strip()}")
        return False, float("inf"), float("inf")
    found, truth = compare.read(log), compare.read(table)
    sound = compare.compare(found, truth, MOST_COMMAND, MOST_POSITION)
    (_, ratio), positions = compare.differences(found, truth)
    return sound, ratio, max(largest for largest, _ in positions.values())


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("programme")
    parser.add_argument("case", nargs="*", choices=[[], *cases.CASES])
    parser.add_argument("--figures", type=pathlib.Path, help="write the largest differences into this file")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        runs = [run(options.programme, name, pathlib.Path(folder)) for name in options.case or cases.CASES]
    sound = [each[0] for each in runs]
    lines = [f"axes of any kind against equations: cases within the bounds: {sum(sound)} of {len(sound)}",
             f"axes of any kind against equations: command, largest rms of a case: {max(r[1] for r in runs):.2g} of its rms",
             f"axes of any kind against equations: position, largest: {1e9 * max(r[2] for r in runs):.2g} nm or nrad"]
    if options.figures:
        options.figures.parent.mkdir(parents=True, exist_ok=True)
        options.figures.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))
    print(f"{sum(sound)} of {len(sound)} cases within {MOST_COMMAND:g} of the command's rms and {MOST_POSITION:g} m or rad")
    return 0 if all(sound) else 1


if __name__ == "__main__":
    sys.exit(main())
