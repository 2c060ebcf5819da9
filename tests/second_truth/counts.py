"""Counts over the lines of a campaign: k of n, by name; what table.py prints and docs/results.md keeps.

`told` are cases with a hidden name that an ideal observer can tell (odds of 20 and more), `apart` the others.
"""

import worth

WITH_NAMES = ("single", "pair", "triple", "tight_spot")
LIKELY = ((0.5, 0.7), (0.7, 0.9), (0.9, 1.01))  # bands of the probability that a verdict gives its first name


def right(line):
    """The first name is right, or the verdict gives the right one 10 % and more."""
    return line["first_right"] or line["confused_right"]


def wrong(line):
    """The first name is wrong, and the verdict does not give the right one 10 %."""
    return bool(line["names"]) and not right(line)


def hidden(line):
    """A cause of the vocabulary is hidden."""
    return line["kind"] in WITH_NAMES


def told(line):
    """One is, and an ideal observer can tell it."""
    return hidden(line) and not line["cannot_tell"]


def apart(line):
    """One is, and an ideal observer cannot."""
    return hidden(line) and line["cannot_tell"]


def of(*kinds):
    """Cases of these kinds that count."""
    return lambda line: line["kind"] in kinds and not line["cannot_tell"]


# name, what it is, the cases that it is of, those of them that count
SHARES = (
    ("first_right", "first name right, or given 10 % by the verdict", told, right),
    ("by_confused", "  of these by confused_with alone", told, lambda line: line["confused_right"]),
    ("first_wrong", "first name wrong", told, wrong),
    ("exact_set", "exactly the hidden names", told, lambda line: line["exact"]),
    ("some_false", "a false name among them", told, lambda line: line["false"]),
    ("confused_holds", "first name wrong: confused_with holds the right one",
     lambda line: told(line) and line["names"] and not line["first_right"],
     lambda line: set(line["hidden"]) & set(line["confused"])),
    ("apart_silent", "cannot tell (odds under 20): no name", apart, lambda line: not line["names"]),
    ("apart_right", "cannot tell (odds under 20): first name right", apart, right),
    ("silent", "unknown: no name of a cause", of("unknown"), lambda line: not line["names"]),
    ("named", "exact file: a name", of("exact"), lambda line: line["names"]),
    ("off_false", "file off within tolerance: a name that is not the parameter's", of("tolerance"),
     lambda line: line["false"]),
    ("off_named", "file off within tolerance: its name", of("tolerance"), lambda line: line["tolerated"]),
    ("position_worse", "extended machine over 10 % worse in held-out position", worth.has_positions,
     worth.position_is_worse),
)


def shares(lines):
    """{name: [k, n]} of the cases that have a verdict; names without cases are left out."""
    out = {}
    for name, _, among, counts in SHARES:
        rows = [line for line in lines if among(line)]
        if rows:
            out[name] = [sum(bool(counts(line)) for line in rows), len(rows)]
    several = [line for line in lines if told(line) and len(line["hidden"]) > 1]
    if several:
        out["found"] = [sum(line["found"] for line in several), sum(len(line["hidden"]) for line in several)]
    for low, high in LIKELY:
        rows = [line for line in lines if told(line) and line["probability"] and low <= line["probability"] < high]
        if rows:
            out[f"said_{100 * low:.0f}"] = [sum(line["first_right"] for line in rows), len(rows)]
    covers = [inside for line in lines if line["kind"] == "single" for inside in worth.intervals(line)]
    if covers:
        out["intervals"] = [sum(covers), len(covers)]
    return out


def means(lines):
    """{name: [mean, n]} of the same cases: gains in % of the oracle's, names in confused_with."""
    out = {}
    known = [line for line in lines if told(line)]
    nameless = [line for line in lines if line["kind"] == "unknown" and worth.of_coordinates(line)]
    for name, rows in (("gain", known), ("map_gain", nameless)):
        rows = [line for line in rows if worth.has_gain(line)]
        if rows:
            out[name] = [worth.gain(rows), len(rows)]
    if known:
        out["confused_names"] = [sum(len(line["confused"]) for line in known) / len(known), len(known)]
    return out


def texts():
    """{name: what it is} of all counts and means."""
    out = {name: text for name, text, _, _ in SHARES}
    out["found"] = "pairs, triples: causes found"
    out.update({f"said_{100 * low:.0f}": f"named with a probability of {low:.1f} to {min(high, 1.0):.1f}: right"
                for low, high in LIKELY})
    out["intervals"] = "95 % intervals that cover"
    return out | {"gain": "held-out gain of an oracle's, %", "map_gain": "the same of functions without a name, %",
                  "confused_names": "names in confused_with"}


def group(line):
    """The name of a campaign's kind: "single10", "single5 without set-points", "single10 behind cams"."""
    kind = line["kind"] + (f"{100 * line['share']:g}" if line["kind"] not in ("exact", "tolerance", "tight_spot") else "")
    return kind + (" without set-points" if "without set-points" in line["key"] else "") + \
        (" behind cams" if line["key"].endswith("of a cam") else "")
