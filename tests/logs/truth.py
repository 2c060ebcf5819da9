#!/usr/bin/env python3
"""Logs of axes whose truth is known: draws machines, motions, encoders and rates, simulates them, writes log and file.

usage: truth.py OUT [--seed S] [--count N] [--cell MACHINE RATE INCREMENT] [--motion KIND] [--fault FAULT]
  OUT gets NAME.csv, NAME.toml and NAME.json (what is true, the bounds of fisher.py) of each record; without --cell N
  records of each of the 120 cells. FAULT: see faults.py.
Another programme can call draw_records() and write().
"""

import argparse
import dataclasses
import json
import pathlib

import numpy as np

import axis as plant
import faults
import fisher
import machines
import motions

RATES = (10, 50, 100, 190, 500, 1000, 4000, 16000)  # Hz; 190 Hz with a jitter of 20 %
INCREMENTS = (1e-9, 1e-7, 1e-6, 1e-5, 1e-4)  # m
JITTER = {190: 0.2}  # largest displacement of a stamp over the period
BATCH = 256  # records simulated at once; a tick costs nearly the same for one as for all
MOST_SAMPLES = 6_000_000  # of a batch, or its memory goes beyond a gigabyte


@dataclasses.dataclass
class Record:
    """A log to be: what was drawn and, after run(), what the axis did. t in s, everything in SI units."""

    name: str
    cell: tuple  # machine, rate, increment
    kind: str
    fault: str
    seed: tuple
    axis: machines.Axis
    motion: object
    ticks: np.ndarray
    effort_noise: float  # rms, A or V
    set_points: bool
    inject: object = None
    truth: dict = None
    log: dict = None  # columns as written: header -> values
    rows: np.ndarray = None  # of truth, that the log keeps
    clean: np.ndarray = None  # of truth, that a fit may use
    shift: float = 0.0  # s by which the effort's channel is late

    @property
    def t(self):
        return self.ticks * plant.TICK


def sample_ticks(rng, rate, duration):
    """Ticks of the samples: on the drive's clock, each displaced by up to the jitter; the first one is at 0."""
    grid = np.arange(int(duration * rate)) / rate
    grid[1:] += rng.uniform(-1, 1, len(grid) - 1) * JITTER.get(rate, 0.0) / rate
    return np.round(grid / plant.TICK).astype(np.int64)


def draw_record(seed, cell, index, kind=None, fault="none", law=None, duration=None, set_points=None,
                exact=False):
    """A record of a cell (machine, rate, increment); the same arguments give the same record.

    Left out (None), kind of motion, law, duration and whether there are set-points are drawn. exact: the file is true.
    """
    machine, rate, increment = cell
    key = (seed, machines.AXES.index(machine), rate, round(increment * 1e9), index, faults.FAULTS.index(fault))
    rng = np.random.default_rng(key)
    axis = machines.draw(rng, machine, increment, law, exact)
    axis.force_noise = axis.coulomb * rng.choice([0.0, 0.01, 0.03])
    duration = duration or rng.uniform(*((14, 20) if rate <= 200 else (8, 12) if rate <= 1000 else (5, 7)))
    kind = kind or str(rng.choice(list(motions.KINDS)))
    if fault in ("forward", "backward"):
        motion = motions.speeds(rng, axis, duration, 1 if fault == "forward" else -1)
        kind = "speeds"
    else:
        motion = motions.KINDS[kind](rng, axis, duration)
    effort_noise = axis.coulomb / axis.force_constant * np.exp(rng.uniform(np.log(0.002), np.log(0.05)))
    set_points = bool(rng.random() < 0.75) if set_points is None else set_points
    name = f"{machine}-{rate}Hz-{increment * 1e9:g}nm-{kind}-{index}" + (f"-{fault}" if fault != "none" else "")
    record = Record(name, cell, kind, fault, key, axis, motion, sample_ticks(rng, rate, motion.duration + 0.2),
                    effort_noise, set_points)
    faults.before(record, rng)
    return record


def partner(record):
    """The second record of a pair: the other direction of a one-direction record, the same without its test signal."""
    fault = {"forward": "backward", "inject": "none"}[record.fault]
    other = dataclasses.replace(record, name=f"{record.name}-and-{fault}", fault=fault, inject=None,
                                seed=record.seed + (2,))
    if fault == "backward":
        rng = np.random.default_rng(other.seed)
        other.motion = motions.speeds(rng, record.axis, record.motion.duration, -1)
        other.ticks = sample_ticks(rng, record.cell[1], other.motion.duration + 0.2)
    return other


def draw_records(seed, count, cells=None, **options):
    cells = cells or [(m, r, q) for m in machines.AXES for r in RATES for q in INCREMENTS]
    return [draw_record(seed, cell, k, **options) for cell in cells for k in range(count)]


