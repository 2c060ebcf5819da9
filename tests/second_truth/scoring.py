"""What a verdict is worth against a truth, and the table of a campaign.

Interval: Wilson 1927, as in Brown, Cai, DasGupta 2001. Cases in which an ideal observer has odds under 20 are apart.
"""

import math

LEAST_NATS = math.log(20.0)
SAID = 0.10  # probability from which a name in confused_with counts as said
NO_CAUSE = {"force_map", "unexplained"}  # say of themselves that they name no cause


def names_of(verdict):
    """Names of the findings in their order, without those that name no cause."""
    return [f["effect"] for f in verdict.get("findings", []) if f["effect"] not in NO_CAUSE]


def judge(truth, verdict):
    """One line of results: what was hidden, what was said, and which of the counts it belongs to."""
    hidden, names = truth["hidden"], names_of(verdict)
    findings = [f for f in verdict.get("findings", []) if f["effect"] not in NO_CAUSE]
    meant = {h: {h, *truth["accept"].get(h, [])} for h in hidden}
    right = lambda name: any(name in group for group in meant.values())
    confused = findings[0].get("confused_with", []) if findings else []
    line = {
        "kind": truth["kind"], "seed": truth["seed"], "share": truth["share"], "hidden": hidden,
        "unknown": truth["unknown"], "shape": truth["shape"], "friction": truth["machine"]["friction"],
        "rotary": truth["machine"]["rotary"],
        "two": truth["machine"]["shaft"] > 0, "nats": truth["oracle_nats"], "alias_nats": truth["oracle_alias_nats"],
        "names": names, "status": verdict.get("status"), "confused": [c["effect"] for c in confused],
        "probability": findings[0].get("probability") if findings else None,
        "force_map": any(f["effect"] == "force_map" for f in verdict.get("findings", [])),
        "cannot_tell": truth["oracle_nats"] is not None and truth["oracle_nats"] < LEAST_NATS,
        "first_right": bool(names) and right(names[0]),
        "confused_right": bool(names) and not right(names[0]) and any(
            right(c["effect"]) and c.get("probability", 0.0) >= SAID for c in confused),
        "found": sum(any(n in group for n in names) for group in meant.values()),
        "false": [n for n in names if not right(n) and n not in truth["tolerated"]],
        "tolerated": [n for n in names if n in truth["tolerated"]]}
    line["exact"] = line["found"] == len(hidden) and not line["false"]
    return line


def wilson(k, n):
    """95 % interval of a share, in %."""
    if not n:
        return 0.0, 100.0
    z, p = 1.959964, k / n
    middle, half = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return 100 * (middle - half) / (1 + z * z / n), 100 * (middle + half) / (1 + z * z / n)


def row(name, k, n):
    """One row of the table."""
    if not n:
        return f"{name:58s}      -"
    low, high = wilson(k, n)
    return f"{name:58s} {k:4d} of {n:4d}  {100 * k / n:5.1f} %  ({low:.0f} to {high:.0f})"


def table(lines):
    """The whole table as text; the pooled figure first."""
    done = [r for r in lines if "error" not in r]
    apart = [r for r in done if r["cannot_tell"]]
    told = [r for r in done if not r["cannot_tell"]]
    of = lambda *kinds: [r for r in told if r["kind"] in kinds]
    count = lambda rows, key: sum(bool(r[key]) for r in rows)
    named, single = of("single", "pair", "triple", "tight_spot"), of("single")
    said = lambda rows: sum(r["first_right"] or r["confused_right"] for r in rows)
    wrong = lambda rows: sum(bool(r["names"]) and not (r["first_right"] or r["confused_right"]) for r in rows)
    several, off = of("pair", "triple"), of("tolerance")
    out = [row("ALL with a hidden name: first name right", said(named), len(named)),
           row("  of these by confused_with alone", count(named, "confused_right"), len(named)),
           row("ALL with a hidden name: first name wrong", wrong(named), len(named)),
           row("single: first name right", said(single), len(single)),
           row("single: first name wrong", wrong(single), len(single)),
           row("single: exactly the hidden name", count(single, "exact"), len(single)),
           row("tight spot: first name right", said(of("tight_spot")), len(of("tight_spot"))),
           row("pairs exact", count(of("pair"), "exact"), len(of("pair"))),
           row("triples: causes found", sum(r["found"] for r in of("triple")), 3 * len(of("triple"))),
           row("triples exact", count(of("triple"), "exact"), len(of("triple"))),
           row("pairs, triples: records with a false name", count(several, "false"), len(several)),
           row("unknown: no name of a cause", sum(not r["names"] for r in of("unknown")), len(of("unknown"))),
           row("nulls named (exact file)", sum(bool(r["names"]) for r in of("exact")), len(of("exact"))),
           row("nulls named (file off within tolerance), false name", count(off, "false"), len(off)),
           row("  a name that is off within tolerance", count(off, "tolerated"), len(off)),
           row("cannot tell (odds under 20): first name right", said(apart), len(apart)),
           row("cannot tell (odds under 20): first name wrong", wrong(apart), len(apart)),
           row("errors of the programme", len(lines) - len(done), len(lines))]
    groups = (("cause", lambda r: r["hidden"][0]), ("friction law", lambda r: r["friction"]),
              ("machine", lambda r: ("rotary" if r["rotary"] else "linear") + (", two bodies" if r["two"] else "")))
    for title, key in groups:
        out += ["", f"single, first name right, by {title}:"]
        for value in sorted({key(r) for r in single}):
            rows = [r for r in single if key(r) == value]
            others = sorted({r["names"][0] if r["names"] else "no name" for r in rows
                             if not (r["first_right"] or r["confused_right"])})
            out.append(row("  " + value, said(rows), len(rows)) + ("   else: " + ", ".join(others) if others else ""))
    out += ["", "unknown, no name, by form:"]
    for value in sorted({r["unknown"][0] for r in of("unknown")}):
        rows = [r for r in of("unknown") if r["unknown"][0] == value]
        names = sorted({n for r in rows for n in r["names"]})
        said_instead = "   " + ", ".join(names) if names else ""
        out.append(row("  " + value, sum(not r["names"] for r in rows), len(rows)) + said_instead)
    return "\n".join(out)
