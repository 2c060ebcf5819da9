#!/usr/bin/env python3
"""Diagnoses records of machines that are exactly as their file says, and counts how often a cause is named.

Every shipped machine, axis and friction model has its turn; motions, speeds, logging period, set-points in the log or
not, and the size of the noise of guide and current sensor (0.3 to 10 % of Coulomb friction) are drawn. Each case that --results has already is not run
again. Prints the rate with its interval over all cases, then by what was drawn, and each name that was given. Exit 0,
whatever is named; 1: a case could not be judged. With --sample the cells are drawn as well, and more names than an
engine with the wanted rate gives once in a thousand samples are exit 1 too."""

import argparse
import concurrent.futures
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "matrix"))

import machines  # noqa: E402
import program  # noqa: E402
import records  # noqa: E402
import tally  # noqa: E402
import walk  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", required=True, help="stiction; its machines lie in ../share")
    parser.add_argument("--cases", type=int, default=60, help="number of cases [60]")
    parser.add_argument("--seed", type=int, default=1, help="what is drawn [1]")
    parser.add_argument("--sample", action="store_true", help="draw the cells, and judge the number of names")
    parser.add_argument("--jobs", type=int, default=2, help="cases at a time [2]")
    parser.add_argument("--results", type=pathlib.Path, help="keep a line of JSON for each case in this file")
    return parser.parse_args()


def motions(draw, limits):
    """One to three records to learn from and one to judge on: name, held out, points."""
    def speeds():
        shares = sorted(10.0**draw.uniform(-2.3, 0.0) for _ in range(draw.randint(3, 7)))
        return records.constant_speeds(limits, [limits.speed * share for share in shares],
                                       limits.amplitude * draw.uniform(0.7, 1.3))

    def sine():
        return records.sine(limits, share=draw.uniform(0.3, 1.0))

    def reversals():
        return records.small_reversals(sorted(1e-6 * 10.0**draw.uniform(0.7, 2.5) for _ in range(draw.randint(3, 6))),
                                       draw.choice((1.5, 2.0, 3.0)))
    kinds = {"speeds": speeds, "sine": sine, "reversals": reversals}
    learn = draw.sample(sorted(kinds), draw.randint(1, 3))
    if learn == ["reversals"]:
        learn = ["reversals", "sine"]
    judge = draw.choice([name for name in learn if name != "reversals"])
    return [(name, False, kinds[name]()) for name in learn] + [(f"other-{judge}", True, kinds[judge]())]


USUAL = 0.03  # rms of each noise, of the Coulomb friction: 2.5 N of the cross table's 80 N


def friction_level(machine, axis, model):
    """Coulomb friction of the model (N, N m); of a law that has none the largest of the axis' other models."""
    return machine.coulomb(axis, model) or max(machine.coulomb(axis, other) or 0.0 for other in machine.models(axis))


