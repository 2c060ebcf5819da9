#!/usr/bin/python3
"""Judges a programme by cases of the second truth and prints a table; resumable.

usage: campaign.py --stiction PATH --cases N --seed S [--kind K ...] [--share s] [--jobs J] [--results FILE]
                   [--keep DIR] [--no-setpoints] [--cam] [--each]
  Cases are numbered S, S+1, ...; their kinds come by turns (see MIX) unless --kind names some.
  --results: one line of JSON a case, added to as it goes; cases that stand there already are not run again
  --keep: folders of the cases stay there (else they are deleted); --table: only prints the table of --results;
  --fresh: begins a new file
  --cam: motions of slaves behind their masters; --each: single cases of each cause by turns
"""

import argparse
import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import paths  # noqa: F401

from scoring import judge
from table import table

# Twenty cases: half of them single.
MIX = ["single", "exact", "single", "pair", "single", "unknown", "single", "tolerance", "single", "pair",
       "single", "exact", "single", "unknown", "single", "triple", "single", "exact", "single", "tight_spot"]


def one(task):
    """Generates a case, runs the programme on it, returns its line of results."""
    import causes
    import generate
    options, kind, seed = task
    folder = pathlib.Path(options.keep or tempfile.mkdtemp(prefix="second-truth-"))
    folder = folder / f"{kind}-{seed}" if options.keep else folder
    try:
        name = None
        if options.each and kind == "single":
            names = [n for n in causes.CAUSES if options.cam or n != "master_delay"]
            name = names[seed % len(names)]
        truth = generate.generate(kind, seed, folder, options.share, name, not options.no_setpoints, options.cam)
        began = time.monotonic()
        command = [options.stiction, "diagnose", *map(str, sorted(folder.glob("train-*.csv"))), "--machine",
                   str(folder / "machine.toml"), "--holdout", *map(str, sorted(folder.glob("held-*.csv"))), "--out",
                   str(folder / "result")]
        ran = subprocess.run(command, capture_output=True, text=True, timeout=options.timeout)
        base = {"key": key_of(options, kind, seed), "generated_s": truth["seconds"],
                "diagnosed_s": round(time.monotonic() - began, 2)}
        verdict = folder / "result" / "verdict.json"
        if ran.returncode or not verdict.exists():
            return {**base, "kind": kind, "seed": seed, "hidden": truth["hidden"], "error": ran.stderr.strip()[-400:]}
        return {**base, **judge(truth, json.loads(verdict.read_text(encoding="utf-8")))}
    except subprocess.TimeoutExpired:
        return {"key": key_of(options, kind, seed), "kind": kind, "seed": seed, "error": "no verdict in time"}
    finally:
        if not options.keep:
            shutil.rmtree(folder, ignore_errors=True)


def key_of(options, kind, seed):
    """What makes a case the same one."""
    return f"{kind} {seed} {options.share} {'without' if options.no_setpoints else 'with'} set-points" + \
        (" of a cam" if options.cam else "")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("--stiction")
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", nargs="+")
    parser.add_argument("--share", type=float, default=0.1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("second-truth.jsonl"))
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--keep")
    parser.add_argument("--no-setpoints", action="store_true")
    parser.add_argument("--cam", action="store_true")
    parser.add_argument("--each", action="store_true")
    parser.add_argument("--timeout", type=float, default=600.0)
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    lines, status = [], 0
    if options.fresh:
        options.results.unlink(missing_ok=True)
    if options.results.exists():
        lines = [json.loads(text) for text in options.results.read_text(encoding="utf-8").splitlines() if text]
    if not options.table:
        if not options.stiction:
            parser.error("found no --stiction; expected the path of the programme")
        options.stiction = shutil.which(options.stiction) or str(pathlib.Path(options.stiction).resolve())
        kinds = options.kind or MIX
        tasks = [(options, kinds[k % len(kinds)], options.seed + k) for k in range(options.cases)]
        done = {line["key"] for line in lines}
        tasks = [task for task in tasks if key_of(*task) not in done]
        with open(options.results, "a", encoding="utf-8") as out:
            for line in answers(tasks, options.jobs):
                lines.append(line)
                out.write(json.dumps(line) + "\n")
                out.flush()
                said = line.get("error") or ", ".join(line["names"]) or "no name"
                print(f"{line['kind']} {line['seed']}: {line.get('hidden') or line.get('unknown') or '-'} -> {said}",
                      file=sys.stderr, flush=True)
    if any("error" in line for line in lines):
        print("found cases without a verdict (above); expected none", file=sys.stderr)
        status = 1
    if lines:
        seconds = sorted(line.get("generated_s", 0.0) for line in lines)
        print(table(lines))
        print(f"\ngenerated in {seconds[len(seconds) // 2]:.1f} s in the median, {seconds[-1]:.1f} s at most")
    return status


def answers(tasks, jobs):
    """Lines of results as they come; one process needs no pool."""
    if jobs <= 1:
        yield from map(one, tasks)
        return
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        for future in concurrent.futures.as_completed([pool.submit(one, task) for task in tasks]):
            yield future.result()


if __name__ == "__main__":
    sys.exit(main())
