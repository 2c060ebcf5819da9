"""One cell of the matrix: every command in README's order on one axis with one friction model, and its checks."""

import dataclasses
import json
import pathlib
import re

import machines
import records
import tally

# Kinds of pages by a part that only they have, with the script that opens them.
PAGES = [("polar", "open_report.mjs"), ("unexplained", "open_diagnosis.mjs"), ("parameters", "open_identification.mjs"),
         ("results", "open_experiment.mjs")]

FEED, OTHER_FEED = "16 m/min", "10 m/min"  # README's, and of the held-out circle
OFF = 0.2  # of Coulomb friction
# What an experiment must be told.
MOTION_FILE = pathlib.Path(__file__).parents[2] / "examples/cams/indexing.toml"
NEEDED = {"cam": ("--cam", MOTION_FILE, "--speed", "20 rpm", "--cycles", "1")}

EXACT = "nothing named on an exact file"
NAMED = "Coulomb friction 20 % off: named, or a declared alias"
TRUTHS = "identified truths inside of their 95 % intervals"
ALONE = "Coulomb friction 20 % off: nothing else named beside it"
FOUND = "values of the file that identification determines"


def page_script(html):
    for part, script in PAGES:
        if f'id="{part}"' in html:
            return script
    return None


def names_in(verdict):
    return [finding["effect"] for finding in verdict["findings"] if finding["effect"] != "force_map"]


def said_of(verdict):
    """A verdict's findings in one line, with what speaks for each."""
    parts = [f"{f['effect']} (p = {f['p_value']:.2g}, explains {100.0 * f['explains']:.1f} %, "
             + ", ".join(f"{key} {value}" for key, value in f["parameters"].items()) + ")" for f in verdict["findings"]]
    left = verdict["unexplained"].get("signature")
    return ("; ".join(parts) or "nothing named") + (f"; unexplained: {left}" if left else "")


@dataclasses.dataclass
class Report:
    """What a cell has shown."""
    cell: machines.Cell
    failures: list = dataclasses.field(default_factory=list)
    counts: list = dataclasses.field(default_factory=list)  # (rate, hit)
    pages: list = dataclasses.field(default_factory=list)  # (script, file)
    seconds: dict = dataclasses.field(default_factory=dict)  # by step
    served: set = dataclasses.field(default_factory=set)  # experiments that ran
    refusals: list = dataclasses.field(default_factory=list)  # (step, sentence)
    commands: int = 0


