#!/usr/bin/env python3
"""Runs the programme with command lines drawn from the grammar of its own help, on shipped, small and damaged files.

Whatever it is given, it ends with 0, 1 or 2, with a message on standard error where it fails, with what it found and what
it expected where it refuses, and without a folder then; the right spelling of an option with a slip is named, foreign
files in a folder of results stay, no temporary file is left, and there is JSON alone on standard output where JSON was
asked for. A run that takes too long is ended and told. It
follows from the seed and its number: --seed S --run N repeats it. Exit 0: nothing found; 1: findings; 2: bad usage."""

import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import command_files
import help_grammar

ROOT = pathlib.Path(__file__).parents[2]
UNITS = ["m/min", "mm/s", "m/s", "mm", "um", "m", "N", "kg", "s", "ms", "us", "Hz", "A", "V", "1/s", "N s/m", "deg",
         "rad/s", "furlong", "", "m/min/s", "°", "µm", "%"]
WORDS = ["", " ", "X", "Y", "Z", "*", "x", "all", "none", "circle", "lugre", "maxwell_slip", "coulomb_viscous",
         "parabolic", "classical", "linear_ramp", "lugre,classical", "lugre,,lugre", "cw", "both", "peak", "rms",
         "corrected", "printed", "corrected,corrected", "current", "position,velocity", "-", "--", "-1", "a" * 3000,
         "ü", "\n", "%s%n", "../..", "/"]
# Units of the quantities that an option takes, by what the help calls them.
QUANTITIES = {"SPEED": "rpm", "STROKE": "deg", "ANGLE": "deg", "OFFSET": "deg"}
MODELS = ["lugre", "maxwell_slip", "coulomb_viscous", "classical", "linear_ramp", "parabolic", "all", "lugre,classical"]
SENSIBLE = {"m/min": ["2", "8", "16", "48"], "mm": ["20", "90"], "Hz": ["2", "10"], "A": ["0.5", "3"]}
FAULT = 99  # the sanitizers' exit code
FOREIGN = "thesis.txt"  # a file that no command made


@dataclasses.dataclass
class Run:
    number: int
    line: list
    code: int | None = None
    error: str = ""
    seconds: float = 0.0
    finding: str = ""  # what is wrong, in a few words
    note: str = ""     # what is not wrong, but told
    whole: bool = True  # every option has its value
    meant: str = ""     # the option that is misspelt in the line, in its right spelling


