#!/usr/bin/python3
"""Whether generator and programme mean the same machine by the same file: exact machines, replayed by the programme.

usage: conventions.py --stiction PATH [--cases 10] [--seed 1] [--as-is]
  Prints the rms difference of position (nm or nrad) and of the motor's force (parts of Coulomb friction). Encoders have
  an increment of 1e-12 unless --as-is: steps make both loops hunt, each in its own way. Exits with 1 above 2 %.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import paths  # noqa: F401
import numpy as np

import machine_file
import machines
import plant
import records
import trajectories

UNITS = {"mm": 1e-3, "m": 1.0, "um": 1e-6, "deg": np.pi / 180, "rad": 1.0, "A": 1.0, "mA": 1e-3}


def read(file):
    """Columns of a log in SI units, by their names."""
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    values = np.array([[float(v) for v in line.split(",")] for line in lines[1:]])
    made = {}
    for k, head in enumerate(lines[0].split(",")):
        name, _, unit = head.partition("[")
        made[name] = values[:, k] * UNITS.get(unit.rstrip("]"), 1.0)
    return made


def compared(stiction, seed, as_is, folder):
    """Prints one machine's line; returns the difference of force over Coulomb friction."""
    rng = np.random.default_rng([seed, 5])
    m = machines.draw(rng, rotary=seed % 3 == 1, two=seed % 5 == 4)
    if not as_is:
        m.increment, m.position_increment = 1e-12, 0.0
    train, _ = trajectories.commissioning(rng, m.room(), machines.TICK)
    sets = train[seed % len(train)]
    m.bits = 0
    mine = records.record(m, sets, plant.simulate(m.plant(), m.control(), sets, substeps=4))
    file, log, out = folder / "machine.toml", folder / "mine.csv", folder / "replayed.csv"
    file.write_text(machine_file.text(m), encoding="utf-8")
    records.write(mine, log, m)
    replay = ["simulate", "replay", "--signals", "double", "--from", str(log), "--machine", str(file)]
    replay += ["--log", str(out)]
    for command in (["machine", "check", str(file)], replay):
        ran = subprocess.run([stiction, *command], capture_output=True, text=True)
        if ran.returncode:
            print(f"{seed}: {command[0]}: {ran.stderr.strip()}")
            return 1.0
    theirs = read(out)
    n = min(len(theirs["x"]), len(mine.x))
    x = np.sqrt(np.mean((theirs["x"][:n] - mine.x[:n]) ** 2))
    force = np.sqrt(np.mean((theirs["i"][:n] - mine.i[:n]) ** 2)) * m.force_constant / m.coulomb
    error = np.sqrt(np.mean((mine.x - mine.sets[:, 0]) ** 2))
    print(f"{seed}: {m.friction}, {m.model}, {'rotary' if m.rotary else 'linear'}{', two bodies' if m.shaft else ''}, "
          f"{m.velocity}, {m.rate:g} Hz: position {1e9 * x:.3g} n (following error {1e9 * error:.3g} n), "
          f"force {100 * force:.3g} %", flush=True)
    return force


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("--stiction", required=True)
    parser.add_argument("--cases", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--as-is", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        worst = max(compared(options.stiction, options.seed + k, options.as_is, pathlib.Path(folder))
                    for k in range(options.cases))
    sys.exit(1 if worst > 0.02 else 0)


if __name__ == "__main__":
    main()
