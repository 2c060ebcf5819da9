"""The output of the blind campaign and of that of the second truth, as runs for campaigns.toml."""

import datetime
import json
import pathlib
import re
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "second_truth"))

import counts  # noqa: E402

# What the engine of a campaign is made of: the last commit that touched one of these names it.
DIAGNOSIS = ["firmware/include", "firmware/machine", "host", "sim"]
ENGINE = [*DIAGNOSIS, "tests/blind"]

# The headings of tests/blind/campaign_report.cpp: the kind, and the name of the count below each.
KINDS = {"nothing hidden": "null", "one at 50 %": "one50", "one at 10 %": "one10", "one at 5 %": "one5",
         "one at 2 %": "one2", "two at 10 % each": "two10", "outside the vocabulary at 10 %": "outside10",
         "parameters slightly off": "off"}
GAINS = {"one effect, share 50 %": "one50", "one effect, share 10 %": "one10", "two effects, 10 % each": "two10"}
COUNTS = {"some cause is named": "named", "the first name is right (exact aliases count)": "first_right",
          "right, or declared an alias of the right one": "right_or_alias", "no name": "no_name",
          "the first name is wrong": "first_wrong", "some name is wrong": "some_wrong", "the exact set": "exact_set",
          "the first name is right": "first_right", "no false name, a signature": "signature",
          "no false name": "no_false_name", "nothing but the matching mismatches": "only_matching",
          "some of them named": "some_named"}


class NotKept(Exception):
    """Why a run is not kept."""


def read_log(seed, text, git):
    """The runs in the output of a campaign; NotKept when its engine has changes that no commit has."""
    if git("status", "--porcelain", "--", *ENGINE):
        raise NotKept(f"the counts are not kept, because {', '.join(ENGINE)} have changes without a commit")
    head = {"campaign": "blind", "seed": seed, "commit": git("log", "-1", "--format=%h", "--abbrev=7", "--", *ENGINE),
            "date": str(datetime.date.today())}
    runs, kind = {}, ""
    for line in text.splitlines():
        found = re.match(r"(.+?)\s+(\d+) of (\d+)\s+[\d.]+ %", line)
        if not found:
            continue
        what, k, n = found[1], int(found[2]), int(found[3])
        before, colon, after = what.partition(": ")
        if colon and before in KINDS:
            kind, what = KINDS[before], after
        if what.strip() in COUNTS and kind:
            run = runs.setdefault(kind, head | {"kind": kind, "cases": n, "counts": {}})
            run["counts"][COUNTS[what.strip()]] = [k, n]
    for line in text.splitlines():
        gain = re.match(r"held-out gain, (.+?)\s+([\d.]+) % of the oracle's .*reached in (\d+) of (\d+)", line)
        if gain:
            run = runs[GAINS[gain[1]]]
            run["means"] = {"gain": [float(gain[2]), run["cases"]]}
            run["counts"]["gain_reached"] = [int(gain[3]), int(gain[4])]
    covered = re.search(r"^95 % intervals that cover the true value\s+(\d+) of (\d+)", text, re.M)
    if covered and len(runs) == 1:  # intervals of several kinds are counted together
        run = next(iter(runs.values()))
        run.setdefault("means", {})["intervals"] = [round(100.0 * int(covered[1]) / int(covered[2]), 1), run["cases"]]
    if not runs:
        raise NotKept("the campaign's output has no counts")
    return list(runs.values())


def read_lines(commit, date, text):
    """The runs in the lines of results of the second truth, one for each kind of case; of the engine at `commit`."""
    lines = [line for line in map(json.loads, text.splitlines()) if "error" not in line]
    if not lines:
        raise NotKept("the campaign has no line with a verdict")
    runs = []
    for kind in sorted({counts.group(line) for line in lines}):
        of_kind = [line for line in lines if counts.group(line) == kind]
        runs.append({"campaign": "second_truth", "kind": kind, "seed": min(line["seed"] for line in of_kind),
                     "cases": len(of_kind), "commit": commit, "date": date, "counts": counts.shares(of_kind),
                     "means": {name: [round(mean, 1), n] for name, (mean, n) in counts.means(of_kind).items()}})
    return runs


def engine_commit(git):
    """The last commit of the diagnosis; NotKept when it has changes that no commit has."""
    if git("status", "--porcelain", "--", *DIAGNOSIS):
        raise NotKept(f"the counts are not kept, because {', '.join(DIAGNOSIS)} have changes without a commit")
    return git("log", "-1", "--format=%h", "--abbrev=7", "--", *DIAGNOSIS)
