#!/usr/bin/env python3
"""Which branches of firmware/ were taken, from `llvm-cov export`: prints the share and every branch that was not.

usage: branches.py EXPORT.json REASONS [LEAST]      LEAST: per cent, default 95
status 1: too few, a branch that is neither taken nor in REASONS, or a reason that is no longer needed

Each condition has two branches, true and false. A template counts once: a branch is taken when any instantiation takes
it, and is none when those that reach it know the outcome at compile time. A function that never runs counts as one
branch not taken.

REASONS: a line a branch, `FILE | CONDITION | OUTCOME | reason`: FILE from firmware/include/stiction on, CONDITION as in
the source with single blanks (or a function's first line), OUTCOME `true`, `false` or `never runs`.
"""

import collections
import json
import pathlib
import re
import sys

ROOT = "firmware/include/stiction/"
AT_THE_DESK = "design/"  # below ROOT; it runs before the drive does, and tests/firmware/design holds it
CODE = 0  # the kind of a region that is code, not a gap or what the preprocessor skipped

Place = collections.namedtuple("Place", "file line text")


class Sources:
    def __init__(self):
        self.lines = {}

    def of(self, path):
        if path not in self.lines:
            self.lines[path] = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
        return self.lines[path]

    def text(self, path, first_line, first_column, last_line, last_column):
        lines = self.of(path)[first_line - 1:last_line]
        lines[-1] = lines[-1][:last_column - 1]
        lines[0] = lines[0][first_column - 1:]
        return re.sub(r"\s+", " ", " ".join(lines)).strip()


def innermost_count(regions, line, column):
    """How often the innermost code around a place ran."""
    around = [r for r in regions if r[7] == CODE and (r[0], r[1]) <= (line, column) < (r[2], r[3])]
    # Of nested regions the inner one starts last; of those that start together it ends first.
    return max(around, key=lambda r: (r[0], r[1], -r[2], -r[3]))[4] if around else 0


def branches_of(functions, sources):
    """{(Place, outcome): taken} over all instantiations."""
    taken = {}
    known = set()  # places that were reached, with the outcome known at compile time
    runs = collections.Counter()
    for function in functions:
        path = function["filenames"][0]
        if ROOT not in path or path.split(ROOT)[1].startswith(AT_THE_DESK):
            continue
        file = path.split(ROOT)[1]
        line, column = function["regions"][0][:2]
        head = sources.text(path, line, 1, line, column)
        runs[Place(file, line, head.rstrip(" {"))] += function["count"]
        for line, column, last_line, last_column, true, false, *_ in function["branches"]:
            if sources.of(path)[line - 1][:column].endswith("= default"):
                continue  # a comparison that the compiler wrote
            place = Place(file, line, sources.text(path, line, column, last_line, last_column))
            if true == false == 0 and innermost_count(function["regions"], line, column) > 0:
                known.add(place)
                continue
            for outcome, count in (("true", true), ("false", false)):
                taken[place, outcome] = taken.get((place, outcome), False) or count > 0
    for place in known:
        if not (taken.get((place, "true")) or taken.get((place, "false"))):
            taken.pop((place, "true"), None)
            taken.pop((place, "false"), None)
    taken.update({(place, "never runs"): False for place, count in runs.items() if count == 0})
    return taken


def read_reasons(path):
    reasons = {}
    for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        # A condition may hold `||`; blanks around a single bar separate.
        fields = [field.strip() for field in re.split(r"\s\|\s", line)]
        if len(fields) != 4 or not all(fields):
            sys.exit(f"{path}:{number}: expected FILE | CONDITION | OUTCOME | reason")
        reasons[tuple(fields[:3])] = fields[3]
    return reasons


def judge(taken, reasons, least):
    """The lines to print, and whether all is well."""
    missing = sorted(branch for branch, is_taken in taken.items() if not is_taken)
    share = 100.0 * (len(taken) - len(missing)) / len(taken) if taken else 0.0
    lines = []
    unused = dict(reasons)
    well = share >= least
    for place, outcome in missing:
        reason = reasons.get((place.file, place.text, outcome))
        unused.pop((place.file, place.text, outcome), None)
        well = well and reason is not None
        lines.append(f"{ROOT}{place.file}:{place.line}: `{place.text}` {outcome if outcome == 'never runs' else f'is never {outcome}'}"
                     f": {reason or 'NO REASON'}")
    for file, text, outcome in unused:
        well = False
        lines.append(f"{file}: `{text}` {outcome}: there is a reason, but no such branch that is not taken")
    lines.append(f"{len(taken) - len(missing)} of {len(taken)} branches taken: {share:.1f} % (bound {least:g} %), "
                 f"{len(missing)} not, {sum('NO REASON' in line for line in lines)} without a reason")
    return lines, well


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    functions = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))["data"][0]["functions"]
    lines, well = judge(branches_of(functions, Sources()), read_reasons(sys.argv[2]), float((sys.argv[3:] or [95])[0]))
    print("\n".join(lines))
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
