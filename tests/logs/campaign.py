#!/usr/bin/env python3
"""The campaign on logs: draws records with a known truth, has them identified and inspected, prints the table.

usage: campaign.py [N] [SEED] [--program PROGRAM] [--out FOLDER] [--parts PARTS] [--only REGEX] [--large]
                   [--keep] [--again] [--show FILE]
  N         sound records of each of the 120 cells of machine, rate and encoder (1)
  SEED      of all draws (1)
  --parts   of sound,questions,one_direction,saturated,gap,inject (all)
  --only    cells whose text MACHINE/RATE/INCREMENT this regular expression finds, as /(50|100)/
  --large   also 200 MB of CSV through `inspect`: memory and time
  --keep    leaves the records in FOLDER; --again asks about them without drawing any
  --program may be repeated: each is asked about the same records
  --show    prints the table of a results.json again
FOLDER (build/logs) gets results.json: commit, seed, N, programme, every record's truth and answer.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import time

import numpy as np

import faults
import fisher
import judge
import large_csv
import machines
import table
import truth

PARTS = ("sound", "questions", "one_direction", "saturated", "gap", "inject")
# Where faults are put: rates and encoders that real logs have, so that nothing but the fault is special.
FAULTY_CELLS = tuple((machine, rate, increment) for machine in machines.AXES
                     for rate, increment in ((50, 1e-6), (100, 1e-7), (190, 1e-6), (500, 1e-5), (1000, 1e-7), (4000, 1e-6)))


class Progress:
    """A line on standard error: rewritten on a terminal, every 15 s elsewhere."""

    def __init__(self):
        self.shown = self.begin = time.monotonic()

    def __call__(self, text):
        now, terminal = time.monotonic(), sys.stderr.isatty()
        if terminal or now - self.shown > 15:
            self.shown = now
            print(f"\r{text}\033[K" if terminal else f"logs: {text}, {now - self.begin:.0f} s", file=sys.stderr,
                  end="" if terminal else "\n", flush=True)


class Campaign:
    def __init__(self, options):
        self.options, self.progress = options, Progress()
        self.folder = options.out / "records"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.cells = self.chosen([(m, r, q) for m in machines.AXES for r in truth.RATES for q in truth.INCREMENTS])

    def chosen(self, cells):
        return [cell for cell in cells if re.search(self.options.only, "{}/{}/{:g}".format(*cell))]

    def drawn(self, part):
        """The records of a part, as (part, record)."""
        seed, count, cells = self.options.seed, self.options.count, self.chosen(FAULTY_CELLS)
        draw = lambda fault, **options: truth.draw_records(seed, count, cells, fault=fault, **options)
        with_partners = lambda records: records + [truth.partner(r) for r in records]
        records = {"sound": lambda: truth.draw_records(seed, count, self.cells),
                   "questions": lambda: [r for fault in faults.QUESTIONS for r in draw(fault) if faults.arises(r)],
                   "one_direction": lambda: with_partners(draw("forward")),
                   "saturated": lambda: draw("saturated", kind="trapezoids"),
                   "gap": lambda: draw("gap"),
                   "inject": lambda: with_partners(draw("inject", exact=True))}[part]()
        return [(part, record) for record in records]

    def made(self):
        """Facts of all records, simulated together: a tick costs nearly the same for one axis as for hundreds."""
        drawn = [pair for part in PARTS if part in self.options.parts for pair in self.drawn(part)]
        for done, record in enumerate(truth.run([record for _, record in drawn], self.progress)):
            yield truth.write(record, self.folder)
            self.progress(f"{done + 1} of {len(drawn)} records")

    def found(self):
        """Facts of the records that --keep left in the folder."""
        paths = [path for path in sorted(self.folder.glob("*.json")) if path.with_suffix(".csv").is_file()]
        for done, path in enumerate(paths):
            facts = json.loads(path.read_text(encoding="utf-8"))
            if part_of(facts) in self.options.parts and self.chosen([facts["cell"]]):
                yield facts | {"log": str(path.with_suffix(".csv")), "machine": str(path.with_suffix(".toml"))}
            self.progress(f"{done + 1} of {len(paths)} records")

    def run(self):
        answers, later = [Answers(program) for program in self.options.program], []
        for facts in self.found() if self.options.again else self.made():
            for answer in answers:
                answer.take(part_of(facts), facts)
            later.append(facts)
            if part_of(facts) != "one_direction":  # of these the files of both are needed
                self.remove(later.pop())
        for answer in answers:
            answer.join_pairs()
        for facts in later:
            self.remove(facts)
        return [answer.results for answer in answers]

    def remove(self, facts):
        if not self.options.keep and not self.options.again:
            for path in (facts["log"], facts["machine"], facts["machine"].replace(".toml", ".json")):
                pathlib.Path(path).unlink(missing_ok=True)


def part_of(facts):
    fault = facts["fault"]
    if fault in ("forward", "backward"):
        return "one_direction"
    if fault in faults.QUESTIONS:
        return "questions"
    return "inject" if facts["name"].endswith("-and-none") else "sound" if fault == "none" else fault


def also_inspected(facts):
    """Faulty records, and of the sound ones so many of each cell that about 200 are reached."""
    index = facts["seed"][4]
    return part_of(facts) == "questions" or part_of(facts) == "sound" and index < 2


class Answers:
    """What one programme says of the records."""

    def __init__(self, program):
        self.program, self.results, self.pairs, self.loops = program, {"sound": []}, {}, {}

    def take(self, part, facts):
        rows = self.results.setdefault("faulty" if part == "questions" else part, [])
        if part == "one_direction":
            self.pairs.setdefault(facts["name"].removesuffix("-and-backward"), {})[facts["fault"]] = facts
            return
        if part == "inject":
            errors = self.loops.setdefault(facts["name"].removesuffix("-and-none"), {})
            errors[facts["fault"]] = judge.closed_loop_error(self.program, facts)
        if part != "inject" or facts["fault"] == "inject":
            rows.append(judge.identify(self.program, facts))
            if also_inspected(facts):
                rows[-1]["inspect"] = judge.inspect(self.program, facts)

    def join_pairs(self):
        """Logs of one direction each: the information of both together, the files of both in one call."""
        for pair in self.pairs.values():
            one, two = pair["forward"], pair["backward"]
            both = np.array(one["information"]) + np.array(two["information"])
            facts = one | {"parameters": fisher.told(both, [p["true"] for p in one["parameters"].values()])}
            self.results["one_direction"].append(judge.identify(self.program, facts, [one["log"], two["log"]]))
        if self.loops:
            self.results["loops"] = [{"name": name, "with": e["inject"][0], "without": e["none"][0],
                                      "message": e["inject"][1]} for name, e in self.loops.items()]


def git(*arguments):
    return subprocess.run(["git", "-C", machines.ROOT, *arguments], capture_output=True, text=True).stdout.strip()


def head(options, program):
    """What the results are of."""
    version = subprocess.run([program, "--version"], capture_output=True, text=True)
    return {"schema": "stiction.logs-campaign/1", "commit": git("rev-parse", "--short", "HEAD"),
            "changes_without_commit": bool(git("status", "--porcelain")), "seed": options.seed, "n": options.count,
            "program": program, "version": version.stdout.strip(), "date": time.strftime("%Y-%m-%d"),
            "parts": options.parts, "only": options.only}


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("count", nargs="?", type=int, default=1)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("--program", action="append")
    parser.add_argument("--out", type=pathlib.Path, default=machines.ROOT / "build/logs")
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--only", default="")
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--show", type=pathlib.Path)
    options = parser.parse_args()
    options.parts = options.parts.split(",")
    unknown = set(options.parts) - set(PARTS)
    if unknown or options.count < 1:
        parser.error(f"found part '{unknown.pop()}'" if unknown else f"found N {options.count}; expected at least 1")
    options.program = options.program or [str(machines.ROOT / "build/release/bin/stiction")]
    for program in () if options.show else options.program:
        if not pathlib.Path(program).is_file():
            parser.error(f"found no programme {program}; build the target stiction, or use --program")
    return options


def show(results):
    print(f"programme: {results['program']}")
    if results["sound"]:
        print("\n".join(table.by_cell(results["sound"])))
    for title, text in table.whole(results) + large_csv.lines(results.get("large")):
        print(f"{title:80} {text}")


def main():
    options = arguments()
    if options.show:
        show(json.loads(options.show.read_text(encoding="utf-8")))
        return
    for k, answers in enumerate(Campaign(options).run()):
        results = head(options, options.program[k]) | answers
        if options.large:
            results["large"] = large_csv.measure(options.program[k], options.out)
        sys.stderr.write("\n" if sys.stderr.isatty() else "")
        path = options.out / (f"results-{k + 1}.json" if k else "results.json")
        path.write_text(json.dumps(results) + "\n", encoding="utf-8")
        show(results)
        print(f"results: {path} (commit {results['commit']}, seed {options.seed}, n {options.count})")


if __name__ == "__main__":
    main()
