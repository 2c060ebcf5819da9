"""Which axis of a fleet wears: friction that grows month by month, found from monthly records.

usage: fleet.py FOLDER [--axes 5] [--months 12] [--growth 0.03] [--seed 1]

Each axis is an EMPS axis (docs/sources.md) with a mass and friction of its own, which records one slow sine a month. The
room is warmer or cooler, the oil older, something lies on the carriage: friction and mass scatter from month to month.
The Coulomb friction of the second axis grows from a third of the time on by `growth` a month. The fleet's judgement knows
nothing of this. Writes fleet.txt and fleet.svg into FOLDER.
"""

import argparse
import csv
import pathlib
import tempfile

import numpy as np

import stiction
from picture import picture

MACHINE, AXIS = "emps", "X"
MASS, COULOMB, VISCOUS = 95.1089, 20.3935, 203.5034  # kg, N, N s/m: the source's
GROWING = 1  # index of the axis
# Standard deviations from month to month, relative.
SCATTER = {"mass": 0.002, "coulomb": 0.01, "viscous": 0.04}


def date_of(month):
    return f"{2024 + month // 12}-{month % 12 + 1:02d}-01"


def write_records(folder, axes, months, growth, seed):
    """The records of a fleet and their list; returns the path of the list."""
    draw = np.random.default_rng(seed)
    own = {"mass": MASS * draw.uniform(0.95, 1.05, axes), "coulomb": COULOMB * draw.uniform(0.8, 1.3, axes),
           "viscous": VISCOUS * draw.uniform(0.8, 1.3, axes)}
    key = f"axis.{AXIS}.friction.coulomb_viscous"
    rows = []
    for axis in range(axes):
        for month in range(months):
            now = {name: own[name][axis] * (1.0 + SCATTER[name] * draw.standard_normal()) for name in own}
            if axis == GROWING:
                now["coulomb"] *= 1.0 + growth * max(0, month + 1 - months // 3)
            machine = stiction.machine(MACHINE, set=[f"axis.{AXIS}.mass={now['mass']} kg",
                                                     f"{key}.coulomb={now['coulomb']} N",
                                                     f"{key}.viscous={now['viscous']} N s/m"])
            log = f"axis{axis + 1}-{date_of(month)}.csv"
            stiction.simulate("circle", machine, logs=True).logs[0].write(folder / log)
            rows.append([f"axis {axis + 1}", MACHINE, date_of(month), log])
    with open(folder / "fleet.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["axis", "machine", "date", "log"], *rows])
    return folder / "fleet.csv"


def trend_of(parameter):
    """ "+1.23 ± 0.45", percent a month with the half of the 95 % interval."""
    if parameter["per_month"] is None:
        return "-"
    half = 50.0 * (parameter["per_month_high"] - parameter["per_month_low"]) / parameter["scale"]
    return f"{100.0 * parameter['relative_per_month']:+.2f} ± {half:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--axes", type=int, default=5)
    parser.add_argument("--months", type=int, default=12)
    parser.add_argument("--growth", type=float, default=0.03, help="of the Coulomb friction, a month")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.axes <= GROWING or options.months < 4:
        parser.error(f"found {options.axes} axes and {options.months} months; expected at least {GROWING + 1} and 4")
    options.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place:
        listed = write_records(pathlib.Path(place), options.axes, options.months, options.growth, options.seed)
        found = stiction.fleet(listed, diagnosis=False)

    names = [each["parameter"] for each in found["axes"][0]["parameters"]]
    lines = [f"Trends of {options.axes} axes over {options.months} months, % a month with 95 % intervals",
             f"The Coulomb friction of axis {GROWING + 1} grows from {date_of(options.months // 3)} on by "
             f"{100.0 * options.growth:g} % a month", "",
             "axis    " + "".join(f"{name:>18}" for name in names) + "  alarms"]
    for axis in sorted(found["axes"], key=lambda each: each["axis"]):
        alarms = [f"{each['parameter']} {each['alarm']['direction']} on {each['alarm']['date']}"
                  for each in axis["parameters"] if each["alarm"]]
        lines.append(f"{axis['axis']:8}" + "".join(f"{trend_of(each):>18}" for each in axis["parameters"]) +
                     "  " + (", ".join(alarms) or "none"))
    (options.folder / "fleet.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")

    # The estimates are arrays: a row for each record and parameter.
    table = found.arrays
    coulomb = table["parameter"] == "coulomb"
    curves = []
    for axis in np.unique(table["axis"]):
        rows = coulomb & (table["axis"] == axis)
        dates = table["date"][rows].astype("datetime64[M]")
        curves.append((str(axis), (dates - np.datetime64(date_of(0), "M")).astype(int), table["value"][rows]))
    (options.folder / "fleet.svg").write_text(picture(curves, f"months from {date_of(0)}", "Coulomb friction, N"),
                                              encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
