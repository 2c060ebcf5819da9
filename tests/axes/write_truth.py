#!/usr/bin/env python3
"""Writes the machine file and the true log of a case in the columns of docs/formats.md, in full precision.

usage: write_truth.py CASE... --out DIR [--true] [--increment 1e-12]
  CASE: a name of cases.py, or "all". DIR gets CASE.toml and CASE.csv.
  --true: columns x and x_load without the encoders' steps and delays, for comparing positions to a nanometre.
  --increment: of each encoder and of the position error, in m or rad, in place of the case's own; with so fine a one no
  count falls to the other side of a border by an integrator's last digits.
"""

import argparse
import pathlib

import numpy as np

import cases
from simulate import simulate


def columns(machine, sets, made, true=False):
    """Header to values: set-points, encoders, command and current at the samples, SI units in the headers."""
    length = "rad" if machine.kind == "rotary" else "m"
    t = np.arange(len(sets)) * machine.tick
    log = {"t[s]": t, f"x_set[{length}]": made["x_set"], f"v_set[{length}/s]": made["v_set"],
           f"a_set[{length}/s^2]": made["a_set"]}
    body = lambda row: made["q_motor" if row[0] else "q_load"]
    log[f"x[{length}]"] = body(machine.rows[0]) if true else made["x"]
    if machine.second:
        log[f"x_load[{length}]"] = body(machine.rows[2]) if true else made["x_load"]
    if not machine.electrical:
        log["i[A]" if machine.drives_current else "u[V]"] = made["command"]
    elif machine.unit == "A":
        log["i_set[A]"], log["i[A]"] = made["command"], made["amplitude"]
    else:
        log["u[V]"], log["i[A]"] = made["command"], made["amplitude"]
    return log


def write(name, folder, true=False, increment=None):
    """Writes both files of a case into the folder and returns their paths; true and increment as in the usage."""
    machine, sets = cases.load(name, increment)
    made = simulate(machine, sets)
    made["amplitude"] = made["force"] / machine.unit_force
    log = columns(machine, sets, made, true)
    table, file = folder / f"{name}.csv", folder / f"{name}.toml"
    np.savetxt(table, np.column_stack(list(log.values())), fmt="%.17g", delimiter=",", header=",".join(log), comments="")
    file.write_text(machine.text, encoding="utf-8")
    return table, file


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("case", nargs="+", choices=[*cases.CASES, "all"])
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--true", action="store_true")
    parser.add_argument("--increment", type=float)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for name in cases.CASES if "all" in options.case else options.case:
        table, file = write(name, options.out, options.true, options.increment)
        print(f"{table} {file}")


if __name__ == "__main__":
    main()
