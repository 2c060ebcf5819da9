"""Records of a fleet whose truth is known: axes of one shipped machine with masses and friction of their own, a record a
month at drawn room temperatures and speeds, with noise of guides and sensor, missing months, and one axis whose Coulomb
friction grows. `stiction simulate replay` moves the axes; the estimator takes no part in it."""

import concurrent.futures
import csv
import datetime
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "matrix"))

import records  # noqa: E402

MACHINE, AXIS = "emps", "X"
MASS, COULOMB, VISCOUS, FORCE_CONSTANT = 95.1089, 20.3935, 203.5034, 35.15065188248547  # kg, N, N s/m, N/V
TRAVEL, SPEED, ACCELERATION = 0.25, 0.2, 1.0

# What differs from record to record without a reason that the fleet should find, as standard deviations.
ROOM = 3.0                 # K around 20 degC
VISCOUS_PER_KELVIN = -0.015
COULOMB_PER_KELVIN = -0.002
COULOMB_SCATTER = 0.008    # oil, wipers
MASS_SCATTER = 0.002       # what lies on the carriage
FORCE_SCATTER = 0.01       # of the Coulomb friction


class Truth:
    """Axis `number` of a fleet of `seed`; its Coulomb friction grows by `drift` a month of the first level from the
    month `begin` on (None: never)."""

    def __init__(self, seed, number, begin=None, drift=0.02):
        draw = records.drawing(seed, "axis", number)
        self.seed, self.number, self.begin, self.drift = seed, number, begin, drift
        self.mass = MASS * draw.uniform(0.95, 1.05)
        self.coulomb = COULOMB * draw.uniform(0.8, 1.3)
        self.viscous = VISCOUS * draw.uniform(0.8, 1.3)

    def at(self, month):
        """Mass, Coulomb and viscous friction, constant force of the record of that month, and its motion's draw."""
        draw = records.drawing(self.seed, "record", self.number, month)
        room = draw.gauss(0.0, ROOM)
        grown = 1.0 + self.drift * max(0, month - self.begin + 1) if self.begin is not None else 1.0
        coulomb = self.coulomb * grown * math.exp(COULOMB_PER_KELVIN * room) * (1.0 + draw.gauss(0.0, COULOMB_SCATTER))
        return {"mass": self.mass * (1.0 + draw.gauss(0.0, MASS_SCATTER)), "coulomb": coulomb,
                "viscous": self.viscous * math.exp(VISCOUS_PER_KELVIN * room),
                "constant_force": draw.gauss(0.0, FORCE_SCATTER) * self.coulomb}, draw


def write_record(program, truth, month, place):
    """The record of `month` in the file `place`."""
    values, draw = truth.at(month)
    limits = records.Limits(TRAVEL, SPEED, ACCELERATION, False)
    top = draw.uniform(0.8, 1.0) * limits.speed  # the feed of the day
    points = records.constant_speeds(limits, [top * share for share in (0.15, 0.4, 1.0)], 0.5 * limits.amplitude)
    usual = 0.03 * truth.coulomb
    with tempfile.TemporaryDirectory(prefix="stiction-fleet-") as folder:
        folder = pathlib.Path(folder)
        records.write_set_points(folder / "set.csv", AXIS, points, False, draw, usual / records.SLOW)
        key = f"axis.{AXIS}.friction.coulomb_viscous"
        # The file's effect is a constant force of 3.1648 N; the day's differs from it.
        push_into(folder / "set.csv", values["constant_force"])
        command = [program, "simulate", "replay", "--from", "set.csv", "--machine", MACHINE, "--log", "run.csv",
                   "--set", f"axis.{AXIS}.mass={values['mass']!r} kg", "--set", f"{key}.coulomb={values['coulomb']!r} N",
                   "--set", f"{key}.viscous={values['viscous']!r} N s/m"]
        done = subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
        records.strip(folder / "run.csv", place, AXIS, usual / FORCE_CONSTANT, draw)


def push_into(file, force):
    """Adds a constant `force` (N) to the force on the carriage."""
    with open(file, newline="", encoding="utf-8") as source:
        head, *rows = list(csv.reader(source))
    column = head.index(f"{AXIS}.F_ext[N]")
    for row in rows:
        row[column] = repr(float(row[column]) + force)
    with open(file, "w", newline="", encoding="utf-8") as target:
        csv.writer(target).writerows([head, *rows])


def date_of(month):
    """The first day of the month, from January 2024 on."""
    return datetime.date(2024 + month // 12, month % 12 + 1, 1).isoformat()


def write_fleet(program, folder, axes, months, seed, drifting=None, begin=12, drift=0.02, missing=0.05, jobs=2):
    """A fleet in `folder`: logs and fleet.csv. `drifting`: the axis that grows, from the month `begin` (from 0) on;
    `missing`: share of months without a record. What is there already is not made again. Returns the truths."""
    folder = pathlib.Path(folder)
    (folder / "logs").mkdir(parents=True, exist_ok=True)
    truths = [Truth(seed, k, begin if k == drifting else None, drift) for k in range(axes)]
    rows, work = [], []
    for truth in truths:
        gaps = records.drawing(seed, "missing", truth.number)
        for month in range(months):
            kept = gaps.random() >= missing or truth.number == drifting
            if not kept:
                continue
            log = f"logs/axis{truth.number + 1:02d}-{date_of(month)}.csv"
            rows.append([f"axis {truth.number + 1:02d}", MACHINE, date_of(month), log])
            if not (folder / log).exists():
                work.append((truth, month, folder / log))

    def make(item):
        truth, month, place = item
        part = place.with_suffix(".part")
        write_record(program, truth, month, part)
        part.rename(place)

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done, _ in enumerate(pool.map(make, work), 1):
            if done % 50 == 0:
                print(f"{done} of {len(work)} records made", flush=True)
    with open(folder / "fleet.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["axis", "machine", "date", "log"], *rows])
    return truths
