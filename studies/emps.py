"""How the parameters of an axis become certain as its record grows: the EMPS axis (docs/sources.md).

usage: emps.py FOLDER [--record CSV] [--shares 0.25,0.5,0.75,1]

Identifies mass and friction from the first part of the published record, for growing parts, with the recipe of its
authors. Without --record the machine file of EMPS is simulated along the same kind of motion, and its own record is taken:
then the values that come back are known. Writes emps.txt and emps.svg into FOLDER.
"""

import argparse
import pathlib
import tempfile

import numpy as np

import stiction
from picture import picture

MACHINE = "emps"
TRUTH = {"mass_kg": 95.1089, "viscous_N_s_per_m": 203.5034, "coulomb_N": 20.3935}  # the source's


def simulated_record(path):
    """A sine of the simulated axis as a log with set-points, position and current."""
    found = stiction.simulate("circle", MACHINE, logs=True)
    found.logs[0].write(path)


def part_of(log, share, path):
    """Writes the first `share` of the samples of `log` as a file."""
    count = max(int(share * len(log["t"])), 2)
    names = [name for name in log if not name.endswith("temperature")]
    table = np.column_stack([log[name][:count] for name in names])
    header = ",".join(f"{name}[{log.units[name]}]" for name in names)
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.17g")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--record", type=pathlib.Path, help="the published record as a log of stiction (CSV)")
    parser.add_argument("--shares", default="0.25,0.5,0.75,1")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    shares = [float(each) for each in options.shares.split(",")]
    with tempfile.TemporaryDirectory() as place:
        record = options.record or pathlib.Path(place) / "record.csv"
        if options.record is None:
            simulated_record(record)
        log = stiction.read_log(record)
        found = []
        for share in shares:
            part = pathlib.Path(place) / "part.csv"
            part_of(log, share, part)
            found.append(stiction.identify(part, MACHINE, friction="coulomb_viscous")["parameters"])

    names = [name for name in found[-1] if name in TRUTH]
    lines = [f"Parameters of the EMPS axis from parts of {'its record' if options.record else 'a simulated record'}", "",
             "seconds  " + "  ".join(f"{name:>28}" for name in names)]
    for share, parameters in zip(shares, found):
        cells = (f"{parameters[name]['value']:10.3f} [{parameters[name]['ci95'][0]:.3f}, {parameters[name]['ci95'][1]:.3f}]"
                 for name in names)
        lines.append(f"{share * len(log['t']) * log.period:7.2f}  " + "  ".join(f"{cell:>28}" for cell in cells))
    lines.append("source   " + "  ".join(f"{TRUTH[name]:28.3f}" for name in names))
    (options.folder / "emps.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    seconds = [share * len(log["t"]) * log.period for share in shares]
    curves = [(name, seconds, [each[name]["value"] / TRUTH[name] for each in found]) for name in names]
    (options.folder / "emps.svg").write_text(picture(curves, "record, s", "value over that of the source"),
                                             encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