def batches(records):
    batch, samples = [], 0
    for record in records:
        if batch and (len(batch) == BATCH or samples + len(record.ticks) > MOST_SAMPLES):
            yield batch
            batch, samples = [], 0
        batch.append(record)
        samples += len(record.ticks)
    if batch:
        yield batch


def run(records, progress=lambda text: None):
    """Simulates all records, many at once, and makes their columns. Yields each record when it is ready."""
    groups = {}
    for record in records:
        groups.setdefault((record.axis.effort, record.axis.stiffness == 0), []).append(record)
    for group in groups.values():
        for batch in batches(sorted(group, key=lambda r: r.ticks[-1])):
            rng = np.random.default_rng([7] + [int(r.seed[4]) for r in batch] + list(batch[0].seed))
            made = plant.simulate(rng, [r.axis for r in batch], [r.motion for r in batch], [r.ticks for r in batch],
                                  [r.inject for r in batch], progress)
            for record, truth in zip(batch, made):
                record.truth = truth
                make_columns(record, np.random.default_rng(record.seed + (1,)))
                yield record
                record.truth = record.log = None


def make_columns(record, rng):
    """The columns as a drive's scope has them: samples, not averages, with the sensor's noise, in few digits."""
    truth, axis = record.truth, record.axis
    effort = truth["effort"] + record.effort_noise * rng.standard_normal(len(record.ticks))
    log = {"t[s]": record.t}
    if record.set_points:
        log["x_set[m]"] = truth["x_set"]
    log["x[m]"] = truth["x"]
    if rng.random() < 0.25 and record.effort_noise:  # a drive's own speed, as good as its encoder permits or better
        log["v[m/s]"] = truth["v"] + 1e-4 * axis.max_velocity * rng.standard_normal(len(record.ticks))
    log["i[A]" if axis.effort == "i" else "u[V]"] = effort
    record.log, record.rows = log, np.ones(len(record.ticks), bool)
    record.clean = record.rows.copy()
    faults.after(record, rng)


FORMATS = {"t": "%.7f", "x_set": "%.9f", "x": "%.9f", "v": "%.7f", "i": "%.5f", "u": "%.6f", "i_inject": "%.6f", "u_inject": "%.7f"}


def information_of(record):
    """The Fisher matrix of a record that has been simulated."""
    rows = record.clean if not record.clean.all() else None
    return fisher.information(record.t, record.truth, record.axis, record.effort_noise, record.axis.force_noise, rows)


def describe(record):
    """What is true of a record, for whoever judges the programme's answer."""
    a, matrix = record.axis, information_of(record)
    return {"name": record.name, "cell": list(record.cell), "kind": record.kind, "fault": record.fault,
            "seed": list(record.seed), "set_points": record.set_points, "law": "dahl" if a.stiffness else "coulomb",
            "force_constant": a.force_constant, "stiffness_N_per_m": a.stiffness, "effort_noise": record.effort_noise,
            "force_noise_N": a.force_noise, "encoder_noise_m": a.noise, "file": a.file,
            "shift_s": record.shift,
            "parameters": fisher.told(matrix, (a.mass, a.viscous, a.coulomb, a.offset)),
            "information": matrix.tolist()}


def write(record, folder):
    """Writes NAME.csv, NAME.toml, NAME.json and returns the last one's contents with the paths of the others."""
    folder = pathlib.Path(folder)
    columns = {header: values[record.rows] for header, values in record.log.items()}
    formats = [FORMATS[header.partition("[")[0]] for header in columns]
    log, machine = folder / f"{record.name}.csv", folder / f"{record.name}.toml"
    np.savetxt(log, np.column_stack(list(columns.values())), fmt=formats, delimiter=",", header=",".join(columns), comments="")
    machine.write_text(machines.machine_file(record.axis), encoding="utf-8")
    told = describe(record)
    (folder / f"{record.name}.json").write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")
    return told | {"log": str(log), "machine": str(machine)}


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=1)
    parser.add_argument("--cell", nargs=3, metavar=("MACHINE", "RATE", "INCREMENT"))
    parser.add_argument("--motion", choices=list(motions.KINDS))
    parser.add_argument("--fault", choices=faults.FAULTS, default="none")
    options = parser.parse_args()
    cells = [(options.cell[0], int(options.cell[1]), float(options.cell[2]))] if options.cell else None
    options.out.mkdir(parents=True, exist_ok=True)
    records = draw_records(options.seed, options.count, cells, kind=options.motion, fault=options.fault)
    for record in run(records):
        told = write(record, options.out)
        share = {key: f"{p['bound'] / abs(p['true']) * 100:.2g} %" for key, p in told["parameters"].items()}
        print(f"{told['name']}: {record.rows.sum()} samples; bounds {share}", flush=True)


if __name__ == "__main__":
    main()