class Drawer:
    """Draws command lines; `folder` gets the files that a run reads."""

    def __init__(self, commands, files, draw, folder):
        self.commands, self.files, self.draw, self.folder = commands, files, draw, folder
        self.keys = command_files.keys_of(files["machine"][:3])
        self.outputs = []  # what a run that refuses must not leave
        self.meant = ""
        # How much of a line is odd: what is refused at once shows nothing of what lies behind.
        self.oddness = draw.choice([0.0, 0.0, 0.02, 0.02, 0.06, 0.3])

    def odd(self):
        return self.draw.random() < self.oddness

    def quantity(self, unit):
        number = self.draw.choice(command_files.NUMBERS if self.odd() else SENSIBLE.get(unit, ["1", "2"]))
        one = f"{number} {self.draw.choice(UNITS) if self.odd() else unit}"
        return ", ".join([one] * (self.draw.choice([2, 5]) if self.odd() else 1))

    def file(self, kind):
        """A file as it is, one with changes, or something else."""
        if self.odd():
            return self.draw.choice(["nowhere.csv", ".", "/dev/null", "/", self.draw.choice(WORDS)])
        if self.odd():
            kind = self.draw.choice(list(self.files))
        file = self.draw.choice(self.files[kind])
        if self.draw.random() < 0.6:
            return str(file)
        place = self.folder / f"in{len(list(self.folder.iterdir()))}{file.suffix}"
        command_files.changed(self.draw, file, place)
        return place.name

    def machine(self):
        shipped = ["mcfv5050ln", "emps"] * 6 + ["screw-motor-encoder", "screw-linear-scale"] * 2 + ["stick-slip-feed"]
        return self.draw.choice(shipped) if self.draw.random() < 0.7 else self.file("machine")

    def override(self):
        if self.odd():
            return self.draw.choice(WORDS + ["=", "a=", "=b", "axis.X=1", "axis.X.friction.use", "axis.*.mass=1 kg"])
        key, value = self.draw.choice(self.keys)
        if self.draw.random() < 0.3:
            key = re.sub(r"^axis\.\w+", "axis.*", key)
        if self.draw.random() < 0.1:
            return f"axis.*.friction.use={self.draw.choice(MODELS)}"
        if self.draw.random() < 0.7:
            value = command_files.changed_numbers(self.draw, value)
        return f"{key}={value.strip(chr(34))}"

    def output(self, kind):
        if self.odd():
            return self.draw.choice(["/dev/full", "/proc/x", ".", "in0.toml", "", "a/b/c"])
        name = f"out{len(self.outputs)}{self.draw.choice(kind)}"
        if kind == [""] and self.draw.random() < 0.3:
            return self.used_folder(f"used{len(self.outputs)}")
        self.outputs.append(name)
        return name

    def used_folder(self, name):
        """A folder with a file of somebody else, and often with an earlier result beside it."""
        place = self.folder / name
        place.mkdir(exist_ok=True)
        (place / FOREIGN).write_text("precious", encoding="utf-8")
        if self.draw.random() < 0.7:
            (place / "result.json").write_text("{}", encoding="utf-8")
        return name

    def misspell(self, line):
        """One option of the line loses, doubles or exchanges a letter."""
        places = [k for k, part in enumerate(line) if part.startswith("--") and len(part) > 6 and part[2:].isalpha()]
        if not places or "--help" in line or "--version" in line:
            return
        place = self.draw.choice(places)
        meant = line[place]
        at = self.draw.randrange(3, len(meant) - 1)
        slip = self.draw.choice([meant[:at] + meant[at + 1:], meant[:at] + meant[at] + meant[at:],
                                 meant[:at] + meant[at + 1] + meant[at] + meant[at + 2:]])
        if slip != meant:
            line[place], self.meant = slip, meant

    def value(self, command, argument):
        """A value for an argument, as the help calls it or as its name says."""
        name, takes = argument.name.lstrip("-"), argument.takes
        if self.odd():
            return self.draw.choice(WORDS)
        if argument.choices:
            return self.draw.choice(argument.choices)
        if name in ("machine", "check"):
            return ",".join(self.machine() for _ in range(2 if self.odd() else 1))
        if name in ("log", "OUT", "out") and takes in ("FILE", "DIR", "TEXT"):
            return self.output([""] if takes == "DIR" else [".csv", ".csv", ".mat", ".txt", ""])
        if name in ("IN", "map"):
            return self.file(self.draw.choice(["run", "log", "other"]) if name == "IN" else "other")
        if takes == "MOTION":
            return self.file("motion")
        if takes == "PROJECT":
            return self.file("project")
        if takes in QUANTITIES:
            return self.quantity(QUANTITIES[takes])
        if takes == "LOG" or name in ("LOG", "from"):
            return self.file(self.draw.choice(["run", "run", "log"]))
        if takes == "KEY=VALUE":
            return self.override()
        if "UNIT" in takes or takes in ("FEED", "FEEDS"):
            return self.quantity({"radius": "mm", "lowest": "Hz", "amplitude": "A"}.get(name, "m/min"))
        if takes in ("INT", "N", "SEED"):
            return self.draw.choice(command_files.NUMBERS if self.odd() else ["1", "2", "3", "14"])
        if takes == "MODEL":
            return self.draw.choice(MODELS)
        known = {"reference": ["circle"], "axis": ["X", "X", "Y", "X,Y"], "mat": ["5", "7.3"],
                 "direction": ["cw", "both"], "loop": ["current", "velocity", "position"],
                 "amperes": ["peak", "rms"], "equations": ["corrected"]}
        return self.draw.choice(known.get(name, WORDS))

    def line(self):
        first = self.draw.choice(sorted({command.words[:1] for command in self.commands}))
        command = self.draw.choice([command for command in self.commands if command.words[:1] == first])
        line = list(command.words)
        # What takes minutes with nobody's fault: thousands of laps.
        short = {"--no-pulse": 0.97, "--json": 0.4, "--out": 0.4, "--axis": 0.6, "--reference": 0.05, "--version": 0.0}
        for argument in command.arguments:
            wanted = short.get(argument.name, 0.15)
            if argument.required or not argument.name.startswith("-"):
                wanted = 1.0 - self.oddness
            if self.draw.random() >= wanted:
                continue
            for _ in range(self.draw.choice([1, 1, 2, 3]) if argument.many else 1):
                value = [self.value(command, argument)] if argument.takes or argument.choices else []
                line += ([argument.name] if argument.name.startswith("-") else []) + value
        self.whole = not self.odd()
        if self.oddness == 0.0 and self.draw.random() < 0.1:
            self.misspell(line)
        if not self.whole:
            odd = self.draw.choice(WORDS + ["--help", "--version", "--bogus"])
            line.insert(self.draw.randrange(len(line) + 1), odd)
            if self.draw.random() < 0.5:
                del line[self.draw.randrange(len(line))]
        return [part.replace("\0", "") for part in line]


