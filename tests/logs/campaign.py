#!/usr/bin/env python3
"""The campaign on logs: draws records with a known truth, has them identified and inspected, prints the table.

usage: campaign.py [N] [SEED] [--program PROGRAM] [--out FOLDER] [--parts PARTS] [--only TEXT] [--large] [--keep]
  N         sound records of each of the 120 cells of machine, rate and encoder (1)
  SEED      of all draws (1)
  --parts   of sound,questions,one_direction,saturated,gap,inject (all)
  --only    cells whose text MACHINE/RATE/INCREMENT has this, as mcfv5050ln.X/1000/
  --large   also 200 MB of CSV through `inspect`: memory and time
  --keep    leaves the records in FOLDER
FOLDER (build/logs) gets results.json: commit, seed, N, programme, every record's truth and answer.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

import faults
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
        return [cell for cell in cells if self.options.only in "{}/{}/{:g}".format(*cell)]

    def files(self, records, what):
        """Yields (record, facts) of each record with its files written, and removes them afterwards."""
        done = 0
        for record in truth.run(records):
            facts = truth.write(record, self.folder)
            yield record, facts
            done += 1
            self.progress(f"{what}: {done} of {len(records)}")
            if not self.options.keep and record.fault not in ("forward", "backward"):
                self.remove(facts)

    def remove(self, facts):
        for path in (facts["log"], facts["machine"], facts["machine"].replace(".toml", ".json")):
            pathlib.Path(path).unlink(missing_ok=True)

    def sound(self):
        records = truth.draw_records(self.options.seed, self.options.count, self.cells)
        # Spread over the cells, whatever N is.
        order = sorted(range(len(records)), key=lambda k: (k * 7919) % 10007)
        inspected = {records[k].name for k in order[:table.FIRST_SOUND]}
        rows = []
        for record, facts in self.files(records, "sound records"):
            row = judge.identify(self.options.program, facts)
            if record.name in inspected:
                row["inspect"] = judge.inspect(self.options.program, facts)
            rows.append(row)
        return {"sound": rows}

    def of_fault(self, fault, with_inspect=False, **options):
        records = truth.draw_records(self.options.seed, self.options.count, self.chosen(FAULTY_CELLS), fault=fault, **options)
        rows = []
        for _, facts in self.files(records, fault):
            row = judge.identify(self.options.program, facts)
            if with_inspect:
                row["inspect"] = judge.inspect(self.options.program, facts)
            rows.append(row)
        return rows

    def questions(self):
        return {"faulty": [row for fault in faults.QUESTIONS for row in self.of_fault(fault, True)]}

    def saturated(self):
        return {"saturated": self.of_fault("saturated", kind="trapezoids")}

    def gap(self):
        return {"gap": self.of_fault("gap")}

    def one_direction(self):
        """Pairs: the information of both logs together, the files of both in one call."""
        firsts = truth.draw_records(self.options.seed, self.options.count, self.chosen(FAULTY_CELLS), fault="forward")
        made = {}
        for record, facts in self.files(firsts + [truth.partner(r) for r in firsts], "one direction each"):
            made[record.name] = (truth.information_of(record), facts)
        rows = []
        for record in firsts:
            one, two = made[record.name], made[f"{record.name}-and-backward"]
            facts = one[1] | {"parameters": truth.fisher.told(one[0] + two[0], record.axis)}
            rows.append(judge.identify(self.options.program, facts, [one[1]["log"], two[1]["log"]]))
            if not self.options.keep:
                self.remove(one[1])
                self.remove(two[1])
        return {"one_direction": rows}

    def inject(self):
        """Test signals: what is identified from them, and the closed loop with and without them."""
        firsts = truth.draw_records(self.options.seed, self.options.count, self.chosen(FAULTY_CELLS), fault="inject", exact=True)
        rows, errors = [], {}
        for record, facts in self.files(firsts + [truth.partner(r) for r in firsts], "test signals"):
            errors[record.name] = judge.closed_loop_error(self.options.program, facts)
            if record.fault == "inject":
                rows.append(judge.identify(self.options.program, facts))
        pairs = [{"name": r.name, "with": errors[r.name][0], "without": errors[f"{r.name}-and-none"][0],
                  "message": errors[r.name][1]} for r in firsts]
        return {"inject": rows, "loops": pairs}


def git(*arguments):
    return subprocess.run(["git", "-C", machines.ROOT, *arguments], capture_output=True, text=True).stdout.strip()


def head(options):
    """What the results are of."""
    version = subprocess.run([options.program, "--version"], capture_output=True, text=True)
    return {"schema": "stiction.logs-campaign/1", "commit": git("rev-parse", "--short", "HEAD"),
            "changes_without_commit": bool(git("status", "--porcelain")), "seed": options.seed, "n": options.count,
            "program": options.program, "version": version.stdout.strip(), "date": time.strftime("%Y-%m-%d"),
            "parts": options.parts, "only": options.only}


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("count", nargs="?", type=int, default=1)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("--program", default=str(machines.ROOT / "build/release/bin/stiction"))
    parser.add_argument("--out", type=pathlib.Path, default=machines.ROOT / "build/logs")
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--only", default="")
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--keep", action="store_true")
    options = parser.parse_args()
    options.parts = options.parts.split(",")
    unknown = set(options.parts) - set(PARTS)
    if unknown or options.count < 1:
        parser.error(f"found part '{unknown.pop()}'" if unknown else f"found N {options.count}; expected at least 1")
    if not pathlib.Path(options.program).is_file():
        parser.error(f"found no programme {options.program}; build the target stiction, or use --program")
    return options


def main():
    options = arguments()
    campaign = Campaign(options)
    results = head(options) | {"sound": []}
    for part in PARTS:
        if part in options.parts:
            results |= getattr(campaign, part)()
    if options.large:
        results["large"] = large_csv.measure(options.program, options.out)
    sys.stderr.write("\n" if sys.stderr.isatty() else "")
    (options.out / "results.json").write_text(json.dumps(results) + "\n", encoding="utf-8")
    print("\n".join(table.by_cell(results["sound"])) if results["sound"] else "")
    for title, text in table.whole(results) + large_csv.lines(results.get("large")):
        print(f"{title:80} {text}")
    print(f"results: {options.out / 'results.json'} (commit {results['commit']}, seed {options.seed}, n {options.count})")


if __name__ == "__main__":
    main()
