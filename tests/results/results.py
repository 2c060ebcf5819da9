#!/usr/bin/env python3
"""Keeps and compares the figures of docs/results.md.

usage: results.py collect SOURCE...      takes what these have printed into kept.toml and writes docs/results.md
       results.py compare SOURCE [--part]  status 1 when a figure has no row or differs from docs/results.md;
                                         --part: rows of which nothing was printed are left out
       results.py render                 writes docs/results.md from what is kept
       results.py check [BUILD]          what a row lacks, commands that do not exist (BUILD: build/release), and whether
                                         docs/results.md is what the kept data make
       results.py blind SEED LOG         keeps a blind campaign's counts and writes docs/results.md
       results.py second-truth LINES     the same of the second truth's lines of results
"""

import datetime
import pathlib
import subprocess
import sys

import campaigns
import commands
import kept as store
import page
from claims import ClaimError, read_claims, read_sources

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/results.md"
AGAIN = "docs/results.md is then not true; `toolchain/test --results {0}` writes it again"


def outputs(source, table):
    files = [f for pattern in table.get("output", [f"build/results/{source}.txt"]) for f in sorted(ROOT.glob(pattern))]
    left_out = {f for pattern in table.get("not", []) for f in ROOT.glob(pattern)}
    return [f for f in files if f not in left_out]


def lines_of(source, table):
    """The lines that a source printed, the last of those that are printed twice."""
    files = outputs(source, table)
    return [line.rstrip() for f in files for line in f.read_text(encoding="utf-8").splitlines() if line.strip()]


def assign(rows, lines):
    """{key: {name: (figure, text)}} and the lines that no row takes. A line that several rows take is of all of them."""
    found = {row.key: {} for row in rows}
    strange = []
    for line in lines:
        taken = [(row, row.matches(line)) for row in rows]
        taken = [(row, match) for row, match in taken if match]
        longest = max((len(match[0]) for _, match in taken if "*" not in match[0]), default=0)
        for row, match in taken:
            if "*" in match[0] or len(match[0]) == longest:
                found[row.key][line if "*" in match[0] else match[0]] = match
        if not taken:
            strange.append(line)
    return found, strange


def measure(rows, lines, part=False):
    """{key: numbers}, the lines of no row, and the sentences on rows without a value."""
    found, strange = assign(rows, lines)
    values, without = {}, []
    for row in rows:
        if part and (any("*" in f for f in row.figures) or len(found[row.key]) < len(row.figures)):
            continue  # of a part of the tests: a largest value or a count would be that of the part
        if not found[row.key]:
            without.append(f"row '{row.key}': nothing printed '{row.figures[0]}'")
            continue
        try:
            values[row.key] = row.numbers(list(found[row.key].values()))
        except ClaimError as error:
            without.append(str(error))
    return values, strange, without


def rows_of(source):
    return [row for section in read_claims() for row in section.rows if row.source == source]


def compare(source, part):
    table = read_sources()[source]
    lines = lines_of(source, table)
    rows = rows_of(source)
    values, strange, findings = measure(rows, lines, part)
    old = store.read("kept.toml").get(source, {"rows": {}})["rows"]
    for row in rows:
        if row.key not in values:
            continue
        if row.key not in old:
            findings.append(f"{row.what}: {row.text(values[row.key])}, but docs/results.md has no value")
        elif len(old[row.key]) != len(values[row.key]) or any(
                row.differs(a, b) for a, b in zip(old[row.key], values[row.key])):
            findings.append(f"{row.what}: {row.text(values[row.key])}, in docs/results.md {row.text(old[row.key])}")
    if table.get("all"):
        findings += [f"no row of tests/results/claims/ takes the figure: {line}" for line in strange]
    for finding in findings:
        print(f"results: {finding}")
    if findings:
        print(f"results: {AGAIN.format(source)}")
    print(f"results: {len(values)} rows of docs/results.md compared with what {source} printed, "
          f"{len(findings) or 'no'} finding{'s' if len(findings) != 1 else ''}")
    return 1 if findings else 0


def git(*words):
    return subprocess.run(["git", "-C", str(ROOT), *words], check=True, capture_output=True, text=True).stdout.strip()


def collect(names):
    all_kept = store.read("kept.toml")
    status = 0
    for source in names:
        values, strange, without = measure(rows_of(source), lines_of(source, read_sources()[source]))
        if not values:
            print(f"results: {source} has printed nothing; its values are kept")
            status = 1
            continue
        # A row that nothing printed has no value any more: it would have the commit of a run that did not show it.
        all_kept[source] = {"commit": git("rev-parse", "--short=7", "HEAD"), "date": str(datetime.date.today()),
                            "rows": values}
        for sentence in without + ([f"no row takes: {s}" for s in strange] if read_sources()[source].get("all") else []):
            print(f"results: {source}: {sentence}")
            status = 1
        print(f"results: {source}: {len(values)} rows have a new value")
    store.write_kept(all_kept)
    return render() or status


def render():
    try:
        PAGE.write_text(page.render(), encoding="utf-8")
    except ValueError as error:
        print(f"results: docs/results.md is not written: {error}")
        return 1
    print("results: docs/results.md is written")
    return 0


def check(build):
    findings = []
    try:
        sections = read_claims()
    except ClaimError as error:
        print(f"results: {error}")
        return 1
    there = commands.Commands(ROOT, pathlib.Path(build))
    for section in sections:
        for row in section.rows:
            findings += [f"row '{row.key}': {what}" for what in there.missing(row.command)]
    try:
        if page.render() != PAGE.read_text(encoding="utf-8"):
            findings.append("docs/results.md is not what the kept data make; `toolchain/test --results kept` writes it")
    except (ValueError, OSError) as error:
        findings.append(str(error))
    print("\n".join(f"results: {finding}" for finding in findings) or
          f"results: {sum(len(s.rows) for s in sections)} rows, each with a bound, a unit and a command that exists")
    return 1 if findings else 0


def keep_runs(runs):
    of = store.read("campaigns.toml").get("run", [])
    for run in runs:
        of, said = store.add_run(of, run)
        print(f"results: {said}")
    store.write_campaigns(of)
    return render()


def main(words):
    try:
        match words:
            case ["collect", *names] if names and set(names) <= set(read_sources()):
                return collect(names)
            case ["compare", source, *rest] if source in read_sources() and rest in ([], ["--part"]):
                return compare(source, bool(rest))
            case ["render"]:
                return render()
            case ["check", *build] if len(build) < 2:
                return check(build[0] if build else ROOT / "build/release")
            case ["blind", seed, log]:
                return keep_runs(campaigns.read_log(seed, pathlib.Path(log).read_text(encoding="utf-8"), git))
            case ["second-truth", lines]:
                text = pathlib.Path(lines).read_text(encoding="utf-8")
                return keep_runs(campaigns.read_lines(campaigns.engine_commit(git), str(datetime.date.today()), text))
    except (ClaimError, campaigns.NotKept) as error:
        print(f"results: {error}")
        return 1
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