class Fuzzer:
    def __init__(self, options, work):
        self.options, self.work = options, work
        self.program = options.program.resolve()
        self.commands = help_grammar.read(self.program)
        made = work / "files"
        made.mkdir()
        self.files = command_files.collect(self.program, ROOT, options.corpora, made, options.patience)
        sanitizers = f"exitcode={FAULT}:abort_on_error=0:allocator_may_return_null=1:detect_leaks=0"
        self.environment = os.environ | {"ASAN_OPTIONS": sanitizers,
                                         "UBSAN_OPTIONS": f"exitcode={FAULT}:print_stacktrace=1", "LC_ALL": "C.UTF-8"}

    def run(self, number):
        draw = random.Random(f"{self.options.seed}/{number}")
        folder = self.work / f"run{number}"
        folder.mkdir()
        drawer = Drawer(self.commands, self.files, draw, folder)
        run = Run(number, drawer.line(), whole=drawer.whole)
        run.meant = drawer.meant
        begin = time.monotonic()
        process = subprocess.Popen([self.program, *run.line], cwd=folder, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   start_new_session=True,
                                   preexec_fn=lambda: command_files.limit(self.options.patience))
        try:
            out, error = process.communicate(timeout=command_files.WAITING * self.options.patience)
            run.code = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            out, error = process.communicate()
        run.seconds = time.monotonic() - begin
        run.error = error.decode("utf-8", errors="replace")
        judge(run, out.decode("utf-8", errors="replace"), [name for name in drawer.outputs if (folder / name).exists()])
        run.finding = left_wrong(folder) or run.finding
        if run.finding:
            self.keep(run, folder)
        shutil.rmtree(folder)
        return run

    def keep(self, run, folder):
        """The run's files and its command, to be run again where they lie."""
        if self.options.findings is None:
            return
        place = self.options.findings / f"command_line-{self.options.seed}-{run.number}"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(folder, place, ignore=lambda _, names: [name for name in names if name.startswith("out")])
        line = list(run.line)
        for file in {file for files in self.files.values() for file in files}:
            if any(str(file) in part for part in line):
                shutil.copy(file, place)
                line = [part.replace(str(file), file.name) for part in line]
        (place / "command").write_text(f'cd "$(dirname "$0")" && {self.program} {shlex.join(line)}\n', encoding="utf-8")
        (place / "said").write_text(run.error, encoding="utf-8")


def left_wrong(folder):
    """What a run has left in its folder that it must not leave."""
    for file in folder.rglob("*"):
        if ".partial-" in file.name:
            return "a temporary file is left"
        if file.name == FOREIGN and file.read_text(encoding="utf-8") != "precious":
            return "a foreign file is changed"
    if any(not (used / FOREIGN).exists() for used in folder.glob("used*")):
        return "a foreign file is gone"
    return ""


def judge(run, out, written):
    """Puts what is wrong with a run, or worth telling, into it."""
    if run.code is None or run.code == -signal.SIGXCPU:
        run.code = None
        run.note = "no end in its time"
    elif run.code < 0:
        run.finding = signal.Signals(-run.code).name
    elif "terminate called" in run.error:
        run.finding = "uncaught exception"
    elif run.code == FAULT or "ERROR: AddressSanitizer" in run.error or "runtime error:" in run.error:
        run.finding = "a sanitizer's report"
    elif run.code not in (0, 1, 2):
        run.finding = f"exit {run.code}"
    elif run.code != 0 and not run.error.strip():
        run.finding = f"exit {run.code} without a message"
    elif run.code == 2 and written:
        run.finding = "refused, and something is written"
    elif run.code == 2 and not ("found" in run.error and "expected" in run.error):
        run.finding = "refused without what was found and what was expected"
    elif run.meant and (run.code != 2 or f"did you mean '{run.meant}'" not in run.error):
        run.finding = "a misspelt option without its right spelling"
    elif run.code == 0 and "--json" in run.line and run.whole:
        try:
            json.loads(out)
        except ValueError:
            run.finding = "no JSON on standard output"


