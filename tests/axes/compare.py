#!/usr/bin/env python3
"""Compares a log with the truth of the same case, sample by sample.

usage: compare.py LOG TRUTH [--command 1e-6] [--position 1e-9]
  Prints the rms of the command's difference over the rms of the true command, and the largest difference of each
  position with its unit. Status 1 where one of them is above its bound, 2 where the logs cannot be compared.
"""

import argparse
import csv
import math
import sys

import numpy as np

LENGTHS = {"m": ("m", 1.0), "mm": ("m", 1e-3), "um": ("m", 1e-6), "nm": ("m", 1e-9), "rad": ("rad", 1.0),
           "deg": ("rad", math.pi / 180)}
COMMANDS = ("i_set", "u", "i", "F", "T")  # the first that both logs have is what the controller commands


def read(path):
    """Name of each column without axis and unit, to its unit and its values."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        header = next(rows)
        values = np.array([[float(cell) for cell in row] for row in rows])
    found = {}
    for name, column in zip(header, values.T):
        name, _, unit = name.rstrip("]").partition("[")
        found[name.rpartition(".")[2]] = (unit, column)
    return found


def command_difference(log, truth):
    """Name of the command that both have, and the rms of its difference over its true rms; inf without one."""
    name = next((c for c in COMMANDS if c in log and c in truth), None)
    if name is None:
        raise ValueError(f"found no common command; expected one of {', '.join(COMMANDS)} in both logs")
    (unit, ours), (true_unit, true) = log[name], truth[name]
    if unit != true_unit:
        raise ValueError(f"found {name} in {unit} and in {true_unit}; expected one unit")
    return name, float(np.sqrt(np.mean((ours - true) ** 2) / np.mean(true**2)))


def position_difference(log, truth, name):
    """Largest difference of a position in m or rad, and its unit."""
    (unit, factor), (true_unit, true_factor) = LENGTHS[log[name][0]], LENGTHS[truth[name][0]]
    if unit != true_unit:
        raise ValueError(f"found {name} in {unit} and in {true_unit}; expected one unit")
    return float(np.abs(log[name][1] * factor - truth[name][1] * true_factor).max()), unit


def differences(log, truth):
    """That of the command over its rms, and the largest of each position that the truth has (m or rad), with its unit."""
    if len(log["t"][1]) != len(truth["t"][1]):
        raise ValueError(f"found {len(log['t'][1])} and {len(truth['t'][1])} samples; expected the same number")
    late = np.abs(log["t"][1] - truth["t"][1]).max()
    if not late < 1e-9:
        raise ValueError(f"found time stamps that differ by {late:.3g} s; expected the same samples")
    positions = {}
    for position in ("x", "x_load"):
        if position not in truth:
            continue
        if position not in log:
            raise ValueError(f"found no column {position}; expected it, because the truth has it")
        positions[position] = position_difference(log, truth, position)
    return command_difference(log, truth), positions


def compare(log, truth, most_command, most_position):
    """Prints each difference and returns whether all lie within their bounds."""
    (name, ratio), positions = differences(log, truth)
    sound = ratio <= most_command  # a NaN is not within a bound
    print(f"{name}: rms of the difference over rms: {ratio:.3g} (bound {most_command:.3g})")
    for position, (largest, unit) in positions.items():
        sound = sound and largest <= most_position
        print(f"{position}: largest difference: {largest:.3g} {unit} (bound {most_position:.3g} {unit})")
    return sound


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("log")
    parser.add_argument("truth")
    parser.add_argument("--command", type=float, default=1e-6)
    parser.add_argument("--position", type=float, default=1e-9)
    options = parser.parse_args()
    try:
        return 0 if compare(read(options.log), read(options.truth), options.command, options.position) else 1
    except (ValueError, KeyError) as error:
        print(f"compare: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