class Walk:
    """`first_axis`: experiments without --axis show the whole machine and run in the cells of its first axis alone."""

    def __init__(self, program, machine, cell, folder, aliases, quick):
        self.program, self.machine, self.cell = program, machine, cell
        self.folder, self.aliases, self.quick = folder, aliases, quick
        self.report = Report(cell)
        self.file = machine.name
        self.using = [] if cell.axis == machines.WHOLE else machine.using(cell.axis, cell.model)

    # -- commands -----------------------------------------------------------------------------------------------------

    def fail(self, step, what, detail=""):
        self.report.failures.append(tally.Failure(str(self.cell), step, what, detail))

    def command(self, step, *arguments, may_refuse=False, out=None):
        """Runs a command, with --out OUT where given. Returns its outcome where it ended with 0, else None. A refusal
        is a failure; where it may be one, it has to be a sentence."""
        arguments = list(arguments) + (["--out", out] if out else [])
        outcome = self.program.run(*arguments, folder=self.folder)
        self.report.commands += 1
        self.report.seconds[step] = self.report.seconds.get(step, 0.0) + outcome.seconds
        said = f"{outcome.typed()}\n{outcome.error.strip()[-1500:]}"
        if broke := outcome.broke():
            self.fail(step, broke, said)
        elif outcome.code == 2 and may_refuse:
            if sentence := outcome.sentence():
                self.report.refusals.append((step, sentence))
            else:
                self.fail(step, "refused without one sentence of what it needs", said)
            if out and (self.folder / out).exists():
                self.fail(step, "refused, and a folder written", said)
        elif outcome.code != 0:
            self.fail(step, f"exit {outcome.code}", said)
        else:
            self.check_output(step, outcome, out)
            return outcome
        return None

    def check_output(self, step, outcome, out):
        texts = [outcome.out]
        if out:
            folder = self.folder / out
            texts += [file.read_text(encoding="utf-8") for file in folder.glob("*.json")]
            page = folder / "report.html"
            if step.startswith("commissioning"):
                pass
            elif not page.exists():
                self.fail(step, "no report.html", outcome.typed())
            else:
                script = page_script(page.read_text(encoding="utf-8"))
                self.report.pages.append((script, page))
        for text in texts:
            if number := re.search(r"(?<![\w.])[-+]?(inf|nan)(?![\w.])", text):
                line = text[:number.start()].count("\n")
                self.fail(step, "a figure that is no number", f"{outcome.typed()}\n{text.splitlines()[line]}")
                return

    # -- the machine as a whole ---------------------------------------------------------------------------------------

    def whole(self):
        tables = self.machine.tables
        self.command("machine --check", "machine", "--check", self.file)
        has_rows = "circle" in tables.get("reference", {})
        for name in ("compare", "diagnose", "identify"):
            self.command(f"{name} --reference", name, "--reference", "circle", "--machine", self.file,
                         may_refuse=not has_rows, out=f"{name}-reference")
        for experiment in self.program.experiments:
            if experiment not in ("replay", "commissioning"):  # they belong to an axis
                self.simulate(experiment, *NEEDED.get(experiment, ()))

    def simulate(self, experiment, *more):
        step, out = f"simulate {experiment}", f"simulate-{experiment}"
        if not self.command(step, "simulate", experiment, "--machine", self.file, *more, may_refuse=True, out=out):
            return
        result = json.loads((self.folder / out / "result.json").read_text(encoding="utf-8"))
        if any(result.get(key) for key in ("results", "rows", "findings")):
            self.report.served.add(experiment)
        else:
            self.fail(step, "a result without a figure or a finding", f"{step} --machine {self.file}\n{result}")

    # -- an axis with a model -----------------------------------------------------------------------------------------

    def axis(self, first_seed):
        if first_seed:
            self.experiments()
            self.exact_logs()
        train, held_out = self.commissioned("exact", self.file, "")
        if train:
            if first_seed:
                self.inspect(train[0], "inspect")
            self.identify(train, "identify", self.machine.truths(self.cell.axis, self.cell.model))
            self.expect_nothing(train, held_out, "diagnose")
        self.with_other_friction()

    def experiments(self):
        """Those that show the machine as a whole run with the first axis' cell; those with --axis with each."""
        everywhere = all(self.cell.model in self.machine.models(axis) for axis in self.machine.axes)
        for experiment in self.program.experiments:
            options = self.program.options[experiment]
            if experiment in ("replay", "commissioning") or "--friction" not in options:
                continue
            if "--axis" in options:
                self.simulate(experiment, "--axis", self.cell.axis, "--friction", self.cell.model)
            elif self.cell.axis == self.machine.axes[0] and everywhere:
                self.simulate(experiment, "--friction", self.cell.model)

    def exact_logs(self):
        """Logs without noise, of the circle, or of a sine where the machine has one axis: what a user tries first."""
        logs = self.circle_logs() if len(self.machine.axes) > 1 else self.sine_logs()
        if not logs:
            return
        self.inspect(logs[0], "inspect the circle")
        self.expect_nothing(logs[:1], logs[1:], "diagnose the circle")
        self.command("compare", "compare", logs[0], "--machine", self.file, *self.using, out="compare")
        self.command("tune-friction", "tune-friction", *logs, "--machine", self.file, *self.using, "--axis",
                     self.cell.axis, *(["--no-pulse"] if self.quick else []),
                     may_refuse=self.machine.rotary(self.cell.axis), out="tune-friction")

    def circle_logs(self):
        for name, feed, direction in (("run", FEED, "ccw"), ("other", OTHER_FEED, "cw")):
            if not self.command("simulate circle --log", "simulate", "circle", "--machine", self.file, *self.using,
                                "--feed", feed, "--direction", direction, "--log", f"{name}.csv"):
                return []
        return ["run.csv", "other.csv"]

    def sine_logs(self):
        limits = self.limits()
        for name, share in (("run", 1.0), ("other", 0.7)):
            records.write_set_points(self.folder / f"{name}-set.csv", self.cell.axis, records.sine(limits, share),
                                     limits.rotary)
            if not self.command("simulate replay --log", "simulate", "replay", "--from", f"{name}-set.csv", "--machine",
                                self.file, *self.using, "--log", f"{name}.csv"):
                return []
        return ["run.csv", "other.csv"]

    def limits(self):
        axis = self.cell.axis
        return records.Limits(*self.machine.limits(axis), self.machine.rotary(axis))

    def commissioned(self, name, file, suffix):
        """Records with noise to learn from and to judge on, of the machine of `file`."""
        made = self.command(f"commissioning{suffix}", "simulate", "commissioning", "--machine", file, *self.using,
                            "--axis", self.cell.axis, "--seed", self.cell.seed, "--json", out=name)
        if made:
            listed = made.json()
            return ([f"{name}/{log}" for log in listed["logs"]], [f"{name}/{log}" for log in listed["holdout"]])
        return self.records(name, file, suffix)

    def records(self, name, file, suffix):
        """The same by replay of set-points within the axis' limits."""
        (self.folder / name).mkdir(exist_ok=True)
        axis = self.cell.axis
        constant = self.machine.force_constant(axis)
        learn, judge = [], []
        limits = self.limits()
        for record, held_out, points in records.commissioning(limits):
            draw = records.drawing(self.cell.seed, axis, record)
            place = f"{name}/{record}.csv"
            records.write_set_points(self.folder / "set-points.csv", axis, points, limits.rotary, draw)
            if not self.command(f"simulate replay{suffix}", "simulate", "replay", "--from", "set-points.csv",
                                "--machine", file, *self.using, "--log", "simulated.csv"):
                return [], []
            noise = records.SENSOR_FORCE / constant
            records.strip(self.folder / "simulated.csv", self.folder / place, axis, noise, draw)
            (judge if held_out else learn).append(place)
        return learn, judge

    def inspect(self, log, step):
        self.command(step, "inspect", log, "--machine", self.file, "--json")

    def identify(self, logs, step, truths):
        out = step.replace(" ", "-")
        outcome = self.command(step, "identify", *logs, "--machine", self.file, *self.using, "--axis", self.cell.axis,
                               "--json", out=out)
        if not outcome:
            return
        found = outcome.json()["parameters"]
        for name, truth in truths.items():
            self.report.counts.append((FOUND, name in found, f"{step}: {name}"))
            if name in found:
                low, high = found[name]["ci95"]
                self.report.counts.append((TRUTHS, low <= truth <= high, f"{step}: {name} = {found[name]['value']:.6g} "
                                           f"[{low:.6g}, {high:.6g}], the truth {truth:.6g}"))

    def diagnose(self, train, held_out, step):
        out = step.replace(" ", "-")
        if not self.command(step, "diagnose", *train, *[part for log in held_out for part in ("--holdout", log)],
                            "--machine", self.file, *self.using, "--axis", self.cell.axis, out=out):
            return None
        return json.loads((self.folder / out / "verdict.json").read_text(encoding="utf-8"))

    def expect_nothing(self, train, held_out, step):
        verdict = self.diagnose(train, held_out, step)
        if verdict is None:
            return
        names = names_in(verdict)
        self.report.counts.append((EXACT, not names, f"{step}: {said_of(verdict)}"))
        for name in names:
            self.fail(step, f"false name {name}", said_of(verdict))

    def with_other_friction(self):
        """A machine whose Coulomb friction differs from its file."""
        factor = 1.0 + OFF if self.cell.seed % 2 else 1.0 - OFF
        text = self.machine.with_coulomb(self.cell.axis, self.cell.model, factor)
        if text is None:
            return
        (self.folder / "true.toml").write_text(text, encoding="utf-8")
        train, held_out = self.commissioned("off", "true.toml", ", other friction")
        if not train:
            return
        self.identify(train, "identify, other friction", self.machine.truths(self.cell.axis, self.cell.model, factor))
        step = "diagnose, other friction"
        verdict = self.diagnose(train, held_out, step)
        if verdict is None:
            return
        names = names_in(verdict)
        right = [name for name in names if name == "coulomb_mismatch" or name in self.aliases]
        self.report.counts.append((NAMED, bool(right), f"{step}: {said_of(verdict)}"))
        self.report.counts.append((ALONE, len(names) == len(right), f"{step}: {said_of(verdict)}"))
        if not right:
            self.fail(step, "not named", said_of(verdict))