def place_of(error):
    """Where a sanitizer saw the fault, or the message: findings with the same one are one finding."""
    if found := re.search(r"([\w/.]+\.[ch]pp:\d+):\d+: runtime error: (.*)", error):
        return f"{found[1]}: {found[2]}"[:160]
    frames = re.findall(r"#\d+ 0x\w+ in .*?((?:host|sim|hal|firmware)/[\w/.]+:\d+)", error)
    if frames:
        return f"{frames[0]}"
    lines = [line for line in error.splitlines() if line.strip()]
    return lines[-1][:160] if lines else ""


def typed(run):
    return shlex.join(["stiction", *run.line])[:1000]


def report(seed, runs, findings, notes):
    codes = {}
    for run in runs:
        codes[run.code] = codes.get(run.code, 0) + 1
    several = {}
    for run in findings:
        several.setdefault((run.finding, tuple(run.line[:2]) if run.line else (), place_of(run.error)), []).append(run)
    for (what, _, place), alike in several.items():
        first = min(alike, key=lambda run: len(typed(run)))
        print(f"finding: {what}{f' ({len(alike)} times)' if len(alike) > 1 else ''}: {place}")
        print(f"  {typed(first)}")
        print(f"  again: --seed {seed} --run {first.number}")
    for run in sorted(notes, key=lambda run: run.number)[:10]:
        print(f"  {run.note}, --run {run.number}: {typed(run)[:300]}")
    ended = ", ".join(f"{count} with {code}" for code, count in sorted(codes.items(), key=str) if code is not None)
    print(f"command_line: seed {seed}, {len(runs)} runs: {ended}; {codes.get(None, 0)} without an end in their time, "
          f"longest {max((run.seconds for run in runs), default=0.0):.1f} s; {len(several)} findings")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", type=pathlib.Path, required=True, help="stiction; its machines lie in ../share")
    parser.add_argument("--seconds", type=float, default=60.0, help="for so long [60]")
    parser.add_argument("--runs", type=int, help="so many runs instead")
    parser.add_argument("--seed", type=int, default=1, help="of all that is drawn [1]")
    parser.add_argument("--run", type=int, help="this run alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time [cores]")
    parser.add_argument("--patience", type=int, default=30, help="processor seconds of a run, then it is ended [30]")
    parser.add_argument("--corpora", type=pathlib.Path, default=ROOT / "build/fuzz/corpus",
                        help="what other fuzzers have learned")
    parser.add_argument("--findings", type=pathlib.Path, help="keep the files of findings in this folder")
    return parser.parse_args()


def numbers(options):
    """Numbers of the runs, until the time is over."""
    end = time.monotonic() + options.seconds
    number = 0
    while number < options.runs if options.runs is not None else time.monotonic() < end:
        yield number
        number += 1


def main():
    options = arguments()
    if not options.program.exists():
        print(f"command_line_fuzz: --program: found no {options.program}", file=sys.stderr)
        return 2
    work = pathlib.Path(tempfile.mkdtemp(prefix="stiction-fuzz-"))
    try:
        fuzzer = Fuzzer(options, work)
        if options.run is not None:
            runs = [fuzzer.run(options.run)]
            print(runs[0].error, end="")
        else:
            runs = []
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                waiting = set()
                for number in numbers(options):
                    waiting.add(pool.submit(fuzzer.run, number))
                    if len(waiting) >= 2 * options.jobs:
                        done, waiting = concurrent.futures.wait(waiting, return_when="FIRST_COMPLETED")
                        runs += [each.result() for each in done]
                runs += [each.result() for each in waiting]
    finally:
        shutil.rmtree(work, ignore_errors=True)
    findings = [run for run in runs if run.finding]
    report(options.seed, runs, findings, [run for run in runs if run.note])
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
