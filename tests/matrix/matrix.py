#!/usr/bin/env python3
"""Runs every command on every axis of every shipped machine with every friction model that its file has, in README's
order, and prints what failed, cell by cell, and the rates over all cells.

Machines, axes and models are found in the machine files, experiments in the programme's help: a new one takes part by
itself. known.toml lists the failures that are known, each with its cell, seed and reason; any other fails, and so does
one of the list that passes. Exit 0: as listed; 1: not; 2: bad usage."""

import argparse
import concurrent.futures
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import traceback

import machines
import program
import tally
import walk

HERE = pathlib.Path(__file__).parent
MOST_FALSE = 3  # cells with a false name on an exact file


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", required=True, help="stiction; its machines lie in ../share")
    parser.add_argument("--aliases", required=True, help="programme that prints an effect's aliases, one a line")
    parser.add_argument("--seeds", type=int, default=1, help="seeds of each cell [1]")
    parser.add_argument("--jobs", type=int, default=2, help="cells at a time [2]")
    parser.add_argument("--only", default="", help="cells whose name MACHINE/AXIS/MODEL/SEED has this part")
    parser.add_argument("--sample", type=int, default=1, help="one of so many cells [1]; the commit draws which")
    parser.add_argument("--known", type=pathlib.Path, default=HERE / "known.toml", help="list of known failures")
    parser.add_argument("--node", help="opens a page of each kind and machine; left out: none")
    parser.add_argument("--keep", type=pathlib.Path, help="keep what the commands write in this folder")
    parser.add_argument("--figures", type=pathlib.Path, help="write the rates into this file")
    return parser.parse_args()


def drawn(sample):
    """A number below `sample` that the commit draws, so that each cell has its turn and a failure can be repeated."""
    head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=HERE, capture_output=True, text=True, check=False)
    return int(head.stdout.strip() or "0", 16) % sample


class Matrix:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.program = program.Program(options.program)
        self.machines = {machine.name: machine for machine in machines.shipped(self.program)}
        seeds = list(range(1, options.seeds + 1))
        self.cells = [cell for cell in machines.table_of_cells(self.machines.values(), seeds)
                      if options.only in str(cell)][drawn(options.sample)::options.sample]
        self.aliases = set(subprocess.run([options.aliases, "coulomb_mismatch"], check=True, capture_output=True,
                                          text=True).stdout.split())
        self.rates = {rate.name: rate for rate in (
            tally.Rate(walk.NAMED, least=0.9), tally.Rate(walk.TRUTHS, least=0.9, most=0.98), tally.Rate(walk.EXACT),
            tally.Rate(walk.ALONE), tally.Rate(walk.FOUND))}

    def run_cell(self, cell):
        folder = self.folder / cell.file_name()
        folder.mkdir(parents=True)
        walked = walk.Walk(self.program, self.machines[cell.machine], cell, folder, self.aliases,
                           quick=self.options.seeds == 1)
        try:
            if cell.axis == machines.WHOLE:
                walked.whole()
            else:
                walked.axis(first_seed=cell.seed == 1)
        except Exception:  # a defect of the matrix, or an output that it cannot read: shown with its cell
            walked.fail("the matrix itself", "exception", traceback.format_exc())
        if not self.options.keep:
            for log in folder.rglob("*.csv"):
                log.unlink()
        return walked.report

    def run(self):
        reports = []
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            for report in pool.map(self.run_cell, self.cells):
                reports.append(report)
                print_report(report)
        return reports

    # One page of each kind a machine; of those that one command writes for several kinds of experiments, the first. As
    # many at a time as cells: they take as long as the commands.
    def open_pages(self, reports):
        chosen = {}
        for report in reports:
            for script, page in report.pages:
                chosen.setdefault((report.cell.machine, script), (report.cell, page))
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            pages = [(script, cell, page) for (_, script), (cell, page) in chosen.items()]
            verdicts = pool.map(lambda page: self.open_page(*page), pages)
            return [failure for failure in verdicts if failure]

    def open_page(self, script, cell, page):
        if script is None:
            return tally.Failure(str(cell), "page", "a page of no known kind", str(page))
        opened = subprocess.run([self.options.node, HERE.parent / "host/report" / script, page], text=True,
                                capture_output=True, check=False)
        if opened.returncode != 0:
            return tally.Failure(str(cell), f"page {page.parent.name}", "does not open", opened.stderr.strip())
        return None


def print_report(report):
    total = sum(report.seconds.values())
    print(f"{str(report.cell):<44} {report.commands:>3} commands {total:6.1f} s  "
          + ("; ".join(f"{failure.step}: {failure.what}" for failure in report.failures) or "all holds"), flush=True)


def print_failures(title, failures):
    if failures:
        print(f"\n{title}")
    for failure in failures:
        print(f"  {failure.cell}, {failure.step}: {failure.what}")
        for line in failure.detail.splitlines():
            print(f"      {line}")


def unserved(matrix, reports):
    """Experiments that no machine ran: then nobody knows whether they work."""
    served = set().union(*(report.served for report in reports))
    for experiment in matrix.program.experiments:
        if experiment not in served and experiment not in ("replay", "commissioning"):
            yield tally.Failure("every machine", f"simulate {experiment}", "refused everywhere")


