#!/usr/bin/env python3
"""A fleet whose truth is known, judged by `stiction fleet`: how soon a growing Coulomb friction is found and named, how
long the records take, whether trends hold the truth, and how many false alarms there are over many axis-years drawn from
the residuals of those records. Exit 1 where the growth is not found within three months or false alarms exceed ten in
1000 axis-years."""

import argparse
import csv
import json
import pathlib
import resource
import subprocess
import sys
import time

import fleet_records

CAUSES = ("mass", "constant_force", "coulomb", "viscous")
WANTED_MONTHS, WANTED_ALARMS, AXIS_YEARS = 3, 10, 1000


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--program", required=True, help="stiction; its machines lie in ../share")
    parser.add_argument("--alarms", required=True, help="fleet_alarms")
    parser.add_argument("--folder", type=pathlib.Path, required=True, help="for the records and results; both are kept")
    parser.add_argument("--axes", type=int, default=50, help="axes [50]")
    parser.add_argument("--months", type=int, default=24, help="months [24]")
    parser.add_argument("--seed", type=int, default=1, help="what is drawn [1]")
    parser.add_argument("--jobs", type=int, default=2, help="records at a time [2]")
    options = parser.parse_args()
    options.program = pathlib.Path(options.program).resolve()  # records are simulated in folders of their own
    return options


def residuals(table, truths, begin):
    """Lines for fleet_alarms: estimates of axes without growth, relative, less their axis' mean."""
    groups = {}
    for row in table:
        if row["message"]:
            continue
        groups.setdefault((row["axis"], row["parameter"]), []).append(row)
    lines = []
    for (axis, parameter), rows in groups.items():
        truth = truths[int(axis.removeprefix("axis ")) - 1]
        if truth.begin is not None:
            rows = [row for row in rows if row["date"] < fleet_records.date_of(begin)]
        if len(rows) < 3:
            continue
        values = [float(row["value"]) for row in rows]
        mean = sum(values) / len(values)
        scale = mean if parameter != "constant_force" else truth.coulomb
        # A residual from a mean of n is smaller than the deviation that it is of.
        larger = (len(values) / (len(values) - 1)) ** 0.5
        for row, value in zip(rows, values):
            lines.append(f"{CAUSES.index(parameter)} {(value - mean) * larger / scale!r} "
                         f"{abs(float(row['standard_error']) / scale)!r}")
    return lines


def judge(options):
    """Runs `stiction fleet` on a folder without results; its summary, and its time."""
    out = options.folder / "results"
    subprocess.run(["rm", "-rf", out], check=True)
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([options.program, "fleet", options.folder, "--out", out, "--threads", "2", "--json"],
                          capture_output=True, text=True, check=False)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"stiction fleet: exit {done.returncode}: {done.stderr}")
    return json.loads(done.stdout), wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    options = arguments()
    drifting, begin = options.axes // 3, min(12, options.months // 2)
    options.folder.mkdir(parents=True, exist_ok=True)
    truths = fleet_records.write_fleet(options.program, options.folder, options.axes, options.months, options.seed,
                                       drifting, begin, jobs=options.jobs)
    summary, wall, processor = judge(options)
    number = summary["records"]
    print(f"records: {number} of {options.axes} axes over {options.months} months, {len(summary['broken'])} not judged")
    print(f"time: {wall / 60:.1f} min on two threads, {processor:.0f} s of processor time "
          f"({processor / number:.2f} s a record); wanted 40 min for 1200 records")
    for each in summary["scatter"]:
        print(f"scatter between records: {each['parameter']} {100 * each['between_records']:.2f} %")
    name = f"axis {drifting + 1:02d}"
    false, held, all_trends, years, late = 0, 0, 0, 0.0, True
    for axis in summary["axes"]:
        grown = axis["axis"] == name
        years += axis["records"] / summary["records_per_year"]
        for each in axis["parameters"]:
            alarm = each["alarm"]
            if grown and each["parameter"] == "coulomb":
                if alarm and alarm["date"] >= fleet_records.date_of(begin):
                    month = next(k for k in range(options.months) if fleet_records.date_of(k) == alarm["date"])
                    late = month - begin + 1 > WANTED_MONTHS
                    print(f"growth of 2 % a month: alarm with the record of month {month - begin + 1} (wanted "
                          f"{WANTED_MONTHS}), change {100 * alarm['change'] / each['scale']:+.1f} % since {alarm['since']}; "
                          f"diagnosis: {', '.join(alarm['diagnosis']['causes']) or alarm['diagnosis']['message'] or 'no cause'}; "
                          f"rank {summary['axes'].index(axis) + 1} of {options.axes}")
                continue
            if alarm:
                false += 1
                print(f"false alarm: {axis['axis']} {each['parameter']} on {alarm['date']}")
            if each["per_month_low"] is not None:
                all_trends += 1
                held += each["per_month_low"] <= 0.0 <= each["per_month_high"]
    if late:
        print("growth of 2 % a month: NOT found within three months")
    print(f"false alarms among these records: {false} in {years:.0f} axis-years")
    print(f"trends without a change: {held} of {all_trends} intervals hold 0 ({100 * held / all_trends:.1f} %; 95 % stated)")
    with open(options.folder / "results" / "fleet.csv", newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    place = options.folder / "residuals.txt"
    place.write_text("\n".join(residuals(table, truths, begin)) + "\n", encoding="utf-8")
    rate = summary["false_alarms_per_axis_year"]
    drawn = subprocess.run([options.alarms, str(options.seed + 1), str(AXIS_YEARS), str(rate), place],
                           capture_output=True, text=True, check=True).stdout
    print(f"drawn from the residuals of these records, seed {options.seed + 1}:\n{drawn}", end="")
    alarms = int(drawn.split()[2])
    return 1 if late or alarms > WANTED_ALARMS else 0


if __name__ == "__main__":
    sys.exit(main())