class Campaign:
    def __init__(self, options):
        self.options = options
        self.program = program.Program(options.program)
        self.machines = {machine.name: machine for machine in machines.shipped(self.program)}
        self.cells = [cell for cell in machines.table_of_cells(self.machines.values(), [options.seed])
                      if cell.axis != machines.WHOLE]
        if options.sample:
            records.drawing(options.seed, "sample").shuffle(self.cells)

    def key(self, number):
        return f"{self.options.seed}/{'sample/' if self.options.sample else ''}{number}"

    def run_case(self, number):
        cell = self.cells[number % len(self.cells)]
        draw = records.drawing(self.options.seed, "null", number)
        case = {"key": self.key(number), "machine": cell.machine, "axis": cell.axis, "model": cell.model,
                "period_ms": draw.choice((1, 1, 2, 4)), "set_points": draw.random() < 0.7,
                "guide": round(10.0**draw.uniform(-1.0, 0.5), 3), "sensor": round(10.0**draw.uniform(-1.0, 0.5), 3)}
        with tempfile.TemporaryDirectory(prefix="stiction-null-") as folder:
            try:
                return {**case, **self.judge(case, draw, pathlib.Path(folder))}
            except (RuntimeError, KeyError, ValueError) as error:
                return {**case, "error": str(error)[-800:]}

    def judge(self, case, draw, folder):
        machine, axis = self.machines[case["machine"]], case["axis"]
        rotary = machine.rotary(axis)
        limits = records.Limits(*machine.limits(axis), rotary)
        using = machine.using(axis, case["model"])
        usual = USUAL * friction_level(machine, axis, case["model"])
        noise = case["sensor"] * usual / machine.force_constant(axis)
        logs = []
        for name, held_out, points in motions(draw, limits):
            records.write_set_points(folder / "set-points.csv", axis, points, rotary, draw,
                                     case["guide"] * usual / records.SLOW)
            self.run(folder, "simulate", "replay", "--from", "set-points.csv", "--machine", machine.name, *using,
                     "--log", "simulated.csv")
            records.strip(folder / "simulated.csv", folder / f"{name}.csv", axis, noise, draw, case["period_ms"],
                          case["set_points"])
            logs += ["--holdout", f"{name}.csv"] if held_out else [f"{name}.csv"]
        out = self.run(folder, "diagnose", *logs, "--machine", machine.name, *using, "--axis", axis, "--json")
        verdict = json.loads(out)
        return {"records": [log for log in logs if log != "--holdout"], "names": walk.names_in(verdict),
                "status": verdict.get("status"), "said": walk.said_of(verdict),
                "changed": [each["parameter"] for each in verdict.get("changed", [])]}

    def run(self, folder, *command):
        outcome = self.program.run(*command, folder=folder)
        if outcome.code != 0:
            raise RuntimeError(f"{outcome.typed()}: exit {outcome.code}: {outcome.error.strip()}")
        return outcome.out


def kept(place):
    if not place or not place.exists():
        return {}
    return {line["key"]: line for line in map(json.loads, place.read_text(encoding="utf-8").splitlines())}


WANTED = 0.015  # of records
CHANCE = 0.001  # that a sample of an engine with this rate is called bad


def rate_of(name, cases, what="names"):
    rate = tally.Rate(name)
    for case in cases:
        rate.add(case[what])
    return rate.text()


def report(cases):
    judged = [case for case in cases if "error" not in case]
    lines = [rate_of(f"exact file: a cause is named (wanted at most {100.0 * WANTED:g} %)", judged),
             # Cases of an engine that did not say it have none.
             rate_of("exact file: held-out records are called those of another state",
                     [case for case in judged if "changed" in case], "changed"), ""]
    for what in ("machine", "model", "period_ms", "set_points", "status"):
        for value in sorted({str(case[what]) for case in judged}):
            lines.append("  " + rate_of(f"{what} {value}", [case for case in judged if str(case[what]) == value]))
    lines.append("")
    for case in judged:
        if case["names"]:
            lines.append(f"named: {case['key']} {case['machine']}/{case['axis']}/{case['model']}, {case['period_ms']} ms, "
                         f"{' '.join(case['records'])}: {case['said']}")
    for case in cases:
        if "error" in case:
            lines.append(f"NOT JUDGED: {case['key']} {case['machine']}/{case['axis']}/{case['model']}: {case['error']}")
    return "\n".join(lines)


def main():
    options = arguments()
    if min(options.cases, options.jobs) < 1:
        print("nulls: --cases and --jobs are whole numbers from 1 on", file=sys.stderr)
        return 2
    campaign = Campaign(options)
    known = kept(options.results)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = [pool.submit(campaign.run_case, number) for number in range(options.cases)
                if campaign.key(number) not in known]
        # As they come: a long case must not keep those behind it from the file.
        for done, run in enumerate(concurrent.futures.as_completed(runs), len(known) + 1):
            case = run.result()
            known[case["key"]] = case
            print(f"{done:>4} of {options.cases}  {case['machine']}/{case['axis']}/{case['model']}: "
                  + (case.get("error") or ", ".join(case["names"]) or "no name"), flush=True)
            if options.results and "error" not in case:
                with open(options.results, "a", encoding="utf-8") as file:
                    file.write(json.dumps(case) + "\n")
    cases = [known[campaign.key(number)] for number in range(options.cases)]
    print(report(cases))
    bad = any("error" in case for case in cases)
    if options.sample:
        named, most = sum(bool(case.get("names")) for case in cases), tally.most_by_chance(WANTED, len(cases), CHANCE)
        print(f"sample: {named} of {len(cases)} named, at most {most} may be")
        bad = bad or named > most
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