def main():
    options = arguments()
    if min(options.seeds, options.jobs, options.sample) < 1:
        print("matrix: --seeds, --jobs and --sample are whole numbers from 1 on", file=sys.stderr)
        return 2
    try:
        known = tally.read_known(options.known)
    except (OSError, ValueError, tally.BadList) as error:
        print(f"matrix: {error}", file=sys.stderr)
        return 2
    folder = options.keep or pathlib.Path(tempfile.mkdtemp(prefix="stiction-matrix-"))
    folder = folder.resolve()
    if options.keep:
        shutil.rmtree(folder, ignore_errors=True)
    begin = time.monotonic()
    try:
        return run(options, folder, known, begin)
    finally:
        if not options.keep:
            shutil.rmtree(folder, ignore_errors=True)


def run(options, folder, known, begin):
    matrix = Matrix(options, folder)
    if not matrix.cells:
        print(f"matrix: --only, --sample: found no cell with '{options.only}'", file=sys.stderr)
        return 2
    reports = matrix.run()
    failures = [failure for report in reports for failure in report.failures]
    whole = not options.only and options.sample == 1
    if whole:
        failures += unserved(matrix, reports)
    if options.node:
        failures += matrix.open_pages(reports)
    ran = {str(report.cell) for report in reports} | ({"every machine"} if whole else set())
    unknown, expected, healed = tally.sort_out(failures, known, ran)

    print_failures("Known failures", expected)
    print_failures("FAILED", unknown)
    for row in healed:
        print(f"\nFAILED: {row.cell}, {row.step}: '{row.what}' is listed as known and passed; take it off the list")
    print_refusals(reports)
    print_seconds(reports)
    lines, holds = rates(matrix, reports, failures)
    print("\nOver all cells")
    for line in lines:
        print(f"  {line}")
    if options.figures:
        options.figures.parent.mkdir(parents=True, exist_ok=True)
        options.figures.write_text("".join(f"matrix, {line}\n" for line in lines), encoding="utf-8")
    passed = not unknown and not healed and holds
    print(f"\nmatrix: {'passed' if passed else 'FAILED'}: {len(reports)} cells, "
          f"{sum(report.commands for report in reports)} commands, {len(unknown)} failures, {len(expected)} known, "
          f"{time.monotonic() - begin:.0f} s")
    return 0 if passed else 1


def print_refusals(reports):
    """What machines lack, each sentence once."""
    sentences = {}
    for report in reports:
        for step, sentence in report.refusals:
            sentences.setdefault((step, sentence), []).append(str(report.cell))
    if sentences:
        print("\nRefused, with what it needs")
    for (step, sentence), cells in sentences.items():
        print(f"  {cells[0]}{f' and {len(cells) - 1} more' if len(cells) > 1 else ''}, {step}: {sentence}")


def print_seconds(reports):
    steps = {}
    for report in reports:
        for step, seconds in report.seconds.items():
            steps.setdefault(step, []).append(seconds)
    print("\nTime by step, s: sum, longest")
    for step, seconds in sorted(steps.items(), key=lambda item: -sum(item[1])):
        print(f"  {step:<34} {sum(seconds):7.1f} {max(seconds):7.1f}")


def rates(matrix, reports, failures):
    """The rates in words, and whether those with a bound hold: with one seed the rate's interval has to meet the bound,
    with several its value."""
    crashes = tally.Rate("commands that died by a signal, an uncaught exception or without end")
    exits = tally.Rate("commands that ended in another way than they had to")
    for report in reports:
        broken = [f for f in report.failures if f.what.startswith("SIG") or f.what in ("no end", "uncaught exception")]
        wrong = [f for f in report.failures if f.what.startswith(("exit", "refused"))]
        crashes.hits += len(broken)
        exits.hits += len(wrong) + len(broken)
        crashes.cases = exits.cases = exits.cases + report.commands
    false_cells = {f.cell for f in failures if f.what.startswith("false name")}
    false = tally.Rate(f"cells with a false name on an exact file (at most {MOST_FALSE})", hits=len(false_cells),
                       cases=sum(report.cell.axis != machines.WHOLE for report in reports))
    missed = []
    for report in reports:
        for name, hit, detail in report.counts:
            matrix.rates[name].add(hit, str(report.cell))
            if not hit and name in (walk.TRUTHS, walk.FOUND):
                missed.append(f"  {report.cell}, {detail}")
    if missed:
        print("\nOutside of their intervals, or not determined")
        print("\n".join(missed))
    wanted = [matrix.rates[walk.NAMED], matrix.rates[walk.TRUTHS]]
    many = matrix.options.seeds > 1
    holds = all(rate.holds(exactly=many) for rate in wanted) and len(false_cells) <= MOST_FALSE
    lines = [exits.text(), crashes.text(), false.text()] + [rate.text() for rate in matrix.rates.values()]
    for rate in wanted:
        if not rate.holds(exactly=many):
            lines.append(f"NOT MET: {rate.name}: wanted {100.0 * rate.least:.0f} to {100.0 * rate.most:.0f} %")
    if len(false_cells) > MOST_FALSE:
        lines.append(f"NOT MET: {false.name}: {len(false_cells)}")
    return lines, holds


if __name__ == "__main__":
    sys.exit(main())
